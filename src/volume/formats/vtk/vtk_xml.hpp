// VTK's XML files: tags one after another, and arrays in every encoding that VTK writes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "files/input_file.hpp"
#include "volume/formats/vtk/vtk_streams.hpp"

namespace isoweave {

// Tags of a file in their order; text between them is passed over, comments and declarations too.
class VtkTags {
 public:
  explicit VtkTags(std::shared_ptr<const InputFile> file) : file_(std::move(file)) {}

  // The next tag without its brackets; empty at the end of the file.
  std::string next();

  // The byte behind the last tag.
  std::uint64_t position() const { return position_; }

 private:
  bool fill();
  char take();
  bool find_bracket();
  std::string inside();

  std::shared_ptr<const InputFile> file_;
  std::uint64_t position_ = 0;
  std::uint64_t begin_ = 0;
  std::size_t filled_ = 0;
  std::array<std::byte, 64 * 1024> buffer_;
};

// "DataArray", "/Piece", ...
std::string_view vtk_tag_name(std::string_view tag);

// The facts about all arrays in the tag VTKFile.
struct VtkXmlForm {
  std::string type;  // "ImageData", "PolyData", ...
  bool big_endian = false;
  std::size_t word = 4;             // bytes of the numbers before an array
  std::optional<BlockForm> blocks;  // of compressed arrays
};

VtkXmlForm vtk_xml_form(std::string_view tag, const std::string& path);

// The facts in the tag of an array.
struct VtkArray {
  enum class Format { kText, kInline, kAppended };

  std::string name;
  std::string type;             // "Float32", "Int64", ...
  std::int64_t components = 1;  // 0: not said in a way that can be read
  Format format = Format::kText;
  std::uint64_t at = 0;  // the byte behind the tag; of appended arrays, how far they are into the section

  bool is_text() const { return format == Format::kText; }
};

// `behind`: the byte behind the tag.
VtkArray vtk_array(std::string_view tag, std::uint64_t behind, const std::string& path);

// The section of appended arrays.
struct VtkAppended {
  std::uint64_t begin = 0;  // of its first array; 0: there is no section
  bool base64 = false;
};

VtkAppended vtk_appended(std::string_view tag, std::uint64_t behind, const InputFile& file);

// The place where the text or the bytes of an array begin.
std::uint64_t vtk_array_begin(const InputFile& file, const VtkArray& array, const VtkAppended& appended);

// The numbers of an array that is not text, as stored: `bytes` of them, which is compared with the file and with what
// stands before the array.
std::unique_ptr<ByteStream> open_vtk_array(const std::shared_ptr<const InputFile>& file, const VtkXmlForm& form,
                                           const VtkArray& array, const VtkAppended& appended, std::uint64_t bytes);

// The bytes that an array which is not text says it has.
std::uint64_t vtk_array_bytes(const std::shared_ptr<const InputFile>& file, const VtkXmlForm& form,
                              const VtkArray& array, const VtkAppended& appended);

}  // namespace isoweave
