// PLY: any order and type of properties, lists, strips, further elements; ascii, little- and big-endian.
#include <array>
#include <bit>

#include "files/quoted.hpp"
#include "mesh/read/mesh_leftovers.hpp"
#include "mesh/read/mesh_words.hpp"
#include "mesh/read/ply_header.hpp"
#include "mesh/read/polygons.hpp"
#include "parallel/size.hpp"

namespace isoweave::mesh_io {
namespace {

// Loads the bytes of one number, most significant first or last.
std::uint64_t load_bits(std::span<const std::byte> bytes, bool big_endian) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::size_t at = big_endian ? i : bytes.size() - 1 - i;
    bits = bits << 8 | std::to_integer<std::uint64_t>(bytes[at]);
  }
  return bits;
}

// Every PLY type fits in a double exactly, but for integers beyond 2^53, which are no index.
double number_from_bits(std::uint64_t bits, PlyType type) {
  switch (type) {
    case PlyType::kInt8:
      return static_cast<std::int8_t>(bits);
    case PlyType::kInt16:
      return static_cast<std::int16_t>(bits);
    case PlyType::kInt32:
      return static_cast<std::int32_t>(bits);
    case PlyType::kInt64:
      return static_cast<double>(static_cast<std::int64_t>(bits));
    case PlyType::kUint8:
    case PlyType::kUint16:
    case PlyType::kUint32:
    case PlyType::kUint64:
      return static_cast<double>(bits);
    case PlyType::kFloat32:
      return double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))};
    case PlyType::kFloat64:
      return std::bit_cast<double>(bits);
  }
  return 0;
}

// The fewest digits that say the number: 3, not 3.000000.
std::string text_of(double value) {
  std::array<char, 32> digits{};
  const std::to_chars_result result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return {digits.data(), result.ptr};
}

class PlyReader {
 public:
  explicit PlyReader(MeshInput& input) : input_(input), header_(read_ply_header(input)) {}

  TriangleMesh read() {
    check_size();
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else if (element.name == "tristrips") {
        read_strips(element);
      } else {
        skip_element(element);
      }
    }
    check_end();
    header_.place.put_into(mesh_);
    if (is_wide_) set_vertices(mesh_, points_, header_.place.offset());
    polygons_.finish();
    note_leftovers();
    return std::move(mesh_);
  }

 private:
  // Nothing is allocated before the file is known to be long enough for all that its header claims.
  void check_size() const {
    std::uint64_t least = 0;
    for (const PlyElement& element : header_.elements) {
      std::uint64_t bytes = 0;
      const bool too_large = __builtin_mul_overflow(element.count, least_bytes(element, header_.encoding), &bytes) ||
                             __builtin_add_overflow(least, bytes, &least);
      // The last number of an ascii file may lack the blank behind it.
      if (too_large || least > input_.remaining() + 1) {
        input_.fail("truncated: its header promises " + std::to_string(element.count) + " of '" + element.name +
                    "', expected at least " + (too_large ? "2^64" : std::to_string(least)) +
                    " bytes after the header, found " + std::to_string(input_.remaining()));
      }
    }
  }

  double next(PlyType type) {
    if (header_.encoding == PlyEncoding::kAscii) return next_in_text(type);
    std::array<std::byte, 8> bytes{};
    const std::span<std::byte> used = std::span(bytes).first(bytes_of(type));
    input_.read(used);
    return number_from_bits(load_bits(used, header_.encoding == PlyEncoding::kBigEndian), type);
  }

  // Reads a number in text. A float may have more digits than it holds; for a place far from the origin these digits
  // matter.
  double next_in_text(PlyType type) {
    const std::string_view token = input_.read_token();
    if (token.empty()) input_.fail("truncated: expected a number, found the end of the file");
    const std::optional<double> value =
        type == PlyType::kFloat32 ? parse_wide_number(token) : parse_number<double>(token);
    if (!value) {
      input_.fail(expected_number(token) + (", found '" + std::string(token.substr(0, 40)) + "'"));
    }
    return *value;
  }

  std::uint64_t next_list_length(const PlyProperty& property) {
    const double length = next(*property.length_type);
    if (!(length >= 0 && length <= 4294967295.0) || length != std::floor(length)) {
      input_.fail("expected the length of list '" + property.name + "', found " + text_of(length));
    }
    return static_cast<std::uint64_t>(length);
  }

  void skip_value(const PlyProperty& property) {
    if (!property.length_type) {
      next(property.type);
      return;
    }
    const std::uint64_t length = next_list_length(property);
    if (header_.encoding != PlyEncoding::kAscii) {
      input_.skip(length * bytes_of(property.type));
    } else {
      for (std::uint64_t i = 0; i < length; ++i) next(property.type);
    }
  }

  void skip_element(const PlyElement& element) {
    // A hostile count of nothing at all would keep the loop busy for ever.
    if (element.properties.empty()) return;
    if (header_.encoding != PlyEncoding::kAscii && !has_lists(element)) {
      input_.skip(element.count * least_bytes(element, header_.encoding));
      return;
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) skip_value(property);
    }
  }

  void read_vertices(const PlyElement& element) {
    const std::vector<int> slots = coordinate_slots(element);
    is_wide_ = has_wide_coordinates(element);
    is_wide_ ? points_.reserve(to_size(element.count)) : mesh_.vertices.reserve(to_size(element.count));
    if (header_.has_normals) mesh_.normals.reserve(to_size(element.count));
    for (std::uint64_t vertex = read_plain_vertices(element); vertex < element.count; ++vertex) {
      std::array<double, 6> values{};
      for (std::size_t i = 0; i < slots.size(); ++i) {
        if (slots[i] == kValueSlot) {
          mesh_.values.push_back(next_value(element.properties[i]));
        } else if (slots[i] < 0) {
          skip_value(element.properties[i]);
        } else {
          const PlyProperty& property = element.properties[i];
          values[static_cast<std::size_t>(slots[i])] =
              slots[i] < kNormalSlot ? next_coordinate(property, vertex) : next_value(property);
        }
      }
      add_vertex({values[0], values[1], values[2]});
      if (header_.has_normals) mesh_.normals.push_back(relative_point({values[3], values[4], values[5]}, {0, 0, 0}));
    }
  }

  void add_vertex(const WidePoint& point) {
    if (is_wide_) return points_.push_back(point);
    mesh_.vertices.push_back(relative_point(point, {0, 0, 0}));
  }

  // Whether a coordinate may have more digits than a float32.
  bool has_wide_coordinates(const PlyElement& element) const {
    if (header_.encoding == PlyEncoding::kAscii) return true;
    return std::any_of(element.properties.begin(), element.properties.end(), [](const PlyProperty& property) {
      const bool is_coordinate = property.name == "x" || property.name == "y" || property.name == "z";
      return is_coordinate && bytes_of(property.type) >= 4 && property.type != PlyType::kFloat32;
    });
  }

  // Reads the vertices before the first one that is not finite, where a vertex is x y z in little-endian float32 and no
  // more. Almost every file is of this kind, and this way is ten times as fast. Returns the number of vertices read.
  std::uint64_t read_plain_vertices(const PlyElement& element) {
    constexpr std::array<std::string_view, 3> kNames{"x", "y", "z"};
    const auto is_plain = [](const PlyProperty& property, std::string_view name) {
      return property.name == name && property.type == PlyType::kFloat32 && !property.length_type;
    };
    if (!kIsLittleEndian || header_.encoding != PlyEncoding::kLittleEndian ||
        !std::equal(element.properties.begin(), element.properties.end(), kNames.begin(), kNames.end(), is_plain)) {
      return 0;
    }
    return input_.read_records(element.count, sizeof(Point), [&](const std::byte* record) {
      Point point;
      std::memcpy(&point, record, sizeof(Point));
      if (!std::isfinite(point[0]) || !std::isfinite(point[1]) || !std::isfinite(point[2])) return false;
      mesh_.vertices.push_back(point);
      return true;
    });
  }

  // The slot of each property among x y z nx ny nz and the value; -1 for all others.
  std::vector<int> coordinate_slots(const PlyElement& element) const {
    constexpr std::array<std::string_view, 6> kNames{"x", "y", "z", "nx", "ny", "nz"};
    std::vector<int> slots;
    for (const PlyProperty& property : element.properties) {
      const auto found = std::find(kNames.begin(), kNames.begin() + (header_.has_normals ? 6 : 3), property.name);
      const bool used = found != kNames.begin() + (header_.has_normals ? 6 : 3);
      const bool is_value = property.name == header_.values;
      slots.push_back(used ? static_cast<int>(found - kNames.begin()) : is_value ? kValueSlot : -1);
    }
    return slots;
  }

  double next_coordinate(const PlyProperty& property, std::uint64_t vertex) {
    const double value = next(property.type);
    if (!(std::abs(value) <= double{std::numeric_limits<float>::max()})) {
      input_.fail("vertex " + std::to_string(vertex) + " has '" + property.name + "' = " + text_of(value) +
                  ", expected a finite float32");
    }
    return value;
  }

  float next_value(const PlyProperty& property) {
    const double value = next(property.type);
    const bool fits = std::abs(value) <= double{std::numeric_limits<float>::max()};
    return fits ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN();
  }

  void read_faces(const PlyElement& element) {
    mesh_.triangles.reserve(to_size(element.count));
    for (std::uint64_t face = 0; face < element.count; ++face) {
      face += read_plain_triangles(element, element.count - face);
      if (face == element.count) break;
      for (const PlyProperty& property : element.properties) {
        if (is_corner_list(property)) {
          read_corners(property, face);
        } else {
          skip_value(property);
        }
      }
    }
  }

  // Reads the faces before the first one that is no triangle, or that refers to a vertex that does not exist.
  std::uint64_t read_plain_triangles(const PlyElement& element, std::uint64_t most) {
    const PlyProperty& corners = element.properties.front();
    const bool is_plain = element.properties.size() == 1 && is_corner_list(corners) &&
                          corners.length_type == PlyType::kUint8 &&
                          (corners.type == PlyType::kInt32 || corners.type == PlyType::kUint32);
    // Beyond 2^31 vertices a negative number would look like one of them.
    if (!kIsLittleEndian || header_.encoding != PlyEncoding::kLittleEndian || !is_plain ||
        header_.vertices > std::uint64_t{1} << 31) {
      return 0;
    }
    std::array<std::uint32_t, 3> triangle{};
    return input_.read_records(most, 1 + sizeof triangle, [&](const std::byte* record) {
      std::memcpy(&triangle, record + 1, sizeof triangle);
      const bool fits = std::max({triangle[0], triangle[1], triangle[2]}) < header_.vertices;
      if (*record != std::byte{3} || !fits) return false;
      mesh_.triangles.push_back(triangle);
      return true;
    });
  }

  void read_corners(const PlyProperty& property, std::uint64_t face) {
    const std::uint64_t length = next_list_length(property);
    PolygonFan fan(mesh_.triangles);
    for (std::uint64_t i = 0; i < length; ++i) fan.add(checked_corner(next(property.type), "face ", face));
    polygons_.end(length);
    if (length < 3) leftovers_.left_out(1, kFewCorners);
  }

  std::uint32_t checked_corner(double index, const char* what, std::uint64_t record) const {
    if (!(index >= 0 && index < static_cast<double>(header_.vertices)) || index != std::floor(index)) {
      input_.fail(what + std::to_string(record) + " refers to vertex " + text_of(index) + ", the file has " +
                  std::to_string(header_.vertices));
    }
    return static_cast<std::uint32_t>(index);
  }

  void read_strips(const PlyElement& element) {
    for (std::uint64_t strip = 0; strip < element.count; ++strip) {
      for (const PlyProperty& property : element.properties) {
        is_corner_list(property) ? read_strip(property, strip) : skip_value(property);
      }
    }
  }

  // Reads a strip. Every second triangle is turned over. A corner of -1 begins another strip. Triangles that repeat a
  // corner only lead from one part of a strip to the next.
  void read_strip(const PlyProperty& property, std::uint64_t strip) {
    const std::uint64_t length = next_list_length(property);
    std::array<std::uint32_t, 3> last{};
    std::uint64_t corners = 0;
    for (std::uint64_t i = 0; i < length; ++i) {
      const double index = next(property.type);
      if (index == -1) {
        corners = 0;
        continue;
      }
      last = {last[1], last[2], checked_corner(index, "strip ", strip)};
      if (++corners < 3 || last[0] == last[1] || last[1] == last[2] || last[2] == last[0]) continue;
      const bool turned = corners % 2 == 0;
      mesh_.triangles.push_back({last[turned ? 1 : 0], last[turned ? 0 : 1], last[2]});
    }
  }

  void note_leftovers() {
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        note_vertices(element);
      } else if (!is_surface(element)) {
        leftovers_.left_out(element.count, "of '" + element.name + "'");
      } else if (element.count > 0) {
        for (const PlyProperty& property : element.properties) {
          if (!is_corner_list(property)) leftovers_.not_kept(property.name + " of faces");
        }
      }
    }
    leftovers_.note(mesh_);
    if (header_.values.empty() || header_.values == "quality") return;
    mesh_.notes.push_back("the values at its vertices are the property " + in_quotes(header_.values));
  }

  void note_vertices(const PlyElement& element) {
    const std::vector<int> slots = coordinate_slots(element);
    for (std::size_t i = 0; i < slots.size(); ++i) {
      if (slots[i] < 0) leftovers_.not_kept(element.properties[i].name);
    }
  }

  // Refuses more data than the header declares: one of the two is wrong.
  void check_end() {
    for (int c = input_.get(); c >= 0; c = input_.get()) {
      if (!is_blank(c) && c != kEndOfText) {
        input_.fail("expected the end of the file, found " + std::to_string(input_.remaining() + 1) + " more bytes");
      }
    }
  }

  static constexpr int kNormalSlot = 3;  // the first of three
  static constexpr int kValueSlot = 6;
  static constexpr bool kIsLittleEndian = std::endian::native == std::endian::little;

  MeshInput& input_;
  PlyHeader header_;
  TriangleMesh mesh_;
  Polygons polygons_{mesh_};
  MeshLeftovers leftovers_;
  bool is_wide_ = false;
  std::vector<WidePoint> points_;  // the vertices, where they are wide
};

}  // namespace

TriangleMesh read_ply(MeshInput& input) { return PlyReader(input).read(); }

}  // namespace isoweave::mesh_io
