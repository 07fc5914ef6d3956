// Numbers of VTK's arrays, one after another, for meshes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "volume/formats/vtk/vtk_streams.hpp"

namespace isoweave::mesh_io {

struct VtkNumberType {
  enum class Kind { kSigned, kUnsigned, kReal };

  Kind kind = Kind::kSigned;
  std::size_t bytes = 4;

  bool is_wide() const { return kind == Kind::kReal && bytes == 8; }
};

// "Float32", "Int64", ...
std::optional<VtkNumberType> vtk_xml_number(std::string_view name);

class VtkNumbers {
 public:
  // `text`: numbers between blanks; else as stored in `type`.
  VtkNumbers(std::unique_ptr<ByteStream> stream, VtkNumberType type, bool text, bool big_endian, std::string path);

  // The next one as a double, which holds the float that is nearest to a text where the type is that of floats.
  double real();

  // The next one as the number of a point or a count. Fails when it is none.
  std::uint64_t index();

  // Characters of text that were read.
  std::uint64_t position() const { return text_.position(); }

 private:
  std::uint64_t next_bits();
  std::string next_word();

  VtkNumberType type_;
  bool is_text_, big_endian_;
  std::string path_;
  std::unique_ptr<ByteStream> stream_;
  TextStream text_;
  std::array<std::byte, 32 * 1024> buffer_;
  std::size_t used_ = 0, filled_ = 0;
};

}  // namespace isoweave::mesh_io
