// The parts that GLB files of all kinds share: the scene around the mesh, and the container around scene and data.
//
// Coordinates stay those of the volume. glTF means metres in a right-handed frame with y up and z to the front, so the
// root node scales by the unit (millimetres where it is not known) and turns the axes: the patient's superior is up and
// anterior is in front for LPS and RAS; for anything else z is up.
#pragma once

#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "isoweave/mesh.hpp"

namespace isoweave {

using GltfJson = nlohmann::ordered_json;

// glTF's numbers for types of components, targets of buffers and modes of primitives.
inline constexpr int kGltfByte = 5120, kGltfUint16 = 5123, kGltfUint32 = 5125, kGltfFloat = 5126;
inline constexpr int kGltfVertices = 34962, kGltfIndices = 34963;
inline constexpr int kGltfPoints = 0;

inline constexpr std::uint64_t kGlbHeaderBytes = 20;       // of the file, and of its JSON chunk
inline constexpr std::uint64_t kGlbChunkHeaderBytes = 8;   // of the BIN chunk
inline constexpr const char* kGltfGenerator = "isoweave";  // read_mesh knows its own files by it

// Smallest and largest coordinates.
struct Bounds {
  Point low{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
            std::numeric_limits<float>::infinity()};
  Point high{-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
             -std::numeric_limits<float>::infinity()};

  void add(std::span<const Point> points);

  // The bounds as six numbers of a mark.
  std::vector<std::uint64_t> state() const;
  void load(const std::vector<std::uint64_t>& state);
};

// glTF has no normals without a direction.
inline Point gltf_normal(const Point& normal) { return normal == Point{0, 0, 0} ? Point{0, 0, 1} : normal; }

// The "asset", "scene" and "scenes" of a file, and its root node. The root holds mesh 0, or the node `placed` that
// holds it, if that is given.
GltfJson gltf_scene(const MeshFileOptions& options, const GltfJson& placed = nullptr);

// The name that a mesh has by its file.
std::string gltf_name(const std::string& path);

// A mesh of one of the scene's materials.
GltfJson gltf_mesh(const std::string& name, std::size_t material, GltfJson primitive);

// The scene of several levels of detail (MSFT_lod), finest first: `levels` are the contents of their nodes. A viewer
// that does not know the extension shows the finest level only. Each level turns and scales by itself: importers that
// take all nodes see all levels in the same size.
GltfJson gltf_levels(const std::vector<MeshFileOptions>& options, std::vector<GltfJson> levels);

// The scene of named parts: `nodes` are the contents of their nodes. `placed` is a node between the root and the parts
// that places all of them, or null. Part n has material n.
GltfJson gltf_parts(const std::string& path, std::span<const MeshPart> parts, std::vector<GltfJson> nodes,
                    GltfJson placed);

// The scene of a mesh without triangles: glTF has no empty meshes, nor scenes with an empty list of nodes.
GltfJson gltf_empty_scene(const MeshFileOptions& options);

// The scene as text, whatever bytes its comments have.
std::string gltf_text(const GltfJson& scene);

// The file header and the JSON chunk, filled up with blanks to `json_bytes`. `total`: bytes of the file.
std::vector<std::byte> glb_begin(const std::string& json, std::uint64_t json_bytes, std::uint64_t total);

// The header of the BIN chunk.
std::vector<std::byte> glb_chunk(std::uint64_t bytes);

}  // namespace isoweave
