// VTP: one piece of polygons whose arrays are appended raw and not compressed.
#include <algorithm>
#include <bit>

#include "volume/xml_tag.hpp"
#include "write/mesh_input.hpp"

namespace isoweave::mesh_io {
namespace {

constexpr std::size_t kLongestHead = std::size_t{1} << 20;

struct VtpArray {
  std::string type;
  std::uint64_t offset = 0;
};

// An unsigned number of up to 8 bytes.
std::uint64_t load(std::span<const std::byte> bytes, bool big_endian) {
  std::uint64_t value = 0;
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    value = value << 8 | std::to_integer<std::uint64_t>(bytes[big_endian ? n : bytes.size() - 1 - n]);
  }
  return value;
}

class VtpReader {
 public:
  explicit VtpReader(MeshInput& input) : input_(input), head_(input.head(kLongestHead)) {}

  TriangleMesh read() {
    check_end();
    read_head();
    mesh_.vertices = read_points(points_);
    if (normals_) mesh_.normals = read_points(*normals_);
    read_polygons();
    check_mesh_numbers(input_, mesh_);
    return std::move(mesh_);
  }

 private:
  void check_end() {
    constexpr std::uint64_t kTail = 64;
    input_.move_to(input_.size() - std::min(input_.size(), kTail));
    std::string tail(static_cast<std::size_t>(input_.remaining()), '\0');
    input_.read(std::as_writable_bytes(std::span(tail)));
    if (tail.find("</VTKFile>") == std::string::npos) input_.fail("truncated: expected '</VTKFile>' at the end");
  }

  void read_head() {
    const std::size_t appended = head_.find("<AppendedData");
    const std::size_t end = appended == std::string::npos ? appended : head_.find('>', appended);
    const std::size_t mark = end == std::string::npos ? end : head_.find('_', end);
    if (mark == std::string::npos) input_.fail("expected appended data, found none in the first megabyte");
    data_ = mark + 1;
    if (xml_attribute(head_.substr(appended, end - appended), "encoding") != "raw") {
      input_.fail("expected appended data in encoding 'raw', found another");
    }
    std::string_view rest = std::string_view(head_).substr(0, appended);
    std::string section;
    for (;;) {
      const std::size_t open = rest.find('<');
      const std::size_t close = open == std::string_view::npos ? open : rest.find('>', open);
      if (close == std::string_view::npos) break;
      take_tag(rest.substr(open + 1, close - open - 1), section);
      rest.remove_prefix(close + 1);
    }
    if (points_.type.empty() || connectivity_.type.empty() || offsets_.type.empty()) {
      input_.fail("expected a piece of PolyData with Points and Polys, found none");
    }
  }

  void take_tag(std::string_view tag, std::string& section) {
    const std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/"));
    if (name == "VTKFile") take_file(tag);
    if (name == "Piece") take_piece(tag);
    if (name == "PointData") wanted_normals_ = xml_attribute(tag, "Normals");
    if (name == "PointData" || name == "CellData" || name == "Points" || name == "Polys" || name == "FieldData") {
      section = name;
    }
    if (name == "DataArray") take_array(tag, section);
  }

  void take_file(std::string_view tag) {
    const std::string type = xml_attribute(tag, "type");
    if (type != "PolyData") input_.fail("expected PolyData, found '" + type + "'");
    if (!xml_attribute(tag, "compressor").empty()) input_.fail("expected arrays without compression, found some with");
    big_endian_ = xml_attribute(tag, "byte_order") == "BigEndian";
    word_ = xml_attribute(tag, "header_type") == "UInt64" ? 8 : 4;
  }

  void take_piece(std::string_view tag) {
    if (has_piece_) input_.fail("expected one piece, found more");
    has_piece_ = true;
    for (const char* other : {"NumberOfVerts", "NumberOfLines", "NumberOfStrips"}) {
      const std::string count = xml_attribute(tag, other);
      if (!count.empty() && count != "0") input_.fail(std::string("expected polygons only, found ") + other);
    }
    vertices_ = count_of(tag, "NumberOfPoints");
    polygons_ = count_of(tag, "NumberOfPolys");
  }

  std::uint64_t count_of(std::string_view tag, const char* name) const {
    const std::string text = xml_attribute(tag, name);
    const std::optional<std::uint64_t> count = parse_integer<std::uint64_t>(text);
    if (!count || *count > std::uint64_t{1} << 58) {
      input_.fail(std::string("expected a number as ") + name + ", found '" + text.substr(0, 40) + "'");
    }
    return *count;
  }

  void take_array(std::string_view tag, const std::string& section) {
    const std::string name = xml_attribute(tag, "Name");
    VtpArray* array = nullptr;
    if (section == "Points") array = &points_;
    if (section == "Polys" && name == "connectivity") array = &connectivity_;
    if (section == "Polys" && name == "offsets") array = &offsets_;
    if (section == "PointData" && !wanted_normals_.empty() && name == wanted_normals_) array = &normals_.emplace();
    if (array == nullptr) return;
    if (xml_attribute(tag, "format") != "appended") input_.fail("expected appended arrays, found others");
    array->type = xml_attribute(tag, "type");
    array->offset = count_of(tag, "offset");
  }

  // Moves to the numbers of an array, after its length was compared with what it must be.
  void open(const VtpArray& array, std::uint64_t bytes) {
    if (array.offset > input_.size() - data_) input_.fail("truncated: an array lies behind the end of the file");
    input_.move_to(data_ + array.offset);
    const std::uint64_t said = next(word_);
    if (said != bytes || bytes > input_.remaining()) {
      input_.fail("expected " + std::to_string(bytes) + " bytes in an array, found " + std::to_string(said) +
                  " said, " + std::to_string(input_.remaining()) + " there");
    }
  }

  std::uint64_t next(std::size_t bytes) {
    std::array<std::byte, 8> buffer{};
    const std::span<std::byte> used = std::span(buffer).first(bytes);
    input_.read(used);
    return load(used, big_endian_);
  }

  std::vector<Point> read_points(const VtpArray& array) {
    const bool wide = array.type == "Float64";
    if (!wide && array.type != "Float32")
      input_.fail("expected points of Float32 or Float64, found '" + array.type + "'");
    if (vertices_ > kMostVertices) input_.fail("has more than 4294967295 vertices");
    open(array, vertices_ * (wide ? 24 : 12));
    std::vector<Point> points(static_cast<std::size_t>(vertices_));
    for (Point& point : points) {
      for (float& coordinate : point) {
        coordinate = wide ? static_cast<float>(std::bit_cast<double>(next(8)))
                          : std::bit_cast<float>(static_cast<std::uint32_t>(next(4)));
      }
    }
    return points;
  }

  std::size_t index_bytes(const VtpArray& array) const {
    if (array.type == "Int64" || array.type == "UInt64") return 8;
    if (array.type != "Int32" && array.type != "UInt32") {
      input_.fail("expected indices of 32 or 64 bits, found '" + array.type + "'");
    }
    return 4;
  }

  // Where each polygon ends among the corners, then the corners.
  void read_polygons() {
    const std::size_t each = index_bytes(offsets_);
    open(offsets_, polygons_ * each);
    std::vector<std::uint64_t> ends(static_cast<std::size_t>(polygons_));
    std::uint64_t last = 0;
    for (std::uint64_t& end : ends) {
      end = next(each);
      if (end < last + 3 || end > input_.size())
        input_.fail("expected polygons of three corners or more, found others");
      last = end;
    }
    const std::size_t corner = index_bytes(connectivity_);
    open(connectivity_, last * corner);
    std::uint64_t at = 0;
    for (const std::uint64_t end : ends) {
      PolygonFan fan(mesh_.triangles);
      for (; at < end; ++at) fan.add(next_index(corner));
    }
  }

  std::uint32_t next_index(std::size_t bytes) {
    const std::uint64_t index = next(bytes);
    if (index >= vertices_) {
      input_.fail("a polygon refers to point " + std::to_string(index) + ", the file has " + std::to_string(vertices_));
    }
    return static_cast<std::uint32_t>(index);
  }

  MeshInput& input_;
  std::string head_;
  std::uint64_t data_ = 0;  // where offsets count from
  bool big_endian_ = false, has_piece_ = false;
  std::size_t word_ = 4;
  std::uint64_t vertices_ = 0, polygons_ = 0;
  std::string wanted_normals_;
  VtpArray points_, connectivity_, offsets_;
  std::optional<VtpArray> normals_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_vtp(MeshInput& input) { return VtpReader(input).read(); }

}  // namespace isoweave::mesh_io
