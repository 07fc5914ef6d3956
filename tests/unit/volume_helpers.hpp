// What the tests of volume readers share: temporary folders, small volumes, and writers of the formats.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "isoweave/error.hpp"
#include "isoweave/volume.hpp"
#include "packing.hpp"

namespace isoweave::testing {

class TempFolder {
 public:
  TempFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "isoweave-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~TempFolder() { std::filesystem::remove_all(path_); }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

  std::string put(const std::string& name, const std::string& content) const {
    const std::string path = *this / name;
    // Some file systems flush a file that is truncated and rewritten; a new one costs nothing.
    std::filesystem::remove(path);
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }

  std::size_t entries() const {
    const std::filesystem::directory_iterator all(path_);
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }

 private:
  std::filesystem::path path_;
};

inline std::string get(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

// A number as bytes, most significant first if `big`.
template <class Number>
std::string bytes_of(Number value, bool big = false) {
  std::string bytes(sizeof(Number), '\0');
  std::memcpy(bytes.data(), &value, sizeof(Number));
  if (big != (std::endian::native == std::endian::big)) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

// Samples that differ from each other and from their byte-swapped selves.
template <class Sample>
std::vector<Sample> ramp(std::size_t count) {
  std::vector<Sample> samples(count);
  for (std::size_t n = 0; n < count; ++n) samples[n] = static_cast<Sample>(n * 7 + 3);
  return samples;
}

template <class Sample>
std::string stored(const std::vector<Sample>& samples, bool big = false) {
  std::string bytes;
  for (const Sample sample : samples) bytes += bytes_of(sample, big);
  return bytes;
}

// Whether a note about a volume has this text in it.
inline bool has_note(const VolumeInfo& info, const std::string& text) {
  return std::any_of(info.notes.begin(), info.notes.end(),
                     [&text](const std::string& note) { return note.find(text) != std::string::npos; });
}

// All slices of a source, `at_once` at a time.
inline std::vector<std::byte> read_all(SliceSource& source, std::int64_t at_once = 2) {
  const VolumeInfo& info = source.info();
  std::vector<std::byte> samples(static_cast<std::size_t>(info.dims[2]) * info.slice_bytes());
  for (std::int64_t first = 0; first < info.dims[2]; first += at_once) {
    const std::int64_t count = std::min(at_once, info.dims[2] - first);
    source.read(first, count, std::span(samples).subspan(static_cast<std::size_t>(first) * info.slice_bytes()));
  }
  return samples;
}

template <class Sample>
std::vector<Sample> samples_of(SliceSource& source, std::int64_t at_once = 2) {
  const std::vector<std::byte> bytes = read_all(source, at_once);
  std::vector<Sample> samples(bytes.size() / sizeof(Sample));
  std::memcpy(samples.data(), bytes.data(), samples.size() * sizeof(Sample));
  return samples;
}

template <class Sample>
std::vector<Sample> read_file(const std::string& path, const OpenOptions& options = {}) {
  return samples_of<Sample>(*open_volume(path, options));
}

// The message of the BadInput that opening and reading must give.
inline std::string refusal(const std::string& path, const OpenOptions& options = {}) {
  try {
    read_all(*open_volume(path, options));
  } catch (const BadInput& error) {
    return error.what();
  }
  return "(nothing was thrown)";
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Opening and reading must work or give BadInput, and BadInput's text must be one line. The largest volume that is
// read is bounded, as any caller would bound it.
inline bool reads_or_refuses(const std::string& path, std::vector<std::byte>* samples = nullptr) {
  constexpr std::size_t kReadable = 1 << 24;
  try {
    const auto source = open_volume(path);
    const VolumeInfo& info = source->info();
    if (info.slice_bytes() > kReadable || static_cast<std::size_t>(info.dims[2]) > kReadable / info.slice_bytes()) {
      return true;
    }
    const std::vector<std::byte> read = read_all(*source);
    if (samples != nullptr) *samples = read;
    return true;
  } catch (const BadInput& error) {
    EXPECT_FALSE(contains(error.what(), "\n")) << error.what();
    return false;
  }
}

// Every shorter version of a good file must be refused, or read with the same result.
inline void expect_prefixes_are_safe(const TempFolder& folder, const std::string& name, const std::string& content) {
  std::vector<std::byte> whole;
  ASSERT_TRUE(reads_or_refuses(folder.put(name, content), &whole));
  ASSERT_FALSE(whole.empty());
  std::size_t refused = 0;
  for (std::size_t length = 0; length < content.size(); ++length) {
    std::vector<std::byte> read;
    if (reads_or_refuses(folder.put(name, content.substr(0, length)), &read)) {
      EXPECT_EQ(read, whole) << name << " cut to " << length << " of " << content.size() << " bytes";
    } else {
      ++refused;
    }
  }
  EXPECT_GE(refused, content.size() / 2);
}

// Files with a few random bytes changed must never do worse than BadInput.
inline void expect_flips_are_safe(const TempFolder& folder, const std::string& name, const std::string& content,
                                  std::size_t header_bytes, int rounds = 3000) {
  std::mt19937 random(20260201);
  int refused = 0;
  for (int round = 0; round < rounds; ++round) {
    std::string broken = content;
    // Mostly in the header, where a byte means most.
    const std::size_t range = round % 4 == 0 ? content.size() : std::min(header_bytes, content.size());
    for (int flips = 1 + round % 3; flips > 0; --flips) broken[random() % range] = static_cast<char>(random() & 0xff);
    if (!reads_or_refuses(folder.put(name, broken))) ++refused;
  }
  EXPECT_GT(refused, 0);
  EXPECT_LE(refused, rounds);
}

// Fields that a test sets in a NIfTI header; the others are those of a plain volume.
struct NiftiFields {
  int version = 1;
  bool big = false;
  std::array<std::int64_t, 8> dim{3, 3, 2, 5, 1, 1, 1, 1};
  std::int16_t type = 4;
  std::array<double, 8> pixdim{1, 0.5, 0.75, 2, 0, 0, 0, 0};
  double offset = 0;  // 0: the smallest allowed
  double slope = 0;
  double intercept = 0;
  int qform = 0;
  int sform = 0;
  std::array<double, 6> quaternion{0, 0, 0, 0, 0, 0};
  std::array<double, 12> rows{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  int units = 2;
  std::int16_t bits = 0;
  int intent = 0;
  bool pair = false;
};

// The header with its four bytes of "no extension".
inline std::string nifti_header(const NiftiFields& fields) {
  const bool big = fields.big;
  const bool first = fields.version == 1;
  std::string header(first ? 352 : 544, '\0');
  const auto put = [&](std::size_t at, const std::string& bytes) { header.replace(at, bytes.size(), bytes); };
  const auto put_real = [&](std::size_t at, double value) {
    put(at, first ? bytes_of(static_cast<float>(value), big) : bytes_of(value, big));
  };
  const std::size_t real = first ? 4 : 8;
  put(0, bytes_of(first ? 348 : 540, big));
  put(first ? 344 : 4, (fields.pair ? std::string("ni") : std::string("n+")) + (first ? "1" : "2"));
  for (std::size_t n = 0; n < 8; ++n) {
    if (first) put(40 + 2 * n, bytes_of(static_cast<std::int16_t>(fields.dim[n]), big));
    if (!first) put(16 + 8 * n, bytes_of(fields.dim[n], big));
    put_real((first ? 76 : 104) + real * n, fields.pixdim[n]);
  }
  put(first ? 70 : 12, bytes_of(fields.type, big));
  put(first ? 72 : 14, bytes_of(fields.bits, big));
  if (first) put(68, bytes_of(static_cast<std::int16_t>(fields.intent), big));
  if (!first) put(504, bytes_of(fields.intent, big));
  const double offset = fields.offset != 0 || fields.pair ? fields.offset : static_cast<double>(header.size());
  if (first) put_real(108, offset);
  if (!first) put(168, bytes_of(static_cast<std::int64_t>(offset), big));
  put_real(first ? 112 : 176, fields.slope);
  put_real(first ? 116 : 184, fields.intercept);
  if (first) {
    header[123] = static_cast<char>(fields.units);
    put(252, bytes_of(static_cast<std::int16_t>(fields.qform), big));
    put(254, bytes_of(static_cast<std::int16_t>(fields.sform), big));
  } else {
    put(500, bytes_of(fields.units, big));
    put(344, bytes_of(fields.qform, big));
    put(348, bytes_of(fields.sform, big));
  }
  for (std::size_t n = 0; n < 6; ++n) put_real((first ? 256 : 352) + real * n, fields.quaternion[n]);
  for (std::size_t n = 0; n < 12; ++n) put_real((first ? 280 : 400) + real * n, fields.rows[n]);
  return header;
}

}  // namespace isoweave::testing
