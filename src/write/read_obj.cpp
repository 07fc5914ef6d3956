// Wavefront OBJ: v, vn and f are read, polygons are fanned, all other statements are skipped.
#include "write/mesh_input.hpp"

namespace isoweave::mesh_io {
namespace {

class ObjReader {
 public:
  explicit ObjReader(MeshInput& input) : input_(input) {}

  TriangleMesh read() {
    while (next_statement()) read_statement();
    check_indices();
    // One normal per vertex is what a TriangleMesh holds; normals numbered otherwise have no place in it.
    if (normals_follow_vertices_ && normals_.size() == mesh_.vertices.size()) mesh_.normals = std::move(normals_);
    return std::move(mesh_);
  }

 private:
  // Joins lines that end in a backslash.
  bool next_statement() {
    if (!input_.read_line(line_)) return false;
    ++number_;
    std::string more;
    while (!line_.empty() && line_.back() == '\\') {
      line_.back() = ' ';
      if (!input_.read_line(more)) fail("truncated: expected a line after '\\', found the end of the file");
      ++number_;
      if (line_.size() + more.size() > kLongestLine) fail("a statement is longer than a megabyte");
      line_ += more;
    }
    return true;
  }

  void read_statement() {
    std::string_view rest = line_;
    const std::string_view keyword = take_word(rest);
    if (keyword.empty() || keyword.front() == '#') return;
    if (keyword == "v") {
      if (mesh_.vertices.size() == kMostVertices) fail("more than 4294967295 vertices");
      mesh_.vertices.push_back(read_point(rest));
    } else if (keyword == "vn") {
      normals_.push_back(read_point(rest));
    } else if (keyword == "f") {
      read_face(rest);
    } else {
      check_skipped(keyword);
    }
  }

  // Programs add statements of their own; a word that is no identifier shows that this is no OBJ file.
  void check_skipped(std::string_view keyword) const {
    for (const char c : keyword) {
      const bool fits = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
      if (!fits) fail("expected an OBJ statement such as 'v' or 'f'");
    }
  }

  // The first three numbers; w and colours may follow.
  Point read_point(std::string_view rest) const {
    Point point{};
    for (float& coordinate : point) {
      const std::optional<float> value = parse_real<float>(take_word(rest));
      if (!value || !std::isfinite(*value)) fail("expected three finite numbers");
      coordinate = *value;
    }
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
      if (!parse_real<double>(word)) fail("expected a number, found '" + std::string(word.substr(0, 40)) + "'");
    }
    return point;
  }

  void read_face(std::string_view rest) {
    PolygonFan fan(mesh_.triangles);
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) fan.add(read_corner(word));
    if (fan.corners() < 3) fail("expected a face of three corners or more, found " + std::to_string(fan.corners()));
  }

  // a, a/b, a//c or a/b/c: vertex, texture coordinate, normal.
  std::uint32_t read_corner(std::string_view word) {
    const std::string_view vertex = take_field(word);
    const std::string_view texture = take_field(word);
    const std::string_view normal = take_field(word);
    if (!word.empty()) fail("expected a corner of at most three numbers");
    const std::uint32_t index = read_index(vertex, mesh_.vertices.size());
    if (!texture.empty() && !parse_integer<std::int64_t>(texture)) fail("expected a number between slashes");
    if (normal.empty() || read_index(normal, normals_.size()) != index) normals_follow_vertices_ = false;
    return index;
  }

  static std::string_view take_field(std::string_view& word) {
    const std::string_view field = word.substr(0, word.find('/'));
    word.remove_prefix(std::min(word.size(), field.size() + 1));
    return field;
  }

  // Counts from 1, or backwards from the last one read. Forward references are legal, so the upper end is checked
  // when the file has been read.
  std::uint32_t read_index(std::string_view text, std::size_t count) {
    const std::optional<std::int64_t> value = parse_integer<std::int64_t>(text);
    const std::int64_t index = !value ? -1 : *value > 0 ? *value - 1 : static_cast<std::int64_t>(count) + *value;
    const bool fits = value && *value != 0 && index >= 0 && index < static_cast<std::int64_t>(kMostVertices);
    if (!fits) fail("expected the number of a vertex or normal, found '" + std::string(text.substr(0, 40)) + "'");
    return static_cast<std::uint32_t>(index);
  }

  void check_indices() const {
    for (const auto& triangle : mesh_.triangles) {
      for (const std::uint32_t index : triangle) {
        if (index >= mesh_.vertices.size()) {
          input_.fail("a face refers to vertex " + std::to_string(std::uint64_t{index} + 1) + ", the file has " +
                      std::to_string(mesh_.vertices.size()));
        }
      }
    }
  }

  [[noreturn]] void fail(const std::string& what) const {
    input_.fail("line " + std::to_string(number_) + ": " + what);
  }

  MeshInput& input_;
  std::string line_;
  std::uint64_t number_ = 0;
  TriangleMesh mesh_;
  std::vector<Point> normals_;
  bool normals_follow_vertices_ = true;
};

}  // namespace

TriangleMesh read_obj(MeshInput& input) { return ObjReader(input).read(); }

}  // namespace isoweave::mesh_io
