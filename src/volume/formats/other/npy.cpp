// NPY, NumPy's arrays: a dictionary as text, then the samples. The last axis is i whichever way they are stored.
#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/header_text.hpp"
#include "files/quoted.hpp"
#include "parallel/size.hpp"
#include "volume/band_stream.hpp"
#include "volume/formats/chunked/array_axes.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/other/npy_array.hpp"
#include "volume/half_floats.hpp"

namespace isoweave {
namespace {

constexpr std::string_view kNpyMagic = "\x93NUMPY";

// The dictionary of a header: texts, truth values and tuples of whole numbers between braces.
class NpyDictionary {
 public:
  NpyDictionary(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  void read(NpyHeader& header) {
    expect('{');
    while (!at('}')) {
      const std::string key = quoted_text();
      expect(':');
      take_value(header, key);
      if (!at('}')) expect(',');
    }
    if (keys_ != kAllKeys) wrong();
  }

 private:
  [[noreturn]] void wrong() const {
    bad_input(path_, "a dictionary of descr, fortran_order and shape as NumPy writes it", in_quotes(text_));
  }

  // Whether the next character that is no blank is this one.
  bool at(char c) {
    position_ = std::min(text_.find_first_not_of(" \t\r\n", position_), text_.size());
    return position_ < text_.size() && text_[position_] == c;
  }

  void expect(char c) {
    if (!at(c)) wrong();
    ++position_;
  }

  std::string quoted_text() {
    const char quote = at('"') ? '"' : '\'';
    expect(quote);
    const std::size_t end = text_.find(quote, position_);
    if (end == std::string_view::npos) wrong();
    const std::size_t begin = std::exchange(position_, end + 1);
    return std::string(text_.substr(begin, end - begin));
  }

  void take_value(NpyHeader& header, const std::string& key) {
    if (key == "descr") {
      if (at('[')) bad_input(path_, "one number per sample", "a structured array");
      header.type = quoted_text();
      keys_ |= 1;
    } else if (key == "fortran_order") {
      header.first_fastest = at('T');
      const std::string_view word = header.first_fastest ? "True" : "False";
      if (text_.substr(position_, word.size()) != word) wrong();
      position_ += word.size();
      keys_ |= 2;
    } else if (key == "shape" && header.axes.empty()) {
      take_shape(header);
      keys_ |= 4;
    } else {
      wrong();
    }
  }

  void take_shape(NpyHeader& header) {
    expect('(');
    while (!at(')')) {
      const std::size_t end = std::min(text_.find_first_not_of("0123456789", position_), text_.size());
      const auto size = parse_integer(text_.substr(position_, end - position_));
      if (!size) wrong();
      header.axes.push_back({*size, {}});
      position_ = end;
      if (at('L')) ++position_;  // Python 2
      if (!at(')')) expect(',');
    }
    expect(')');
  }

  static constexpr int kAllKeys = 7;
  std::string_view text_;
  const std::string& path_;
  std::size_t position_ = 0;
  int keys_ = 0;
};

}  // namespace

NpyHeader read_npy_header(const FilePtr& file) {
  constexpr std::size_t kBeforeLength = 8;
  const std::string head = file->head(kLargestHeader);
  const auto expect_bytes = [&](std::uint64_t bytes, const std::string& what) {
    if (bytes > head.size()) bad_input(file->path(), what, "a file of " + std::to_string(head.size()) + " bytes");
  };
  expect_bytes(kBeforeLength, "the version of NPY at byte 6");
  const int version = static_cast<unsigned char>(head[kNpyMagic.size()]);
  if (version < 1 || version > 3) bad_input(file->path(), "NPY of version 1, 2 or 3", std::to_string(version));
  const std::size_t begin = kBeforeLength + (version == 1 ? 2 : 4);
  expect_bytes(begin, "the length of an NPY header at byte 8");
  std::uint64_t length = 0;
  for (std::size_t at = begin; at-- > kBeforeLength;) {
    length = length << 8 | static_cast<unsigned char>(head[at]);
  }
  expect_bytes(begin + length,
               "a header of " + std::to_string(length) + " bytes from byte " + std::to_string(begin) + " on");
  NpyHeader header;
  header.data = begin + length;
  NpyDictionary(std::string_view(head).substr(begin, static_cast<std::size_t>(length)), file->path()).read(header);
  return header;
}

std::optional<StoredType> npy_type(const NpyHeader& header) {
  const std::string& type = header.type;
  if (type.size() != 3) return std::nullopt;
  const std::string bits = std::to_string(8 * (type[2] - '0'));
  if (type[1] == 'u') return parse_stored_type("uint" + bits);
  if (type[1] == 'i') return parse_stored_type("int" + bits);
  if (type[1] == 'f') return parse_stored_type("float" + bits);
  return type.substr(1) == "b1" ? std::optional(StoredType{}) : std::nullopt;
}

namespace {

StoredType stored_type_of(const NpyHeader& header, std::string_view path) {
  if (const std::optional<StoredType> type = npy_type(header)) return *type;
  bad_input(path, "integers of 8 to 64 bits, floats of 16 to 64 bits, or truth values",
            "numbers of type " + in_quotes(header.type));
}

bool is_swapped(const std::string& type) {
  const bool big = type[0] == '>';
  const bool little = type[0] == '<';
  return (big || little) && big != (std::endian::native == std::endian::big);
}

// Samples from one to the next along every axis.
std::vector<std::int64_t> strides_of(const NpyHeader& header) {
  std::vector<std::int64_t> strides(header.axes.size(), 1);
  std::int64_t step = 1;
  for (std::size_t n = 0; n < strides.size(); ++n) {
    const std::size_t axis = header.first_fastest ? n : strides.size() - 1 - n;
    strides[axis] = step;
    step *= header.axes[axis].size;
  }
  return strides;
}

// A volume of which i is stored slowest: samples of one i lie together. A band of slices is put together from all of
// the file.
class SlowestFirst final : public BandStream {
 public:
  SlowestFirst(FilePtr file, const VolumeInfo& info, std::uint64_t begin, const std::array<std::int64_t, 3>& strides,
               std::int64_t depth)
      : BandStream(info.dims[2], info.slice_bytes(), depth),
        file_(std::move(file)),
        dims_(info.dims),
        strides_(strides),
        begin_(begin),
        each_(sample_bytes(info.type)) {}

 private:
  void fill(std::int64_t first, std::int64_t count, std::span<std::byte> band) override {
    const auto span = (dims_[1] - 1) * strides_[1] + (count - 1) * strides_[2] + 1;
    plane_.resize(to_size(span, each_));
    const BlockCopy copy{{1, dims_[1], count}, {0, strides_[1], strides_[2]}, {1, dims_[0], dims_[0] * dims_[1]}};
    for (std::int64_t i = 0; i < dims_[0]; ++i) {
      const auto at = static_cast<std::uint64_t>(i * strides_[0] + first * strides_[2]);
      if (file_->read_at(begin_ + at * each_, plane_) < plane_.size()) {
        bad_input(file_->path(), std::to_string(plane_.size()) + " bytes of samples", "fewer");
      }
      copy_block(plane_.data(), band.data() + static_cast<std::size_t>(i) * each_, copy, each_);
    }
  }

  FilePtr file_;
  std::array<std::int64_t, 3> dims_;
  std::array<std::int64_t, 3> strides_;
  std::uint64_t begin_;
  std::size_t each_;
  std::vector<std::byte> plane_;
};

// Slices that are put together at a time where they lie across the file.
std::int64_t band_depth(const VolumeInfo& info) {
  constexpr std::size_t kBandBytes = std::size_t{1} << 28;
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(kBandBytes / info.slice_bytes()), 1, info.dims[2]);
}

void check_whole(const FilePtr& file, const NpyHeader& header, SampleType type) {
  auto bytes = static_cast<std::int64_t>(sample_bytes(type));
  for (const ArrayAxis& axis : header.axes) {
    if (__builtin_mul_overflow(bytes, axis.size, &bytes)) {
      bad_input(file->path(), "an array of fewer than 2^63 bytes", "a larger shape");
    }
  }
  samples_in(file, header.data, static_cast<std::uint64_t>(bytes));
}

std::unique_ptr<ByteStream> samples_of(const FilePtr& file, const NpyHeader& header, const AxisChoice& choice,
                                       const VolumeInfo& info) {
  const std::vector<std::int64_t> strides = strides_of(header);
  std::array<std::int64_t, 3> step{0, 0, 0};
  for (std::size_t a = 0; a < 3; ++a) {
    if (choice.axis.at(a) != kNoAxis) step.at(a) = strides[choice.axis.at(a)];
  }
  std::int64_t first = 0;
  for (std::size_t n = 0; n < strides.size(); ++n) first += choice.at[n] * strides[n];
  const std::uint64_t begin = header.data + static_cast<std::uint64_t>(first) * sample_bytes(info.type);
  if (!header.first_fastest) return samples_in(file, begin, checked_volume_bytes(info));
  return std::make_unique<SlowestFirst>(file, info, begin, step, band_depth(info));
}

}  // namespace

bool is_npy(std::string_view head) { return head.starts_with(kNpyMagic); }

OpenedVolume open_npy_array(const FilePtr& file, const NpyHeader& header, const OpenOptions& options) {
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "npy";
  const StoredType type = stored_type_of(header, info.path);
  info.type = type.type;
  const AxisChoice choice = choose_axes(header.axes, options, info.path);
  check_whole(file, header, info.type);
  info.dims = choice.dims(header.axes);
  info.part = choice.part;
  info.notes = choice.notes;
  info.notes.emplace_back("the spacing is not given and taken as 1");
  checked_volume_bytes(info);
  volume.samples = samples_of(file, header, choice, info);
  volume.swap_bytes = is_swapped(header.type);
  if (type.is_half) read_halves(volume);
  return volume;
}

OpenedVolume open_npy(const FilePtr& file, const OpenOptions& options) {
  return open_npy_array(file, read_npy_header(file), options);
}

}  // namespace isoweave
