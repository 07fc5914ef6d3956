#include "volume/formats/vtk/vtk_xml.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "files/header_text.hpp"
#include "files/quoted.hpp"
#include "files/xml_tag.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {
namespace {

using FilePtr = std::shared_ptr<const InputFile>;

// The numbers before an array.
class WordReader {
 public:
  WordReader(ByteStream& stream, const VtkXmlForm& form, std::string_view path)
      : stream_(stream), form_(form), path_(path) {}

  std::uint64_t next() {
    std::array<std::byte, 8> raw{};
    const std::span<std::byte> word = std::span(raw).first(form_.word);
    if (stream_.read(word) < word.size()) bad_input(path_, "the sizes before an array", "the end of the data");
    if (!form_.big_endian) std::reverse(word.begin(), word.end());
    std::uint64_t value = 0;
    for (const std::byte byte : word) value = value << 8 | std::to_integer<std::uint64_t>(byte);
    return value;
  }

 private:
  ByteStream& stream_;
  const VtkXmlForm& form_;
  std::string_view path_;
};

// `left`: bytes of the file from the array on. `bytes`: of the array.
BlockSizes read_block_sizes(WordReader& words, std::size_t word, std::uint64_t left, std::uint64_t bytes,
                            std::string_view path) {
  const std::uint64_t blocks = words.next();
  BlockSizes sizes;
  sizes.block = words.next();
  sizes.last = words.next();
  const std::uint64_t full = blocks - (sizes.last > 0 && blocks > 0 ? 1 : 0);
  std::uint64_t total = 0;
  const bool wrong = blocks > left / word || sizes.last > bytes || __builtin_mul_overflow(full, sizes.block, &total) ||
                     total != bytes - sizes.last || (full > 0 && sizes.block == 0);
  if (wrong) {
    bad_input(
        path, "compressed blocks of " + std::to_string(bytes) + " bytes in all",
        std::to_string(blocks) + " of " + std::to_string(sizes.block) + ", the last of " + std::to_string(sizes.last));
  }
  std::uint64_t stored = 0;
  for (std::uint64_t n = 0; n < blocks; ++n) {
    sizes.stored.push_back(words.next());
    if (sizes.stored.back() > left - stored) {
      bad_input(path, "compressed blocks within " + std::to_string(left) + " bytes",
                std::to_string(sizes.stored.back()) + " bytes in block " + std::to_string(n));
    }
    stored += sizes.stored.back();
  }
  return sizes;
}

// The array from the sizes before it on, out of base64.
std::unique_ptr<ByteStream> stored_array(const FilePtr& file, const VtkArray& array, const VtkAppended& appended) {
  const std::uint64_t begin = vtk_array_begin(*file, array, appended);
  std::unique_ptr<ByteStream> stream = std::make_unique<FileStream>(file, begin, file->size());
  if (array.format != VtkArray::Format::kInline && !appended.base64) return stream;
  return std::make_unique<Base64Stream>(std::move(stream), file->path());
}

}  // namespace

bool VtkTags::fill() {
  if (position_ >= begin_ && position_ < begin_ + filled_) return true;
  begin_ = position_;
  filled_ = file_->read_at(begin_, buffer_);
  return filled_ > 0;
}

char VtkTags::take() {
  return fill() ? std::to_integer<char>(buffer_[static_cast<std::size_t>(position_++ - begin_)]) : '\0';
}

// Moves behind the next '<'; false at the end of the file.
bool VtkTags::find_bracket() {
  while (fill()) {
    const auto from = static_cast<std::size_t>(position_ - begin_);
    const void* const found = std::memchr(buffer_.data() + from, '<', filled_ - from);
    position_ = found == nullptr
                    ? begin_ + filled_
                    : begin_ + static_cast<std::uint64_t>(static_cast<const std::byte*>(found) - buffer_.data()) + 1;
    if (found != nullptr) return true;
  }
  return false;
}

std::string VtkTags::next() {
  while (find_bracket()) {
    std::string tag = inside();
    if (!tag.starts_with('?') && !tag.starts_with('!')) return tag;
  }
  return {};
}

// Up to the bracket that ends the tag; one in quotes or in a comment does not.
std::string VtkTags::inside() {
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

std::string_view vtk_tag_name(std::string_view tag) { return tag.substr(0, tag.find_first_of(" \t\r\n/", 1)); }

VtkXmlForm vtk_xml_form(std::string_view tag, const std::string& path) {
  VtkXmlForm form;
  form.type = xml_attribute(tag, "type");
  form.big_endian = xml_attribute(tag, "byte_order") == "BigEndian";
  const std::string word = xml_attribute(tag, "header_type");
  if (!word.empty() && word != "UInt32" && word != "UInt64") {
    bad_input(path, "header_type UInt32 or UInt64", in_quotes(word));
  }
  form.word = word == "UInt64" ? 8 : 4;
  const std::string compressor = xml_attribute(tag, "compressor");
  if (compressor.empty()) return form;
  if (compressor == "vtkZLibDataCompressor") {
    form.blocks = BlockForm::kZlib;
  } else if (compressor == "vtkLZ4DataCompressor") {
    form.blocks = BlockForm::kLz4;
  } else if (compressor == "vtkLZMADataCompressor") {
    form.blocks = BlockForm::kLzma;
  } else {
    bad_input(path, "the compressor of zlib, LZ4 or LZMA", in_quotes(compressor));
  }
  return form;
}

VtkArray vtk_array(std::string_view tag, std::uint64_t behind, const std::string& path) {
  VtkArray array;
  array.name = xml_attribute(tag, "Name");
  array.type = xml_attribute(tag, "type");
  const std::string components = xml_attribute(tag, "NumberOfComponents");
  if (!components.empty()) array.components = parse_integer(trimmed(components)).value_or(0);
  array.at = behind;
  const std::string format = xml_attribute(tag, "format");
  if (format == "appended") {
    const auto offset = parse_integer(trimmed(xml_attribute(tag, "offset")));
    if (!offset || *offset < 0) bad_input(path, "the offset of an appended array", "none");
    array.format = VtkArray::Format::kAppended;
    array.at = static_cast<std::uint64_t>(*offset);
  } else if (format == "binary") {
    array.format = VtkArray::Format::kInline;
  } else if (format != "ascii") {
    bad_input(path, "an array of format ascii, binary or appended", in_quotes(format));
  }
  return array;
}

VtkAppended vtk_appended(std::string_view tag, std::uint64_t behind, const InputFile& file) {
  // The arrays begin behind the first underscore.
  constexpr std::size_t kBlanks = 1024;
  std::string blanks(kBlanks, '\0');
  blanks.resize(file.read_at(behind, std::as_writable_bytes(std::span(blanks))));
  const std::size_t first = blanks.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || blanks[first] != '_') {
    bad_input(file.path(), "'_' before the appended data", "something else");
  }
  return {behind + first + 1, xml_attribute(tag, "encoding") != "raw"};
}

std::uint64_t vtk_array_begin(const InputFile& file, const VtkArray& array, const VtkAppended& appended) {
  if (array.format != VtkArray::Format::kAppended) return array.at;
  if (appended.begin == 0) bad_input(file.path(), "an AppendedData section", "none");
  const std::uint64_t left = file.size() - std::min(appended.begin, file.size());
  if (array.at > left) {
    bad_input(file.path(), "an array " + std::to_string(array.at) + " bytes into the appended data",
              std::to_string(left) + " bytes of them");
  }
  return appended.begin + array.at;
}

std::unique_ptr<ByteStream> open_vtk_array(const FilePtr& file, const VtkXmlForm& form, const VtkArray& array,
                                           const VtkAppended& appended, std::uint64_t bytes) {
  const std::string& path = file->path();
  const std::uint64_t left = file->size() - std::min(vtk_array_begin(*file, array, appended), file->size());
  std::unique_ptr<ByteStream> stream = stored_array(file, array, appended);
  check_plausible(path, bytes, left, !form.blocks ? 1 : *form.blocks == BlockForm::kLzma ? kLzmaRatio : kDeflateRatio);
  WordReader words(*stream, form, path);
  if (form.blocks) {
    BlockSizes sizes = read_block_sizes(words, form.word, left, bytes, path);
    return std::make_unique<BlockStream>(std::move(stream), *form.blocks, std::move(sizes), path);
  }
  const std::uint64_t said = words.next();
  if (said != bytes) bad_input(path, std::to_string(bytes) + " bytes in the array", std::to_string(said));
  return stream;
}

std::uint64_t vtk_array_bytes(const FilePtr& file, const VtkXmlForm& form, const VtkArray& array,
                              const VtkAppended& appended) {
  const std::unique_ptr<ByteStream> stream = stored_array(file, array, appended);
  WordReader words(*stream, form, file->path());
  const std::uint64_t first = words.next();
  if (!form.blocks || first == 0) return first;
  const std::uint64_t block = words.next();
  const std::uint64_t last = words.next();
  std::uint64_t bytes = 0;
  const bool too_many =
      __builtin_mul_overflow(first - (last > 0 ? 1 : 0), block, &bytes) || __builtin_add_overflow(bytes, last, &bytes);
  return too_many ? std::numeric_limits<std::uint64_t>::max() : bytes;
}

}  // namespace isoweave
