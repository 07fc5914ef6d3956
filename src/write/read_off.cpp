// OFF and NOFF in text: counts, vertices, polygons. What follows the corners of a face, its colour, is skipped.
#include "write/mesh_input.hpp"

namespace isoweave::mesh_io {
namespace {

class OffReader {
 public:
  explicit OffReader(MeshInput& input) : input_(input) {}

  TriangleMesh read() {
    read_header();
    mesh_.vertices.reserve(vertices_);
    mesh_.normals.reserve(has_normals_ ? vertices_ : 0);
    for (std::uint64_t n = 0; n < vertices_; ++n) read_vertex();
    for (std::uint64_t n = 0; n < faces_; ++n) read_face();
    if (next_line()) fail("expected the end of the file after " + std::to_string(faces_) + " faces, found more");
    check_mesh_numbers(input_, mesh_);
    return std::move(mesh_);
  }

 private:
  // Moves to the next line with something on it that is no comment; false at the end.
  bool next_line() {
    while (input_.read_line(line_)) {
      ++number_;
      rest_ = std::string_view(line_).substr(0, line_.find('#'));
      std::string_view look = rest_;
      if (!take_word(look).empty()) return true;
    }
    return false;
  }

  void expect_line(const char* what) {
    if (!next_line()) input_.fail(std::string("truncated: expected ") + what + ", found the end of the file");
  }

  void read_header() {
    expect_line("OFF");
    has_normals_ = take_word(rest_) == "NOFF";
    std::string_view look = rest_;
    const std::string_view word = take_word(look);
    if (word == "BINARY") fail("is binary, expected text");
    if (word.empty()) expect_line("the counts");
    vertices_ = next_count("vertices");
    faces_ = next_count("faces");
    check_size();
  }

  std::uint64_t next_count(const char* what) {
    const std::string_view word = take_word(rest_);
    const std::optional<std::uint64_t> count = parse_integer<std::uint64_t>(word);
    if (!count || *count > kMostVertices) {
      fail(std::string("expected the number of ") + what + ", found '" + std::string(word.substr(0, 40)) + "'");
    }
    return *count;
  }

  // A number takes two bytes, and the last line may lack its end.
  void check_size() const {
    const std::uint64_t least = vertices_ * (has_normals_ ? 12 : 6) + faces_ * 8;
    if (least <= input_.remaining() + 1) return;
    input_.fail("truncated: expected at least " + std::to_string(least) + " bytes of " + std::to_string(vertices_) +
                " vertices and " + std::to_string(faces_) + " faces, found " + std::to_string(input_.remaining()));
  }

  void read_vertex() {
    expect_line("a vertex");
    mesh_.vertices.push_back(next_point());
    if (has_normals_) mesh_.normals.push_back(next_point());
  }

  Point next_point() {
    Point point{};
    for (float& coordinate : point) {
      const std::optional<float> value = parse_real<float>(take_word(rest_));
      if (!value || !std::isfinite(*value)) fail("expected finite coordinates");
      coordinate = *value;
    }
    return point;
  }

  void read_face() {
    expect_line("a face");
    const std::uint64_t corners = next_count("corners");
    if (corners < 3) fail("expected a face of three corners or more, found " + std::to_string(corners));
    PolygonFan fan(mesh_.triangles);
    for (std::uint64_t n = 0; n < corners; ++n) {
      const std::string_view word = take_word(rest_);
      const std::optional<std::uint32_t> index = parse_integer<std::uint32_t>(word);
      if (!index) fail("expected the number of a vertex, found '" + std::string(word.substr(0, 40)) + "'");
      fan.add(*index);
    }
  }

  [[noreturn]] void fail(const std::string& what) const {
    input_.fail("line " + std::to_string(number_) + ": " + what);
  }

  MeshInput& input_;
  std::string line_;
  std::string_view rest_;
  std::uint64_t number_ = 0;
  std::uint64_t vertices_ = 0, faces_ = 0;
  bool has_normals_ = false;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_off(MeshInput& input) { return OffReader(input).read(); }

}  // namespace isoweave::mesh_io
