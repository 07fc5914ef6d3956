// GLB packed by meshoptimizer: positions in whole steps of a grid of 16 bits, normals in 8, the order of triangles and
// vertices chosen for the packing.
#include <meshoptimizer.h>

#include <cmath>

#include "isoweave/error.hpp"
#include "write/glb_scene.hpp"
#include "write/mesh_format.hpp"
#include "write/whole_mesh_sink.hpp"

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

// The views at multiples of four in the BIN chunk, which is buffer 0; buffer 1 is what they would be without packing.
std::vector<std::byte> add_views(GltfJson& json, const std::vector<PackedView>& views) {
  std::vector<std::byte> data;
  std::size_t plain = 0;
  for (const PackedView& view : views) {
    const std::size_t bytes = view.count * view.stride;
    GltfJson entry{{"buffer", 1}, {"byteOffset", plain}, {"byteLength", bytes}, {"target", view.target}};
    if (view.target == kGltfVertices) entry["byteStride"] = view.stride;
    entry["extensions"][kExtension] = {{"buffer", 0},
                                       {"byteOffset", data.size()},
                                       {"byteLength", view.bytes.size()},
                                       {"byteStride", view.stride},
                                       {"mode", view.mode},
                                       {"count", view.count}};
    json["bufferViews"].push_back(std::move(entry));
    const auto packed = std::as_bytes(std::span(view.bytes));
    data.insert(data.end(), packed.begin(), packed.end());
    data.resize((data.size() + 3) / 4 * 4);
    plain += bytes;
  }
  GltfJson fallback{{"byteLength", plain}};
  fallback["extensions"][kExtension] = {{"fallback", true}};
  json["buffers"] = {{{"byteLength", data.size()}}, fallback};
  return data;
}

class PackedGlbSink final : public WholeMeshSink {
 public:
  PackedGlbSink(const MeshTarget& target, const MeshFileOptions& options)
      : WholeMeshSink(target, options, kMostPackedTriangles) {}

 private:
  void write_mesh(TriangleMesh mesh) override {
    if (mesh.triangles.empty()) return write_empty();
    const Grid16 grid = Grid16::around(mesh.vertices);
    note(rounding_note(path(), grid, options().unit));
    GltfJson json = scene(grid);
    const std::vector<std::byte> data = add_views(json, pack(std::move(mesh), grid, json));
    write(json, data);
  }

  GltfJson scene(const Grid16& grid) const {
    GltfJson json = gltf_scene(
        options(), {{"mesh", 0}, {"translation", grid.origin}, {"scale", {grid.step, grid.step, grid.step}}});
    json["asset"]["extras"]["rounding_error"] = grid.error();
    for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
      json[key] = {"KHR_mesh_quantization", kExtension};
    }
    return json;
  }

  // Positions, normals if there are any, indices; adds their accessors and the mesh.
  static std::vector<PackedView> pack(TriangleMesh mesh, const Grid16& grid, GltfJson& json) {
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

    std::vector<PackedView> views{pack_vertices(positions)};
    json["accessors"] = {{{"bufferView", 0},
                          {"componentType", kGltfUint16},
                          {"count", used},
                          {"type", "VEC3"},
                          {"min", low},
                          {"max", high}}};
    GltfJson attributes{{"POSITION", 0}};
    if (!normals.empty()) {
      views.push_back(pack_vertices(normals));
      attributes["NORMAL"] = 1;
      json["accessors"].push_back(
          {{"bufferView", 1}, {"componentType", kGltfByte}, {"normalized", true}, {"count", used}, {"type", "VEC3"}});
    }
    json["accessors"].push_back(
        {{"bufferView", views.size()}, {"componentType", kGltfUint32}, {"count", indices.size()}, {"type", "SCALAR"}});
    json["meshes"] = {{{"primitives", {{{"attributes", attributes}, {"indices", views.size()}}}}}};
    views.push_back(pack_indices(indices, used));
    return views;
  }

  void write_empty() {
    GltfJson json = gltf_scene(options());
    json.erase("nodes");
    json["scenes"] = GltfJson::array({GltfJson::object({{"name", "empty"}})});
    write(json, {});
  }

  void write(const GltfJson& json, std::span<const std::byte> data) {
    const std::string text = gltf_text(json);
    const std::uint64_t json_bytes = (text.size() + 3) / 4 * 4;
    const std::uint64_t chunk = data.empty() ? 0 : kGlbChunkHeaderBytes + data.size();
    const std::uint64_t total = kGlbHeaderBytes + json_bytes + chunk;
    check_glb_fits(path(), 0, 0, false, total);
    const std::vector<std::byte> header = glb_begin(text, json_bytes, total);
    file().write(header);
    if (!data.empty()) {
      file().write(glb_chunk(data.size()));
      file().write(data);
    }
    check_written(total, header);
  }
};

}  // namespace

std::unique_ptr<MeshSink> open_packed_glb(const MeshTarget& target, const MeshFileOptions& options) {
  return std::make_unique<PackedGlbSink>(target, options);
}

}  // namespace isoweave
