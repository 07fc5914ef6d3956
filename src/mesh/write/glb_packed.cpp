// GLB packed by meshoptimizer: positions in whole steps of a grid of 16 bits, normals in 8, the order of triangles and
// vertices chosen for the packing.
#include <meshoptimizer.h>

#include <cmath>

#include "isoweave/error.hpp"
#include "mesh/write/glb_scene.hpp"
#include "mesh/write/joined_meshes.hpp"
#include "mesh/write/mesh_format.hpp"
#include "mesh/write/whole_mesh_sink.hpp"

namespace isoweave {
namespace {

using PackedPosition = std::array<std::uint16_t, 4>;  // the last is not used: 4-byte steps are asked for
using PackedNormal = std::array<std::int8_t, 4>;

constexpr const char* kExtension = "EXT_meshopt_compression";

PackedNormal pack_normal(const Point& normal) {
  constexpr double kOne = 127;
  PackedNormal packed{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    packed[axis] = static_cast<std::int8_t>(std::round(double{normal[axis]} * kOne));
  }
  // glTF has no normals without a direction.
  if (packed == PackedNormal{}) packed[2] = static_cast<std::int8_t>(kOne);
  return packed;
}

// One array in the BIN chunk.
struct PackedView {
  std::vector<unsigned char> bytes;
  std::size_t count = 0;
  std::size_t stride = 0;
  const char* mode = "ATTRIBUTES";
  int target = kGltfVertices;
};

template <class Item>
PackedView pack_vertices(const std::vector<Item>& items) {
  PackedView view;
  view.count = items.size();
  view.stride = sizeof(Item);
  view.bytes.resize(meshopt_encodeVertexBufferBound(items.size(), sizeof(Item)));
  view.bytes.resize(
      meshopt_encodeVertexBuffer(view.bytes.data(), view.bytes.size(), items.data(), items.size(), sizeof(Item)));
  return view;
}

PackedView pack_indices(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
  PackedView view;
  view.count = indices.size();
  view.stride = sizeof(std::uint32_t);
  view.mode = "TRIANGLES";
  view.target = kGltfIndices;
  view.bytes.resize(meshopt_encodeIndexBufferBound(indices.size(), vertices));
  view.bytes.resize(meshopt_encodeIndexBuffer(view.bytes.data(), view.bytes.size(), indices.data(), indices.size()));
  return view;
}

// The arrays and meshes of a scene. Data come at multiples of four in the BIN chunk, which is buffer 0. Buffer 1 stands
// for the data without packing.
class PackedScene {
 public:
  explicit PackedScene(std::string path) : path_(std::move(path)) {}

  // Adds a mesh of a name and a material: positions, normals if there are any, and indices. Returns its number.
  std::size_t add(TriangleMesh mesh, const Grid16& grid, const std::string& name, std::size_t material) {
    std::vector<std::uint32_t> indices(mesh.triangles.size() * 3);
    meshopt_optimizeVertexCache(indices.data(), mesh.triangles.front().data(), indices.size(), mesh.vertices.size());
    mesh.triangles = {};
    std::vector<std::uint32_t> numbers(mesh.vertices.size());
    const std::size_t used =
        meshopt_optimizeVertexFetchRemap(numbers.data(), indices.data(), indices.size(), mesh.vertices.size());
    meshopt_remapIndexBuffer(indices.data(), indices.data(), indices.size(), numbers.data());

    constexpr std::uint32_t kUnused = ~std::uint32_t{0};
    std::vector<PackedPosition> positions(used);
    std::vector<PackedNormal> normals(mesh.normals.empty() ? 0 : used);
    std::array<std::uint16_t, 3> low{0xffff, 0xffff, 0xffff};
    std::array<std::uint16_t, 3> high{};
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      if (numbers[n] == kUnused) continue;
      const std::array<std::uint16_t, 3> place = grid.place(mesh.vertices[n]);
      positions[numbers[n]] = {place[0], place[1], place[2], 0};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], place[axis]);
        high[axis] = std::max(high[axis], place[axis]);
      }
      if (!normals.empty()) normals[numbers[n]] = pack_normal(mesh.normals[n]);
    }
    mesh = {};

    GltfJson attributes;
    attributes["POSITION"] =
        add_array(pack_vertices(positions),
                  {{"componentType", kGltfUint16}, {"count", used}, {"type", "VEC3"}, {"min", low}, {"max", high}});
    if (!normals.empty()) {
      attributes["NORMAL"] =
          add_array(pack_vertices(normals),
                    {{"componentType", kGltfByte}, {"normalized", true}, {"count", used}, {"type", "VEC3"}});
    }
    const std::size_t corners = add_array(
        pack_indices(indices, used), {{"componentType", kGltfUint32}, {"count", indices.size()}, {"type", "SCALAR"}});
    meshes_.push_back(gltf_mesh(name, material, {{"attributes", attributes}, {"indices", corners}}));
    return meshes_.size() - 1;
  }

  // Writes the file, with `json` around what was added.
  void write(GltfJson json, OutputDescriptor& file) {
    GltfJson fallback{{"byteLength", plain_}};
    fallback["extensions"][kExtension] = {{"fallback", true}};
    if (!data_.empty()) {
      json["accessors"] = accessors_;
      json["meshes"] = meshes_;
      json["bufferViews"] = views_;
      json["buffers"] = {{{"byteLength", data_.size()}}, fallback};
    }
    const std::string text = gltf_text(json);
    const std::uint64_t json_bytes = (text.size() + 3) / 4 * 4;
    const std::uint64_t chunk = data_.empty() ? 0 : kGlbChunkHeaderBytes + data_.size();
    const std::uint64_t total = kGlbHeaderBytes + json_bytes + chunk;
    check_glb_fits(path_, 0, 0, false, total);
    file.write(glb_begin(text, json_bytes, total));
    if (!data_.empty()) file.write(glb_chunk(data_.size()));
    file.write(data_);
    if (file.size() != total) throw CannotWrite(path_ + ": its counts and its size differ");
  }

 private:
  // Adds an array. Returns the number of its accessor.
  std::size_t add_array(const PackedView& view, GltfJson accessor) {
    const std::size_t bytes = view.count * view.stride;
    GltfJson entry{{"buffer", 1}, {"byteOffset", plain_}, {"byteLength", bytes}, {"target", view.target}};
    if (view.target == kGltfVertices) entry["byteStride"] = view.stride;
    entry["extensions"][kExtension] = {{"buffer", 0},
                                       {"byteOffset", data_.size()},
                                       {"byteLength", view.bytes.size()},
                                       {"byteStride", view.stride},
                                       {"mode", view.mode},
                                       {"count", view.count}};
    accessor["bufferView"] = views_.size();
    views_.push_back(std::move(entry));
    const auto packed = std::as_bytes(std::span(view.bytes));
    data_.insert(data_.end(), packed.begin(), packed.end());
    data_.resize((data_.size() + 3) / 4 * 4);
    plain_ += bytes;
    accessors_.push_back(std::move(accessor));
    return accessors_.size() - 1;
  }

  std::string path_;
  GltfJson views_, accessors_, meshes_;
  std::vector<std::byte> data_;
  std::size_t plain_ = 0;
};

// A node that places what is in whole steps.
GltfJson grid_node(const Grid16& grid, const std::array<double, 3>& offset) {
  std::array<double, 3> place = grid.origin;
  for (std::size_t axis = 0; axis < 3; ++axis) place[axis] += offset[axis];
  return {{"translation", place}, {"scale", {grid.step, grid.step, grid.step}}};
}

// A node that places a mesh in whole steps.
GltfJson placed_node(std::size_t mesh, const Grid16& grid, const std::array<double, 3>& offset) {
  GltfJson node{{"mesh", mesh}};
  node.update(grid_node(grid, offset));
  return node;
}

// Adds the extensions that a viewer needs to read the file.
void add_requirements(GltfJson& json, double rounding_error) {
  json["asset"]["extras"]["rounding_error"] = rounding_error;
  for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
    for (const char* extension : {"KHR_mesh_quantization", kExtension}) json[key].push_back(extension);
  }
}

class PackedGlbSink final : public WholeMeshSink {
 public:
  PackedGlbSink(const MeshTarget& target, const MeshFileOptions& options)
      : WholeMeshSink(target, options, kMostPackedTriangles) {}

 private:
  void write_mesh(TriangleMesh mesh) override {
    PackedScene scene(path());
    if (mesh.triangles.empty()) return scene.write(gltf_empty_scene(options()), file());
    const Grid16 grid = Grid16::around(mesh.vertices);
    note(rounding_note(path(), grid, options().unit));
    const std::size_t number = scene.add(std::move(mesh), grid, gltf_name(path()), 0);
    GltfJson json = gltf_scene(options(), placed_node(number, grid, options().offset));
    add_requirements(json, grid.error());
    scene.write(std::move(json), file());
  }
};

// Levels of detail, each in steps of its own.
class PackedGlbLevels final : public JoinedFile {
 public:
  PackedGlbLevels(const std::string& path, std::span<const MeshFileOptions> levels)
      : JoinedFile(path, levels), file_(path) {}

  void check_room(const JoinedMesh& level, std::uint64_t vertices, std::uint64_t triangles) override {
    check_count_fits(path(), "vertices", level.vertices(), vertices);
    check_count_fits(path(), "triangles", level.triangles(), triangles, kMostPackedTriangles);
  }

 private:
  void write() override {
    PackedScene scene(path());
    std::vector<MeshFileOptions> level_options;
    std::vector<GltfJson> nodes;
    Grid16 coarsest;
    coarsest.step = 0;
    for (JoinedMesh& level : meshes()) {
      level_options.push_back(level.options());
      nodes.push_back(GltfJson::object());
      if (level.triangles() == 0) continue;
      TriangleMesh mesh = level.load();
      const Grid16 grid = Grid16::around(mesh.vertices);
      if (grid.step > coarsest.step) coarsest = grid;
      nodes.back() = placed_node(scene.add(std::move(mesh), grid, gltf_name(path()), 0), grid, level.options().offset);
    }
    GltfJson json = gltf_empty_scene(options());
    if (coarsest.step > 0) {
      note(rounding_note(path(), coarsest, options().unit));
      json = gltf_levels(level_options, std::move(nodes));
      add_requirements(json, coarsest.error());
    }
    scene.write(std::move(json), file_.descriptor());
    file_.commit();
  }

  AtomicFile file_;
};

// Named parts, all in steps of one grid, so that neighbours that touch still do.
class PackedGlbParts final : public JoinedFile {
 public:
  PackedGlbParts(const std::string& path, std::span<const MeshPart> parts)
      : JoinedFile(path, options_of(parts)), parts_(parts.begin(), parts.end()), file_(path) {}

  void check_room(const JoinedMesh& part, std::uint64_t vertices, std::uint64_t triangles) override {
    check_count_fits(path(), "vertices", part.vertices(), vertices);
    check_count_fits(path(), "triangles", part.triangles(), triangles, kMostPackedTriangles);
  }

 private:
  void write() override {
    PackedScene scene(path());
    const Grid16 grid = Grid16::around(corners());
    std::vector<GltfJson> nodes(parts_.size(), GltfJson::object());
    bool is_empty = true;
    for (std::size_t n = 0; n < parts_.size(); ++n) {
      if (mesh(n).triangles() == 0) continue;
      nodes[n]["mesh"] = scene.add(mesh(n).load(), grid, parts_[n].name, n);
      is_empty = false;
    }
    GltfJson json = gltf_empty_scene(options());
    if (!is_empty) {
      note(rounding_note(path(), grid, options().unit));
      json = gltf_parts(path(), parts_, std::move(nodes), grid_node(grid, options().offset));
      add_requirements(json, grid.error());
    }
    scene.write(std::move(json), file_.descriptor());
    file_.commit();
  }

  std::vector<MeshPart> parts_;
  AtomicFile file_;
};

}  // namespace

std::unique_ptr<JoinedFile> open_packed_glb_parts(const std::string& path, std::span<const MeshPart> parts) {
  return std::make_unique<PackedGlbParts>(path, parts);
}

std::unique_ptr<JoinedFile> open_packed_glb_levels(const std::string& path, std::span<const MeshFileOptions> levels) {
  return std::make_unique<PackedGlbLevels>(path, levels);
}

std::unique_ptr<MeshSink> open_packed_glb(const MeshTarget& target, const MeshFileOptions& options) {
  return std::make_unique<PackedGlbSink>(target, options);
}

}  // namespace isoweave
