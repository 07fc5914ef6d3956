// 3MF with one object that is a mesh. Coordinates are taken as they are, without the unit and the place on the bed.
#include "volume/xml_tag.hpp"
#include "write/mesh_input.hpp"
#include "write/zip_input.hpp"

namespace isoweave::mesh_io {
namespace {

constexpr std::size_t kLongestTag = 4096;

class ModelReader {
 public:
  explicit ModelReader(MeshInput& input) : input_(input), text_(input, ".model") {}

  TriangleMesh read() {
    while (next_tag()) take_tag();
    if (!complete_) input_.fail("expected a mesh and the end of a model, found none");
    check_mesh_numbers(input_, mesh_);
    return std::move(mesh_);
  }

 private:
  // What stands between the next '<' and '>'; false at the end.
  bool next_tag() {
    int c = text_.get();
    while (c >= 0 && c != '<') c = text_.get();
    tag_.clear();
    for (c = text_.get(); c >= 0 && c != '>'; c = text_.get()) {
      if (tag_.size() == kLongestTag) input_.fail("a tag of the model is longer than 4096 bytes");
      tag_.push_back(static_cast<char>(c));
    }
    return c == '>';
  }

  void take_tag() {
    const std::string_view name = std::string_view(tag_).substr(0, tag_.find_first_of(" \t\r\n/", 1));
    if (name == "vertex") take_vertex();
    if (name == "triangle") take_triangle();
    if (name == "component") input_.fail("expected one object that is a mesh, found one of components");
    if (name == "mesh" && has_mesh_) input_.fail("expected one mesh, found more");
    if (name == "mesh") has_mesh_ = true;
    if (name == "/model") complete_ = has_mesh_;
  }

  void take_vertex() {
    if (mesh_.vertices.size() == kMostVertices) input_.fail("has more than 4294967295 vertices");
    Point point{};
    constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string text = xml_attribute(tag_, kNames[axis]);
      const std::optional<float> value = parse_real<float>(text);
      if (!value) input_.fail("expected a number in a vertex, found '" + text.substr(0, 40) + "'");
      point[axis] = *value;
    }
    mesh_.vertices.push_back(point);
  }

  void take_triangle() {
    std::array<std::uint32_t, 3> triangle{};
    constexpr std::array<const char*, 3> kNames{"v1", "v2", "v3"};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::string text = xml_attribute(tag_, kNames[corner]);
      const std::optional<std::uint32_t> value = parse_integer<std::uint32_t>(text);
      if (!value) input_.fail("expected an index in a triangle, found '" + text.substr(0, 40) + "'");
      triangle[corner] = *value;
    }
    mesh_.triangles.push_back(triangle);
  }

  MeshInput& input_;
  ZipText text_;
  std::string tag_;
  bool has_mesh_ = false, complete_ = false;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_3mf(MeshInput& input) { return ModelReader(input).read(); }

}  // namespace isoweave::mesh_io
