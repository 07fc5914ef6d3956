#include "mesh/read/ply_header.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "files/quoted.hpp"
#include "mesh/read/mesh_words.hpp"

namespace isoweave::mesh_io {
namespace {

// The limits of a header. No real header comes near them, and a hostile one could ask for hours of comparing names.
constexpr std::size_t kLongestHeader = std::size_t{1} << 20;
constexpr std::size_t kMostElements = 256;
constexpr std::size_t kMostProperties = 1024;

struct NamedType {
  std::string_view name;
  PlyType type;
};

constexpr std::array<NamedType, 18> kTypes{{{"char", PlyType::kInt8},
                                            {"uchar", PlyType::kUint8},
                                            {"short", PlyType::kInt16},
                                            {"ushort", PlyType::kUint16},
                                            {"int", PlyType::kInt32},
                                            {"uint", PlyType::kUint32},
                                            {"float", PlyType::kFloat32},
                                            {"double", PlyType::kFloat64},
                                            {"int8", PlyType::kInt8},
                                            {"uint8", PlyType::kUint8},
                                            {"int16", PlyType::kInt16},
                                            {"uint16", PlyType::kUint16},
                                            {"int32", PlyType::kInt32},
                                            {"uint32", PlyType::kUint32},
                                            {"int64", PlyType::kInt64},
                                            {"uint64", PlyType::kUint64},
                                            {"float32", PlyType::kFloat32},
                                            {"float64", PlyType::kFloat64}}};

const PlyProperty* find_property(const PlyElement& element, std::string_view name) {
  for (const PlyProperty& property : element.properties) {
    if (property.name == name) return &property;
  }
  return nullptr;
}

bool is_real(const PlyProperty& property) {
  return property.type == PlyType::kFloat32 || property.type == PlyType::kFloat64;
}

// Whether a property is a part of a place, direction or colour: such a number says nothing on its own.
bool is_part_of_more(std::string_view name) {
  for (const char* known :
       {"x", "y", "z", "nx",  "ny",    "nz",   "r",     "g",         "b",         "a",      "u",
        "v", "s", "t", "red", "green", "blue", "alpha", "texture_u", "texture_v", "radius", "confidence"}) {
    if (name == known) return true;
  }
  for (const char* known : {"diffuse_", "ambient_", "specular_", "normal_"}) {
    if (name.starts_with(known)) return true;
  }
  return false;
}

// The name of the vertices' value: one of the names that programs give it, or else the only real number that is no part
// of anything else. Whole numbers of another name may be labels, which cannot be interpolated.
std::string choose_values(const PlyElement& element) {
  for (const std::string_view known : {"quality", "scalar", "value", "intensity", "scalar_"}) {
    for (const PlyProperty& property : element.properties) {
      const std::string name = lower_case(property.name);
      const bool fits = known.back() == '_' ? name.starts_with(known) : name == known;
      if (fits && !property.length_type) return property.name;
    }
  }
  std::string only;
  for (const PlyProperty& property : element.properties) {
    if (property.length_type || !is_real(property) || is_part_of_more(lower_case(property.name))) continue;
    if (!only.empty()) return {};
    only = property.name;
  }
  return only;
}

class HeaderReader {
 public:
  explicit HeaderReader(MeshInput& input) : input_(input) {}

  PlyHeader read() {
    read_first_line();
    do {
      next_line();
    } while (read_statement());
    if (!has_format_) input_.fail("its header has no 'format'");
    check_elements();
    return std::move(header_);
  }

 private:
  // Reads the first line, whose end is that of all lines. A byte order mark and empty lines before it are passed over.
  void read_first_line() {
    skip_byte_order_mark(input_);
    std::string_view rest;
    do {
      next_line();
      rest = line_;
    } while (line_.empty());
    if (lower_case(take_word(rest)) != "ply") fail_at_line("'ply'");
    line_end_ = input_.ended_in_return() ? MeshInput::LineEnd::kReturn : MeshInput::LineEnd::kNewline;
  }

  void next_line() {
    if (!input_.read_line(line_, line_end_)) input_.fail("truncated: expected 'end_header', found the end of the file");
    ++number_;
    bytes_ += line_.size() + 1;
    if (bytes_ > kLongestHeader) input_.fail("its header is longer than a megabyte");
    while (!line_.empty() && is_blank(line_.back())) line_.pop_back();
  }

  // Reads a statement. Returns false at the last one.
  bool read_statement() {
    std::string_view rest = line_;
    const std::string keyword = lower_case(take_word(rest));
    if (keyword == "end_header") return false;
    if (keyword == "format") {
      read_format(rest);
    } else if (keyword == "element") {
      read_element(rest);
    } else if (keyword == "property") {
      read_property(rest);
    } else if (keyword == "comment" || keyword == "obj_info") {
      header_.place.take_comment(rest);
    } else if (!keyword.empty()) {
      fail("expected element, property, comment or end_header, found '" + keyword.substr(0, 40) + "'");
    }
    return true;
  }

  void read_format(std::string_view rest) {
    const std::string_view encoding = take_word(rest);
    const std::string_view version = take_word(rest);
    if (encoding == "ascii") {
      header_.encoding = PlyEncoding::kAscii;
    } else if (encoding == "binary_little_endian") {
      header_.encoding = PlyEncoding::kLittleEndian;
    } else if (encoding == "binary_big_endian") {
      header_.encoding = PlyEncoding::kBigEndian;
    } else {
      fail_at_line("ascii, binary_little_endian or binary_big_endian");
    }
    if (version != "1.0") fail_at_line("version 1.0");
    has_format_ = true;
  }

  void read_element(std::string_view rest) {
    PlyElement element;
    element.name = lower_case(take_word(rest));
    const std::optional<std::uint64_t> count = parse_integer<std::uint64_t>(take_word(rest));
    if (element.name.empty() || !count || !take_word(rest).empty()) fail_at_line("'element NAME COUNT'");
    element.count = *count;
    for (const PlyElement& other : header_.elements) {
      if (other.name == element.name) fail("element '" + element.name + "' is given twice");
    }
    if (header_.elements.size() == kMostElements) fail("more than " + std::to_string(kMostElements) + " elements");
    header_.elements.push_back(std::move(element));
  }

  void read_property(std::string_view rest) {
    if (header_.elements.empty()) fail("a property stands before the first element");
    PlyProperty property;
    std::string_view type = take_word(rest);
    if (lower_case(type) == "list") {
      property.length_type = read_type(take_word(rest));
      if (property.length_type == PlyType::kFloat32 || property.length_type == PlyType::kFloat64) {
        fail_at_line("an integer type for the length of a list");
      }
      type = take_word(rest);
    }
    property.type = read_type(type);
    property.name = trimmed(rest);  // with blanks: programs give properties the names of their arrays
    if (property.name.empty()) fail_at_line("'property TYPE NAME'");
    PlyElement& element = header_.elements.back();
    if (find_property(element, property.name)) fail("property '" + property.name + "' is given twice");
    if (element.properties.size() == kMostProperties) {
      fail("more than " + std::to_string(kMostProperties) + " properties of one element");
    }
    element.properties.push_back(std::move(property));
  }

  PlyType read_type(std::string_view written) const {
    const std::string name = lower_case(written);
    for (const NamedType& known : kTypes) {
      if (known.name == name) return known.type;
    }
    fail("expected a type such as 'float' or 'uchar', found '" + name.substr(0, 40) + "'");
  }

  void check_elements() {
    bool has_vertices = false;
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        check_vertex(element);
        header_.values = choose_values(element);
        has_vertices = true;
      } else if (is_surface(element)) {
        check_surface(element);
      }
    }
    if (!has_vertices) input_.fail("its header has no element 'vertex'");
  }

  void check_vertex(const PlyElement& element) {
    if (element.count > kMostVertices) {
      input_.fail("has " + std::to_string(element.count) + " vertices, expected at most 4294967295");
    }
    for (const std::string_view name : {"x", "y", "z"}) {
      const PlyProperty* property = find_property(element, name);
      if (!property || property->length_type) input_.fail("its vertices have no number '" + std::string(name) + "'");
    }
    header_.has_normals = true;
    for (const std::string_view name : {"nx", "ny", "nz"}) {
      const PlyProperty* property = find_property(element, name);
      if (!property || property->length_type) header_.has_normals = false;
    }
    header_.vertices = element.count;
  }

  // Points alone may have faces without any property, but none of them.
  void check_surface(const PlyElement& element) const {
    const auto lists = std::count_if(element.properties.begin(), element.properties.end(), is_corner_list);
    if (lists == 1 || element.count == 0) return;
    input_.fail("expected one list 'vertex_indices' or 'vertex_index' in element '" + element.name + "'");
  }

  [[noreturn]] void fail(const std::string& what) const {
    input_.fail("header line " + std::to_string(number_) + ": " + what);
  }

  [[noreturn]] void fail_at_line(const std::string& expected) const {
    fail("expected " + expected + ", found " + in_quotes(line_));
  }

  MeshInput& input_;
  MeshInput::LineEnd line_end_ = MeshInput::LineEnd::kAny;
  std::string line_;
  std::size_t number_ = 0;
  std::size_t bytes_ = 0;
  bool has_format_ = false;
  PlyHeader header_;
};

}  // namespace

std::size_t bytes_of(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kInt64:
    case PlyType::kUint64:
    case PlyType::kFloat64:
      return 8;
  }
  return 0;
}

std::uint64_t least_bytes(const PlyElement& element, PlyEncoding encoding) {
  if (encoding == PlyEncoding::kAscii) return 2 * element.properties.size();
  std::uint64_t bytes = 0;
  for (const PlyProperty& property : element.properties)
    bytes += bytes_of(property.length_type.value_or(property.type));
  return bytes;
}

bool has_lists(const PlyElement& element) {
  return std::any_of(element.properties.begin(), element.properties.end(),
                     [](const PlyProperty& property) { return property.length_type.has_value(); });
}

bool is_surface(const PlyElement& element) { return element.name == "face" || element.name == "tristrips"; }

bool is_corner_list(const PlyProperty& property) {
  return property.length_type && (property.name == "vertex_indices" || property.name == "vertex_index");
}

PlyHeader read_ply_header(MeshInput& input) { return HeaderReader(input).read(); }

}  // namespace isoweave::mesh_io
