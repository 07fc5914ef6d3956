#include "mesh/read/vtk_numbers.hpp"

#include <bit>
#include <utility>

#include "files/input_file.hpp"
#include "files/quoted.hpp"
#include "mesh/read/mesh_input.hpp"
#include "mesh/read/mesh_place.hpp"

namespace isoweave::mesh_io {

std::optional<VtkNumberType> vtk_xml_number(std::string_view name) {
  using Kind = VtkNumberType::Kind;
  if (name == "Float32") return VtkNumberType{Kind::kReal, 4};
  if (name == "Float64") return VtkNumberType{Kind::kReal, 8};
  for (const std::size_t bytes : {1U, 2U, 4U, 8U}) {
    const std::string bits = std::to_string(8 * bytes);
    if (name == "Int" + bits) return VtkNumberType{Kind::kSigned, bytes};
    if (name == "UInt" + bits) return VtkNumberType{Kind::kUnsigned, bytes};
  }
  return std::nullopt;
}

VtkNumbers::VtkNumbers(std::unique_ptr<ByteStream> stream, VtkNumberType type, bool text, bool big_endian,
                       std::string path)
    : type_(type),
      is_text_(text),
      big_endian_(big_endian),
      path_(std::move(path)),
      stream_(text ? nullptr : std::move(stream)),
      text_(std::move(stream)) {}

std::string VtkNumbers::next_word() {
  std::string word = text_.next_word();
  if (word.empty()) bad_input(path_, "as many numbers as its header says", "the end of an array");
  return word;
}

// One number as stored; those of fewer than 8 bytes have their sign in front.
std::uint64_t VtkNumbers::next_bits() {
  if (used_ == filled_) {
    filled_ = stream_->read(std::span(buffer_).first(buffer_.size() / type_.bytes * type_.bytes));
    used_ = 0;
  }
  if (filled_ - used_ < type_.bytes) bad_input(path_, "as many numbers as its header says", "the end of an array");
  const auto raw = std::span(buffer_).subspan(used_, type_.bytes);
  used_ += type_.bytes;
  std::uint64_t value = 0;
  for (std::size_t n = 0; n < raw.size(); ++n) {
    value = value << 8 | std::to_integer<std::uint64_t>(raw[big_endian_ ? n : raw.size() - 1 - n]);
  }
  const std::size_t above = 64 - 8 * type_.bytes;
  if (type_.kind != VtkNumberType::Kind::kSigned) return value;
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(value << above) >> above);
}

double VtkNumbers::real() {
  if (is_text_) {
    const std::string word = next_word();
    std::optional<double> value = type_.is_wide() ? std::nullopt : parse_wide(word);
    if (!value) value = parse_real<double>(word);
    if (!value) bad_input(path_, "a number", in_quotes(word));
    return *value;
  }
  const std::uint64_t bits = next_bits();
  switch (type_.kind) {
    case VtkNumberType::Kind::kSigned:
      return static_cast<double>(static_cast<std::int64_t>(bits));
    case VtkNumberType::Kind::kUnsigned:
      return static_cast<double>(bits);
    case VtkNumberType::Kind::kReal:
      break;
  }
  if (type_.bytes == 8) return std::bit_cast<double>(bits);
  return double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))};
}

std::uint64_t VtkNumbers::index() {
  if (type_.kind == VtkNumberType::Kind::kReal) bad_input(path_, "whole numbers as indices", "an array of others");
  std::optional<std::uint64_t> value;
  std::string word;
  if (is_text_) {
    word = next_word();
    value = parse_integer<std::uint64_t>(word);
  } else {
    value = next_bits();
    if (type_.kind == VtkNumberType::Kind::kSigned && static_cast<std::int64_t>(*value) < 0) {
      word = std::to_string(static_cast<std::int64_t>(*value));
      value.reset();
    }
  }
  if (!value) bad_input(path_, "an index or a count", in_quotes(word));
  return *value;
}

}  // namespace isoweave::mesh_io
