// VTI: VTK's XML image data. Tags are read one after another up to the array that is wanted; its samples follow the
// tag, or lie in the appended section behind the last one.
#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "volume/formats.hpp"
#include "volume/geometry.hpp"
#include "volume/header_text.hpp"
#include "volume/printable.hpp"
#include "volume/vtk_streams.hpp"
#include "volume/xml_tag.hpp"

namespace isoweave {
namespace {

// Tags of a file in their order; text between them is passed over.
class TagReader {
 public:
  explicit TagReader(const FilePtr& file) : file_(file) {}

  // The next tag without its brackets; empty at the end of the file.
  std::string next() {
    for (char c = take(); c != '\0' || position_ < file_->size(); c = take()) {
      if (c != '<') continue;
      std::string tag = inside();
      if (!tag.starts_with('?') && !tag.starts_with('!')) return tag;
    }
    return {};
  }

  // The byte behind the last tag.
  std::uint64_t position() const { return position_; }

 private:
  char take() {
    if (position_ < begin_ || position_ >= begin_ + filled_) {
      begin_ = position_;
      filled_ = file_->read_at(begin_, buffer_);
      if (filled_ == 0) return '\0';
    }
    return std::to_integer<char>(buffer_[static_cast<std::size_t>(position_++ - begin_)]);
  }

  // Up to the bracket that ends the tag; one in quotes or in a comment does not.
  std::string inside() {
    constexpr std::size_t kLongest = 1 << 16;
    std::string tag;
    char quote = '\0';
    while (tag.size() < kLongest && position_ < file_->size()) {
      const char c = take();
      const bool comment = tag.starts_with("!--");
      if (c == '>' && quote == '\0' && (!comment || tag.ends_with("--"))) return tag;
      if (quote != '\0') {
        if (c == quote) quote = '\0';
      } else if (!comment && (c == '"' || c == '\'')) {
        quote = c;
      }
      tag += c;
    }
    bad_input(file_->path(), "a complete XML tag", "one that does not end");
  }

  FilePtr file_;
  std::uint64_t position_ = 0;
  std::uint64_t begin_ = 0;
  std::size_t filled_ = 0;
  std::array<std::byte, 64 * 1024> buffer_;
};

std::string_view name_of(std::string_view tag) { return tag.substr(0, tag.find_first_of(" \t\r\n/", 1)); }

struct VtiHeader {
  bool big_endian = false;
  std::size_t word = 4;             // bytes of the numbers before an array
  std::optional<BlockForm> blocks;  // of compressed arrays
  std::string whole_extent;
  std::string origin;
  std::string spacing;
  std::string direction;
  std::string extent;
  std::string array;       // the tag of the array that is read
  std::uint64_t data = 0;  // where its samples begin
  bool base64 = false;
  bool text = false;
};

void take_file(VtiHeader& header, std::string_view tag, const std::string& path) {
  const std::string type = xml_attribute(tag, "type");
  if (type != "ImageData") bad_input(path, "VTK XML of type ImageData", quoted(type));
  header.big_endian = xml_attribute(tag, "byte_order") == "BigEndian";
  const std::string word = xml_attribute(tag, "header_type");
  if (!word.empty() && word != "UInt32" && word != "UInt64") {
    bad_input(path, "header_type UInt32 or UInt64", quoted(word));
  }
  header.word = word == "UInt64" ? 8 : 4;
  const std::string compressor = xml_attribute(tag, "compressor");
  if (compressor.empty()) return;
  if (compressor == "vtkZLibDataCompressor") {
    header.blocks = BlockForm::kZlib;
  } else if (compressor == "vtkLZ4DataCompressor") {
    header.blocks = BlockForm::kLz4;
  } else {
    bad_input(path, "no compressor, vtkZLibDataCompressor or vtkLZ4DataCompressor", quoted(compressor));
  }
}

void take_image(VtiHeader& header, std::string_view tag) {
  header.whole_extent = xml_attribute(tag, "WholeExtent");
  header.origin = xml_attribute(tag, "Origin");
  header.spacing = xml_attribute(tag, "Spacing");
  header.direction = xml_attribute(tag, "Direction");
}

std::int64_t components_of(std::string_view array) {
  const std::string text = xml_attribute(array, "NumberOfComponents");
  return text.empty() ? 1 : parse_integer(text).value_or(0);
}

// Picks the active scalars among the arrays of PointData or, where none are active, the first of one component.
void find_array(VtiHeader& header, TagReader& tags, const std::string& active, const std::string& path) {
  std::string names;
  while (true) {
    const std::string tag = tags.next();
    if (tag.empty() || name_of(tag) == "/PointData") break;
    if (name_of(tag) != "DataArray") continue;
    const std::string name = xml_attribute(tag, "Name");
    names += (names.empty() ? "" : ", ") + name;
    if (active.empty() ? components_of(tag) != 1 : name != active) continue;
    header.array = tag;
    header.data = tags.position();
    return;
  }
  const std::string wanted = active.empty() ? "a point array of one component" : "the point array " + quoted(active);
  bad_input(path, wanted, names.empty() ? "none" : names);
}

void find_appended(VtiHeader& header, TagReader& tags, const FilePtr& file) {
  const std::string& path = file->path();
  const auto offset = parse_integer(trimmed(xml_attribute(header.array, "offset")));
  if (!offset || *offset < 0) bad_input(path, "the offset of an appended array", "none");
  std::string tag = tags.next();
  while (!tag.empty() && name_of(tag) != "AppendedData") tag = tags.next();
  if (tag.empty()) bad_input(path, "an AppendedData section", "none");
  header.base64 = xml_attribute(tag, "encoding") != "raw";
  // The samples begin behind the first underscore.
  constexpr std::size_t kBlanks = 1024;
  std::string blanks(kBlanks, '\0');
  blanks.resize(file->read_at(tags.position(), std::as_writable_bytes(std::span(blanks))));
  const std::size_t first = blanks.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || blanks[first] != '_') {
    bad_input(path, "'_' before the appended data", "something else");
  }
  header.data = tags.position() + first + 1;
  const std::uint64_t left = file->size() - std::min(header.data, file->size());
  if (static_cast<std::uint64_t>(*offset) > left) {
    bad_input(path, "an array " + std::to_string(*offset) + " bytes into the appended data",
              std::to_string(left) + " bytes of them");
  }
  header.data += static_cast<std::uint64_t>(*offset);
}

void find_data(VtiHeader& header, TagReader& tags, const FilePtr& file) {
  const std::string format = xml_attribute(header.array, "format");
  if (format == "appended") {
    find_appended(header, tags, file);
  } else if (format == "binary") {
    header.base64 = true;
  } else if (format == "ascii") {
    header.text = true;
  } else {
    bad_input(file->path(), "an array of format ascii, binary or appended", quoted(format));
  }
}

VtiHeader read_header(const FilePtr& file) {
  VtiHeader header;
  TagReader tags(file);
  for (std::string tag = tags.next(); !tag.empty(); tag = tags.next()) {
    const std::string_view name = name_of(tag);
    if (name == "VTKFile") take_file(header, tag, file->path());
    if (name == "ImageData") take_image(header, tag);
    if (name == "Piece") header.extent = xml_attribute(tag, "Extent");
    if (name != "PointData") continue;
    find_array(header, tags, xml_attribute(tag, "Scalars"), file->path());
    find_data(header, tags, file);
    return header;
  }
  bad_input(file->path(), "PointData in its image data", "none");
}

template <std::size_t kCount>
std::array<double, kCount> numbers_of(const std::string& text, std::string_view what, std::string_view path) {
  std::array<double, kCount> numbers{};
  const std::vector<std::string_view> words = words_of(text);
  for (std::size_t n = 0; n < std::min(kCount, words.size()); ++n) {
    const auto number = parse_double(words[n]);
    if (!number) bad_input(path, "numbers as " + std::string(what), quoted(words[n]));
    numbers[n] = *number;
  }
  if (words.size() != kCount) {
    bad_input(path, std::to_string(kCount) + " numbers as " + std::string(what), quoted(text));
  }
  return numbers;
}

// First and last sample of each axis.
std::array<std::int64_t, 6> extent_of(const std::string& text, std::string_view path) {
  std::array<std::int64_t, 6> extent{};
  const std::vector<std::string_view> words = words_of(text);
  constexpr std::int64_t kFarthest = std::int64_t{1} << 40;
  bool sane = words.size() == extent.size();
  for (std::size_t n = 0; sane && n < extent.size(); ++n) {
    const auto number = parse_integer(words[n]);
    sane = number && *number > -kFarthest && *number < kFarthest;
    if (sane) extent[n] = *number;
  }
  if (!sane) bad_input(path, "six whole numbers as an extent", quoted(text));
  return extent;
}

void set_place(VolumeInfo& info, const VtiHeader& header) {
  const auto whole = extent_of(header.whole_extent, info.path);
  if (extent_of(header.extent.empty() ? header.whole_extent : header.extent, info.path) != whole) {
    bad_input(info.path, "one piece of the whole extent " + quoted(header.whole_extent), quoted(header.extent));
  }
  const auto origin = numbers_of<3>(header.origin.empty() ? "0 0 0" : header.origin, "Origin", info.path);
  const auto spacing = numbers_of<3>(header.spacing.empty() ? "1 1 1" : header.spacing, "Spacing", info.path);
  const auto direction =
      numbers_of<9>(header.direction.empty() ? "1 0 0 0 1 0 0 0 1" : header.direction, "Direction", info.path);
  Axes axes;
  axes.origin = origin;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    info.dims[axis] = whole[2 * axis + 1] - whole[2 * axis] + 1;
    for (std::size_t row = 0; row < 3; ++row) {
      axes.steps[axis][row] = direction[3 * row + axis] * spacing[axis];
      axes.origin[row] += axes.steps[axis][row] * static_cast<double>(whole[2 * axis]);
    }
  }
  set_geometry(info.geometry, axes, info.path);
}

SampleType sample_type_of(std::string_view array, std::string_view path) {
  const std::string name = xml_attribute(array, "type");
  const auto type = parse_sample_type(lower_case(name));
  if (!type) bad_input(path, "an array of 8 to 32 bit integers, Float32 or Float64", quoted(name));
  if (components_of(array) != 1) {
    bad_input(path, "one component per sample",
              xml_attribute(array, "NumberOfComponents") + " in " + quoted(xml_attribute(array, "Name")));
  }
  return *type;
}

// The numbers before an array.
class WordReader {
 public:
  WordReader(ByteStream& stream, const VtiHeader& header, std::string_view path)
      : stream_(stream), header_(header), path_(path) {}

  std::uint64_t next() {
    std::array<std::byte, 8> raw{};
    const std::span<std::byte> word = std::span(raw).first(header_.word);
    if (stream_.read(word) < word.size()) bad_input(path_, "the sizes before an array", "the end of the data");
    if (!header_.big_endian) std::reverse(word.begin(), word.end());
    std::uint64_t value = 0;
    for (const std::byte byte : word) value = value << 8 | std::to_integer<std::uint64_t>(byte);
    return value;
  }

 private:
  ByteStream& stream_;
  const VtiHeader& header_;
  std::string_view path_;
};

BlockSizes read_block_sizes(ByteStream& stream, const VtiHeader& header, const FilePtr& file, std::uint64_t bytes) {
  WordReader words(stream, header, file->path());
  const std::uint64_t blocks = words.next();
  BlockSizes sizes;
  sizes.block = words.next();
  sizes.last = words.next();
  const std::uint64_t left = file->size() - header.data;
  const std::uint64_t full = blocks - (sizes.last > 0 && blocks > 0 ? 1 : 0);
  std::uint64_t total = 0;
  const bool wrong = blocks > left / header.word || sizes.last > bytes ||
                     __builtin_mul_overflow(full, sizes.block, &total) || total != bytes - sizes.last ||
                     (full > 0 && sizes.block == 0);
  if (wrong) {
    bad_input(
        file->path(), "compressed blocks of " + std::to_string(bytes) + " bytes in all",
        std::to_string(blocks) + " of " + std::to_string(sizes.block) + ", the last of " + std::to_string(sizes.last));
  }
  std::uint64_t stored = 0;
  for (std::uint64_t n = 0; n < blocks; ++n) {
    sizes.stored.push_back(words.next());
    if (sizes.stored.back() > left - stored) {
      bad_input(file->path(), "compressed blocks within " + std::to_string(left) + " bytes",
                std::to_string(sizes.stored.back()) + " bytes in block " + std::to_string(n));
    }
    stored += sizes.stored.back();
  }
  return sizes;
}

std::unique_ptr<ByteStream> samples_of(const FilePtr& file, const VtiHeader& header, SampleType type,
                                       std::uint64_t bytes) {
  const std::string& path = file->path();
  const std::uint64_t left = file->size() - std::min(header.data, file->size());
  std::unique_ptr<ByteStream> stream = std::make_unique<FileStream>(file, header.data, file->size());
  if (header.text) {
    // A digit and a blank for each sample.
    const std::uint64_t samples = bytes / sample_bytes(type);
    check_plausible(path, 2 * samples, left + 1, 1);
    return std::make_unique<NumberStream>(std::move(stream), type, samples, path);
  }
  if (header.base64) stream = std::make_unique<Base64Stream>(std::move(stream), path);
  check_plausible(path, bytes, left, header.blocks ? kDeflateRatio : 1);
  if (header.blocks) {
    BlockSizes sizes = read_block_sizes(*stream, header, file, bytes);
    return std::make_unique<BlockStream>(std::move(stream), *header.blocks, std::move(sizes), path);
  }
  const std::uint64_t said = WordReader(*stream, header, path).next();
  if (said != bytes) bad_input(path, std::to_string(bytes) + " bytes in the array", std::to_string(said));
  return stream;
}

}  // namespace

bool is_vti(std::string_view head) {
  const std::size_t tag = head.find("<VTKFile");
  // Behind nothing but the XML declaration and comments.
  return tag != std::string_view::npos && trimmed(head).starts_with('<');
}

OpenedVolume open_vti(const FilePtr& file) {
  const VtiHeader header = read_header(file);
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "vti";
  info.type = sample_type_of(header.array, info.path);
  set_place(info, header);
  const std::uint64_t bytes = checked_volume_bytes(info);
  volume.samples = samples_of(file, header, info.type, bytes);
  volume.swap_bytes = !header.text && header.big_endian != (std::endian::native == std::endian::big);
  return volume;
}

}  // namespace isoweave
