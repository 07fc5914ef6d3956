// Wavefront OBJ: v, vn and f are read, polygons are fanned; other statements are skipped, and told where they are part
// of the surface or of how it looks.
#include <array>
#include <utility>

#include "mesh/read/mesh_leftovers.hpp"
#include "mesh/read/mesh_words.hpp"
#include "mesh/read/polygons.hpp"

namespace isoweave::mesh_io {
namespace {

// The three ways to treat a statement that is not read.
enum class Fate { kIgnored, kNotKept, kLeftOut };

struct Statement {
  std::string_view keyword;
  Fate fate;
  std::string_view what;
};

constexpr std::string_view kFreeForm = "free-form curves and surfaces";

constexpr std::array<Statement, 41> kSkipped{{{"vt", Fate::kNotKept, "texture coordinates"},
                                              {"usemtl", Fate::kNotKept, "materials"},
                                              {"mtllib", Fate::kNotKept, "materials"},
                                              {"usemap", Fate::kNotKept, "materials"},
                                              {"maplib", Fate::kNotKept, "materials"},
                                              {"l", Fate::kLeftOut, "lines"},
                                              {"p", Fate::kLeftOut, "elements of points"},
                                              {"curv", Fate::kLeftOut, kFreeForm},
                                              {"curv2", Fate::kLeftOut, kFreeForm},
                                              {"surf", Fate::kLeftOut, kFreeForm},
                                              {"call", Fate::kLeftOut, "calls of other files"},
                                              {"g", Fate::kIgnored, ""},
                                              {"o", Fate::kIgnored, ""},
                                              {"s", Fate::kIgnored, ""},
                                              {"mg", Fate::kIgnored, ""},
                                              {"vp", Fate::kIgnored, ""},
                                              {"deg", Fate::kIgnored, ""},
                                              {"cstype", Fate::kIgnored, ""},
                                              {"bmat", Fate::kIgnored, ""},
                                              {"step", Fate::kIgnored, ""},
                                              {"parm", Fate::kIgnored, ""},
                                              {"trim", Fate::kIgnored, ""},
                                              {"hole", Fate::kIgnored, ""},
                                              {"scrv", Fate::kIgnored, ""},
                                              {"sp", Fate::kIgnored, ""},
                                              {"end", Fate::kIgnored, ""},
                                              {"con", Fate::kIgnored, ""},
                                              {"bevel", Fate::kIgnored, ""},
                                              {"c_interp", Fate::kIgnored, ""},
                                              {"d_interp", Fate::kIgnored, ""},
                                              {"lod", Fate::kIgnored, ""},
                                              {"shadow_obj", Fate::kIgnored, ""},
                                              {"trace_obj", Fate::kIgnored, ""},
                                              {"ctech", Fate::kIgnored, ""},
                                              {"stech", Fate::kIgnored, ""},
                                              {"csh", Fate::kIgnored, ""},
                                              {"bsp", Fate::kIgnored, ""},
                                              {"bzp", Fate::kIgnored, ""},
                                              {"cdc", Fate::kIgnored, ""},
                                              {"cdp", Fate::kIgnored, ""},
                                              {"res", Fate::kIgnored, ""}}};

class ObjReader {
 public:
  explicit ObjReader(MeshInput& input) : input_(input), words_(input, true) {}

  TriangleMesh read() {
    while (words_.next_line()) read_statement();
    if (points_.empty() && !unknown_.empty()) {
      input_.fail("expected OBJ statements such as 'v' and 'f', found '" + unknown_.substr(0, 40) + "'");
    }
    check_indices();
    words_.place().put_into(mesh_);
    set_vertices(mesh_, points_, words_.place().offset());
    polygons_.finish();
    keep_normals();
    leftovers_.note(mesh_);
    return std::move(mesh_);
  }

 private:
  void read_statement() {
    const std::string keyword = lower_case(words_.next_on_line());
    if (keyword == "v") {
      read_vertex();
    } else if (keyword == "vn") {
      normals_.push_back(read_normal());
      count_numbers();
    } else if (keyword == "f" || keyword == "fo") {
      read_face();
    } else {
      skip(keyword);
    }
  }

  // Programs add statements of their own; a word that is no identifier shows that this is no OBJ file.
  void skip(const std::string& keyword) {
    for (const Statement& known : kSkipped) {
      if (known.keyword != keyword) continue;
      if (known.fate == Fate::kNotKept) leftovers_.not_kept(known.what);
      if (known.fate == Fate::kLeftOut) leftovers_.left_out(1, known.what);
      return;
    }
    for (const char c : keyword) {
      const bool fits = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
      if (!fits) words_.fail("expected an OBJ statement such as 'v' or 'f'", keyword);
    }
    if (unknown_.empty()) unknown_ = keyword;
  }

  WidePoint read_point() {
    WidePoint point{};
    for (double& coordinate : point) coordinate = words_.coordinate(words_.next_on_line());
    return point;
  }

  Point read_normal() {
    Point normal{};
    for (float& component : normal) component = words_.component(words_.next_on_line());
    return normal;
  }

  // Reads a vertex. Of the numbers behind its coordinates, one is a weight, which counts for free-form surfaces, and
  // three are a colour.
  void read_vertex() {
    if (points_.size() == kMostVertices) words_.fail("more than 4294967295 vertices");
    points_.push_back(read_point());
    const std::size_t more = count_numbers();
    if (more >= 3) leftovers_.not_kept("colours of vertices");
  }

  std::size_t count_numbers() {
    std::size_t count = 0;
    for (std::string_view word = words_.next_on_line(); !word.empty(); word = words_.next_on_line()) {
      if (!parse_real<double>(word)) words_.fail("expected a number", word);
      ++count;
    }
    return count;
  }

  void read_face() {
    PolygonFan fan(mesh_.triangles);
    for (std::string_view word = words_.next_on_line(); !word.empty(); word = words_.next_on_line()) {
      fan.add(read_corner(word));
    }
    polygons_.end(fan.corners());
    if (fan.corners() < 3) leftovers_.left_out(1, kFewCorners);
  }

  // a, a/b, a//c or a/b/c: vertex, texture coordinate, normal.
  std::uint32_t read_corner(std::string_view word) {
    const std::string_view vertex = take_field(word);
    const std::string_view texture = take_field(word);
    const std::string_view normal = take_field(word);
    if (!word.empty()) words_.fail("expected a corner of at most three numbers");
    const std::uint32_t index = read_index(vertex, points_.size());
    if (!texture.empty() && !parse_integer<std::int64_t>(texture)) {
      words_.fail("expected a number between slashes", texture);
    }
    if (normal.empty() || read_index(normal, normals_.size()) != index) normals_follow_vertices_ = false;
    return index;
  }

  static std::string_view take_field(std::string_view& word) {
    const std::string_view field = word.substr(0, word.find('/'));
    word.remove_prefix(std::min(word.size(), field.size() + 1));
    return field;
  }

  // Reads an index, which counts from 1, or backwards from the last element read. Forward references are legal, so the
  // upper end is checked when the file has been read.
  std::uint32_t read_index(std::string_view text, std::size_t count) {
    const std::optional<std::int64_t> value = parse_integer<std::int64_t>(text);
    const std::int64_t index = !value ? -1 : *value > 0 ? *value - 1 : static_cast<std::int64_t>(count) + *value;
    const bool fits = value && *value != 0 && index >= 0 && index < static_cast<std::int64_t>(kMostVertices);
    if (!fits) words_.fail("expected the number of a vertex or normal", text);
    return static_cast<std::uint32_t>(index);
  }

  void check_indices() const {
    for (const auto& triangle : mesh_.triangles) {
      for (const std::uint32_t index : triangle) {
        if (index >= points_.size()) {
          input_.fail("a face refers to vertex " + std::to_string(std::uint64_t{index} + 1) + ", the file has " +
                      std::to_string(points_.size()));
        }
      }
    }
  }

  // Keeps the normals if each vertex has one. A TriangleMesh has no place for normals numbered otherwise.
  void keep_normals() {
    if (normals_.empty()) return;
    if (normals_follow_vertices_ && normals_.size() == mesh_.vertices.size()) {
      mesh_.normals = std::move(normals_);
    } else {
      leftovers_.not_kept("normals that are not numbered as the vertices are");
    }
  }

  MeshInput& input_;
  MeshWords words_;
  std::string unknown_;  // the first statement that is not one of OBJ
  TriangleMesh mesh_;
  Polygons polygons_{mesh_};
  MeshLeftovers leftovers_;
  std::vector<WidePoint> points_;
  std::vector<Point> normals_;
  bool normals_follow_vertices_ = true;
};

}  // namespace

TriangleMesh read_obj(MeshInput& input) { return ObjReader(input).read(); }

}  // namespace isoweave::mesh_io
