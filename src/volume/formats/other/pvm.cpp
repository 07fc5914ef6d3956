// PVM volumes of the Volume Library, versions 1 to 3, plain or in a DDS stream.
#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <utility>
#include <vector>

#include "files/header_text.hpp"
#include "files/quoted.hpp"
#include "volume/axes.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/other/dds_stream.hpp"

namespace isoweave {
namespace {

constexpr std::string_view kWholeSorted = "DDS v3d\n";
constexpr std::string_view kBlockSorted = "DDS v3e\n";

// Reads a text header from a stream and leaves the stream at the first byte behind it.
class HeaderStream {
 public:
  HeaderStream(ByteStream& stream, std::string_view path) : stream_(stream), path_(path) {}

  // The next line that is no comment.
  std::string line() {
    std::string text = any_line();
    while (text.starts_with('#')) text = any_line();
    return text;
  }

  std::uint64_t position() const { return position_; }

 private:
  std::string any_line() {
    constexpr std::size_t kLongest = 4096;
    std::string text;
    while (position_ < kLargestHeader && text.size() < kLongest) {
      std::array<std::byte, 1> next;
      if (stream_.read(next) == 0) bad_input(path_, "a complete PVM header", "its end missing");
      ++position_;
      const char c = std::to_integer<char>(next[0]);
      if (c == '\n') return text;
      text += c;
    }
    bad_input(path_, "a PVM header of short lines", "no line end");
  }

  ByteStream& stream_;
  std::string_view path_;
  std::uint64_t position_ = 0;
};

int version_of(std::string_view magic, std::string_view path) {
  if (magic == "PVM") return 1;
  if (magic == "PVM2") return 2;
  if (magic == "PVM3") return 3;
  bad_input(path, "PVM, PVM2 or PVM3", in_quotes(magic));
}

void set_dims(VolumeInfo& info, const std::string& line) {
  const std::vector<std::string_view> words = words_of(line);
  if (words.size() != 3) bad_input(info.path, "a line 'width height depth'", in_quotes(line));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto side = parse_integer(words[axis]);
    if (!side) bad_input(info.path, "whole numbers as dimensions", in_quotes(words[axis]));
    info.dims[axis] = *side;
  }
}

void set_spacing(VolumeInfo& info, const std::string& line) {
  const std::vector<std::string_view> words = words_of(line);
  if (words.size() != 3) bad_input(info.path, "a line of 3 spacings", in_quotes(line));
  Axes axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto spacing = parse_double(words[axis]);
    if (!spacing || !(*spacing > 0)) {
      bad_input(info.path, "positive spacings", in_quotes(words[axis]));
    }
    axes.steps[axis][axis] = *spacing;
  }
  set_geometry(info.geometry, axes, info.path);
}

SampleType pvm_type_of(const std::string& line, std::string_view path) {
  const std::string_view components = trimmed(line);
  if (components == "1") return SampleType::kUint8;
  if (components == "2") return SampleType::kUint16;
  const std::string found = components == "3" ? "3 (RGB)" : in_quotes(components);
  bad_input(path, "1 or 2 bytes per sample", found);
}

struct PvmContent {
  std::unique_ptr<ByteStream> stream;
  std::uint64_t bytes;
};

PvmContent content_of(const FilePtr& file) {
  const std::string magic = file->head(kWholeSorted.size());
  if (magic != kWholeSorted && magic != kBlockSorted) {
    return {std::make_unique<FileStream>(file, 0, file->size()), file->size()};
  }
  const std::uint64_t block = magic == kBlockSorted ? DdsStream::kBlockSamples : 0;
  auto stream = std::make_unique<DdsStream>(file, magic.size(), block);
  const std::uint64_t bytes = stream->total_bytes();
  return {std::move(stream), bytes};
}

}  // namespace

bool is_pvm(std::string_view head) {
  for (const std::string_view magic : {std::string_view("PVM\n"), std::string_view("PVM2\n"),
                                       std::string_view("PVM3\n"), kWholeSorted, kBlockSorted}) {
    if (head.starts_with(magic)) return true;
  }
  return false;
}

OpenedVolume open_pvm(const FilePtr& file) {
  PvmContent content = content_of(file);
  HeaderStream header(*content.stream, file->path());
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "pvm";
  const int version = version_of(header.line(), info.path);
  set_dims(info, header.line());
  if (version > 1) set_spacing(info, header.line());
  info.type = pvm_type_of(header.line(), info.path);
  const std::uint64_t bytes = checked_volume_bytes(info);
  if (content.bytes - header.position() < bytes) {
    bad_input(info.path, std::to_string(bytes) + " bytes of samples",
              std::to_string(content.bytes - header.position()));
  }
  // Samples of two bytes have the most significant one first.
  volume.swap_bytes = std::endian::native == std::endian::little;
  volume.samples = std::move(content.stream);
  return volume;
}

}  // namespace isoweave
