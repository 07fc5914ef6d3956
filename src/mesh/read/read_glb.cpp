// GLB and glTF. The mesh of isoweave's own files is taken as stored, since their extras tell what the nodes do to it.
// Of other files, all meshes of the scene are taken where its nodes place them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "mesh/read/gltf_file.hpp"
#include "mesh/read/mesh_input.hpp"
#include "mesh/read/mesh_leftovers.hpp"
#include "mesh/read/placement.hpp"
#include "mesh/write/glb_scene.hpp"
#include "parallel/size.hpp"

namespace isoweave::mesh_io {
namespace {

constexpr const char* kCopies = "EXT_mesh_gpu_instancing";

enum Mode : std::uint64_t { kPoints, kLines, kLineLoop, kLineStrip, kTriangles, kTriangleStrip, kTriangleFan };

// Whether an extension leaves the shape as it is, or is read here.
bool is_known_extension(const std::string& name) {
  for (const char* known : {"KHR_mesh_quantization", "KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_",
                            "MSFT_lod", "MSFT_packing_", "EXT_meshopt_compression", "KHR_meshopt_compression",
                            "KHR_lights_", "EXT_lights_", "KHR_xmp", "KHR_animation_", kCopies}) {
    if (name.starts_with(known)) return true;
  }
  return false;
}

std::vector<std::array<std::uint32_t, 3>> triangles_of(std::uint64_t mode, const std::vector<std::uint32_t>& corners) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const auto corner = [&](std::size_t n) { return corners[n]; };
  if (mode == kTriangles) {
    for (std::size_t n = 0; n + 2 < corners.size(); n += 3)
      triangles.push_back({corner(n), corner(n + 1), corner(n + 2)});
    return triangles;
  }
  for (std::size_t n = 0; n + 2 < corners.size(); ++n) {
    std::array<std::uint32_t, 3> triangle{corner(mode == kTriangleFan ? 0 : n), corner(n + 1), corner(n + 2)};
    if (mode == kTriangleStrip && n % 2 == 1) std::swap(triangle[1], triangle[2]);
    // A corner that is repeated joins two strips.
    const bool joins = triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[0] == triangle[2];
    if (!joins) triangles.push_back(triangle);
  }
  return triangles;
}

class SceneReader {
 public:
  explicit SceneReader(MeshInput& input) : input_(input), file_(input), mesh_(input) {}

  TriangleMesh read() {
    try {
      check_extensions();
      return file_.scene().at("asset").value("generator", "") == kGltfGenerator ? read_own() : read_scene();
    } catch (const GltfValue::exception& error) {
      input_.fail(std::string("its scene is not as glTF has it: ") + error.what());
    }
  }

 private:
  void check_extensions() const {
    for (const GltfValue& name : file_.scene().value("extensionsRequired", GltfValue::array())) {
      const auto extension = name.get<std::string>();
      if (!is_known_extension(extension)) {
        input_.fail("expected a mesh without '" + extension.substr(0, 60) + "', found one that requires it");
      }
    }
  }

  TriangleMesh read_own() {
    const GltfValue extras = file_.scene().at("asset").value("extras", GltfValue::object());
    MeshPlace place;
    place.take("UNIT", extras.value("unit", ""));
    place.take("SPACE", extras.value("space", ""));
    WidePoint offset{};
    if (extras.contains("offset")) offset = numbers<3>(extras, "offset");
    const std::vector<GltfValue> meshes = own_meshes();
    const std::vector<Placement> places = own_places(meshes.size(), offset);
    for (std::size_t n = 0; n < meshes.size(); ++n) {
      add_primitive(meshes[n].at("primitives").at(0), places[n], nullptr);
    }
    check_normals();
    if (meshes.size() > 1) {
      mesh_.mesh().notes.push_back(std::to_string(meshes.size()) +
                                   " parts are joined, without their names and colours");
    }
    TriangleMesh mesh = mesh_.finish(place);
    if (!extras.contains("offset")) return mesh;
    mesh.offset = offset;
    for (const double coordinate : mesh.offset) {
      if (std::abs(coordinate) <= double{std::numeric_limits<float>::max()}) continue;
      input_.fail("expected an offset that is finite in 32 bits, found another");
    }
    return mesh;
  }

  // The meshes of one of isoweave's own files: of several levels the finest, else all of them.
  std::vector<GltfValue> own_meshes() const {
    const GltfValue meshes = file_.scene().value("meshes", GltfValue::array());
    const GltfValue used = file_.scene().value("extensionsUsed", GltfValue::array());
    const bool levels = std::ranges::find(used, GltfValue("MSFT_lod")) != used.end();
    return {meshes.begin(), levels && !meshes.empty() ? meshes.begin() + 1 : meshes.end()};
  }

  bool is_packed() const {
    const GltfValue used = file_.scene().value("extensionsUsed", GltfValue::array());
    return std::ranges::find(used, GltfValue("KHR_mesh_quantization")) != used.end();
  }

  // The places of the meshes of one of isoweave's own files: as stored, but where positions are steps of a grid, where
  // the nodes below the one that turns the axes to those of glTF put them, without the offset.
  std::vector<Placement> own_places(std::size_t meshes, const WidePoint& offset) const {
    std::vector<Placement> places(meshes);
    if (!is_packed()) return places;
    const GltfValue& nodes = file_.scene().at("nodes");
    std::map<std::size_t, std::size_t> parents;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      for (const GltfValue& child : nodes[n].value("children", GltfValue::array())) {
        parents.emplace(to_size(file_.whole(child, "a child")), n);
      }
    }
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (!nodes[n].contains("mesh")) continue;
      const std::uint64_t mesh = file_.whole(nodes[n].at("mesh"), "a mesh");
      if (mesh < meshes) places[to_size(mesh)] = own_place(nodes, parents, n, offset);
    }
    return places;
  }

  Placement own_place(const GltfValue& nodes, const std::map<std::size_t, std::size_t>& parents, std::size_t node,
                      const WidePoint& offset) const {
    constexpr int kDeepest = 3;  // the root, the grid, the part
    Placement placement;
    for (int depth = 0; depth < kDeepest; ++depth) {
      if (!nodes[node].contains("rotation")) placement = both(placement, placement_of(nodes[node]));
      const auto parent = parents.find(node);
      if (parent == parents.end()) break;
      node = parent->second;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) placement.shift[axis] -= offset[axis];
    return placement;
  }

  TriangleMesh read_scene() {
    for (const GltfValue& node : root_nodes()) add_node(node, Placement{}, 0);
    if (vertices_ == 0) input_.fail("expected triangles in the scene that is shown, found none");
    check_normals();
    std::vector<std::string>& notes = mesh_.mesh().notes;
    notes.emplace_back("glTF is in metres, with y up: axes are as stored, and a GLB written from them takes z for up");
    if (meshes_ > 1) notes.push_back(std::to_string(meshes_) + " meshes are joined");
    leftovers_.note(mesh_.mesh());
    MeshPlace place;
    place.take("UNIT", "m");
    return mesh_.finish(place);
  }

  // The nodes of the scene that is shown or, where there is no scene, those that are no child of another.
  std::vector<GltfValue> root_nodes() {
    const GltfValue& scene = file_.scene();
    if (scene.contains("scenes") && !scene.at("scenes").empty()) {
      const std::size_t scenes = scene.at("scenes").size();
      if (scenes > 1) leftovers_.left_out(scenes - 1, "other scenes");
      return file_.element("scenes", scene.value("scene", GltfValue(0))).value("nodes", GltfValue::array());
    }
    std::set<std::uint64_t> children;
    const GltfValue nodes = scene.value("nodes", GltfValue::array());
    for (const GltfValue& node : nodes) {
      for (const GltfValue& child : node.value("children", GltfValue::array())) {
        children.insert(file_.whole(child, "a child"));
      }
    }
    std::vector<GltfValue> roots;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (!children.contains(n)) roots.emplace_back(n);
    }
    return roots;
  }

  void add_node(const GltfValue& number, const Placement& outer, int depth) {
    constexpr int kDeepest = 1000;
    if (depth > kDeepest || !seen_.insert(file_.whole(number, "a node")).second) {
      input_.fail("expected nodes that form trees of at most 1000 levels, found others");
    }
    const GltfValue& node = file_.element("nodes", number);
    const Placement placement = both(placement_of(node), outer);
    if (node.contains("mesh")) {
      for (const Placement& copy : copies_of(node)) add_mesh(node, both(copy, placement));
    }
    for (const GltfValue& child : node.value("children", GltfValue::array())) add_node(child, placement, depth + 1);
  }

  template <std::size_t kCount>
  std::array<double, kCount> numbers(const GltfValue& node, const char* name) const {
    std::array<double, kCount> result{};
    const GltfValue& list = node.at(name);
    bool right = list.is_array() && list.size() == kCount;
    for (std::size_t n = 0; right && n < kCount; ++n) {
      right = list[n].is_number() && std::isfinite(list[n].get<double>());
      if (right) result[n] = list[n].get<double>();
    }
    if (!right) input_.fail("expected " + std::to_string(kCount) + " numbers as " + name + ", found others");
    return result;
  }

  // Where a node puts the copies of its mesh, before it is placed itself: one, unless it has a list of places.
  std::vector<Placement> copies_of(const GltfValue& node) {
    const GltfValue extensions = node.value("extensions", GltfValue::object());
    if (!extensions.contains(kCopies)) return {Placement{}};
    const GltfValue& lists = extensions.at(kCopies).at("attributes");
    std::vector<WidePoint> scales, shifts;
    std::vector<std::array<double, 4>> turns;
    if (lists.contains("SCALE")) scales = file_.vectors(lists.at("SCALE"));
    if (lists.contains("ROTATION")) turns = file_.quaternions(lists.at("ROTATION"));
    if (lists.contains("TRANSLATION")) shifts = file_.vectors(lists.at("TRANSLATION"));
    std::vector<Placement> copies(std::max({scales.size(), turns.size(), shifts.size()}));
    for (const std::size_t count : {scales.size(), turns.size(), shifts.size()}) {
      if (copies.empty() || (count > 0 && count != copies.size()))
        input_.fail("expected places for all copies of a mesh, found fewer");
    }
    count_in(copies.size());
    for (std::size_t n = 0; n < copies.size(); ++n) {
      for (std::size_t axis = 0; axis < 3 && !scales.empty(); ++axis) copies[n].linear[4 * axis] = scales[n][axis];
      if (!turns.empty()) copies[n] = both(copies[n], rotation(turns[n]));
      if (!shifts.empty()) copies[n].shift = shifts[n];
    }
    return copies;
  }

  // A matrix, column by column, or scale, then rotation, then translation.
  Placement placement_of(const GltfValue& node) const {
    Placement placement;
    if (node.contains("matrix")) {
      const auto matrix = numbers<16>(node, "matrix");
      for (std::size_t n = 0; n < 9; ++n) placement.linear[n] = matrix[n % 3 * 4 + n / 3];
      placement.shift = {matrix[12], matrix[13], matrix[14]};
      return placement;
    }
    if (node.contains("scale")) {
      const auto scale = numbers<3>(node, "scale");
      for (std::size_t axis = 0; axis < 3; ++axis) placement.linear[4 * axis] = scale[axis];
    }
    if (node.contains("rotation")) placement = both(placement, rotation(numbers<4>(node, "rotation")));
    if (node.contains("translation")) placement.shift = numbers<3>(node, "translation");
    return placement;
  }

  Placement rotation(const std::array<double, 4>& quaternion) const {
    auto [x, y, z, w] = quaternion;
    const double length = std::sqrt(x * x + y * y + z * z + w * w);
    if (!(length > 0) || !std::isfinite(length)) input_.fail("expected a quaternion as rotation, found none");
    for (double* number : {&x, &y, &z, &w}) *number /= length;
    return {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),  //
             2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),  //
             2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)},
            {0, 0, 0}};
  }

  // Vertices of one mesh that several primitives share, by the numbers of their accessors.
  using Shared = std::map<std::pair<std::string, std::string>, std::pair<std::uint32_t, std::uint64_t>>;

  void add_mesh(const GltfValue& node, const Placement& placement) {
    const GltfValue& mesh = file_.element("meshes", node.at("mesh"));
    if (!placement.is_regular()) {
      leftovers_.left_out(1, "meshes that a node makes flat");
      return;
    }
    const bool skinned = node.contains("skin");
    if (skinned) leftovers_.not_kept("what skins do to vertices");
    ++meshes_;
    Shared shared;
    for (const GltfValue& primitive : mesh.at("primitives")) {
      add_primitive(primitive, skinned ? Placement{} : placement, &shared);
    }
  }

  // Whether a primitive has its data in Draco alone. A file that does not require Draco has them in accessors too.
  bool is_draco_only(const GltfValue& primitive) const {
    const GltfValue& positions = file_.element("accessors", primitive.at("attributes").at("POSITION"));
    return !positions.contains("bufferView") &&
           primitive.value("extensions", GltfValue::object()).contains("KHR_draco_mesh_compression");
  }

  void add_primitive(const GltfValue& primitive, const Placement& placement, Shared* shared) {
    const std::uint64_t mode = primitive.contains("mode") ? file_.whole(primitive.at("mode"), "mode") : kTriangles;
    if (mode > kTriangleFan) input_.fail("expected a mode of up to 6, found " + std::to_string(mode));
    const GltfValue& attributes = primitive.at("attributes");
    if (shared != nullptr && mode < kTriangles) {
      leftovers_.left_out(1, mode == kPoints ? "sets of points" : "sets of lines");
      return;
    }
    if (is_draco_only(primitive)) {
      input_.fail("expected data that are not compressed, found 'KHR_draco_mesh_compression'");
    }
    if (attributes.contains("COLOR_0")) leftovers_.not_kept("colours");
    if (primitive.contains("targets")) leftovers_.not_kept("morph targets");
    const auto [first, count] = add_vertices(attributes, placement, shared);
    if (mode < kTriangles) return;
    std::vector<std::uint32_t> corners;
    if (primitive.contains("indices")) {
      corners = file_.indices(primitive.at("indices"));
    } else {
      for (std::uint32_t n = 0; n < count; ++n) corners.push_back(n);
    }
    if (mode == kTriangles && corners.size() % 3 != 0) input_.fail("expected three indices for each triangle");
    count_in(corners.size());
    mesh_.add_triangles(triangles_of(mode, corners), first, count, placement.determinant() < 0);
  }

  // Adds vertices. Returns the number of the first one, and how many there are.
  std::pair<std::uint32_t, std::uint64_t> add_vertices(const GltfValue& attributes, const Placement& placement,
                                                       Shared* shared) {
    const bool has_normals = attributes.contains("NORMAL");
    const std::pair key(attributes.at("POSITION").dump(), has_normals ? attributes.at("NORMAL").dump() : "");
    if (shared != nullptr && shared->contains(key)) return shared->at(key);
    std::vector<WidePoint> vertices = file_.vectors(attributes.at("POSITION"));
    const std::uint64_t count = vertices.size();
    count_in(count);
    if (has_normals) add_normals(file_.vectors(attributes.at("NORMAL")), placement);
    vertices_ += count;
    const std::pair<std::uint32_t, std::uint64_t> added(mesh_.add_vertices(std::move(vertices), placement), count);
    if (shared != nullptr) shared->emplace(key, added);
    return added;
  }

  void add_normals(const std::vector<WidePoint>& normals, const Placement& placement) {
    for (WidePoint normal : normals) {
      if (placement != Placement{}) {
        normal = turned_normal(placement, normal);
        const double length = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
        for (double& coordinate : normal) coordinate = length > 0 ? coordinate / length : 0;
      }
      mesh_.mesh().normals.push_back(
          {static_cast<float>(normal[0]), static_cast<float>(normal[1]), static_cast<float>(normal[2])});
    }
  }

  void check_normals() {
    std::vector<Point>& normals = mesh_.mesh().normals;
    if (normals.empty() || normals.size() == vertices_) return;
    normals.clear();
    leftovers_.not_kept("normals, which some vertices lack");
  }

  // A file of a few bytes can name the same numbers any number of times.
  void count_in(std::uint64_t numbers) {
    numbers_ += numbers;
    if (numbers_ > kMostCopies * file_.size()) {
      input_.fail("expected copies of meshes in proportion to the file, found more");
    }
  }

  MeshInput& input_;
  GltfFile file_;
  PlacedMesh mesh_;
  std::set<std::uint64_t> seen_;  // nodes
  MeshLeftovers leftovers_;
  std::uint64_t meshes_ = 0, vertices_ = 0, numbers_ = 0;
};

}  // namespace

TriangleMesh read_glb(MeshInput& input) { return SceneReader(input).read(); }

}  // namespace isoweave::mesh_io
