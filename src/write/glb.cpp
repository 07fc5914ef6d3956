// GLB, glTF 2.0 in one file: a scene as JSON, then positions, normals and indices. Positions are written as they come,
// behind a place kept for the scene; normals and indices wait in files of their own.
#include "write/glb_scene.hpp"
#include "write/mesh_file_sink.hpp"
#include "write/mesh_format.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kPointBytes = 12;
constexpr std::size_t kTriangleBytes = 12;

struct Counts {
  std::uint64_t vertices = 0, triangles = 0;
};

// Numbers of a viewed float are those of the float: its double has the same value.
std::array<double, 3> as_doubles(const Point& point) { return {point[0], point[1], point[2]}; }

std::string scene_text(const MeshFileOptions& options, const Counts& counts, const Bounds& bounds) {
  GltfJson json = gltf_scene(options);
  if (counts.vertices == 0) {
    // glTF has no empty meshes, nor scenes with an empty list of nodes.
    json.erase("nodes");
    json["scenes"] = GltfJson::array({GltfJson::object({{"name", "empty"}})});
    return gltf_text(json);
  }
  GltfJson attributes{{"POSITION", 0}};
  std::uint64_t end = 0;
  const auto add = [&](std::uint64_t bytes, int target, GltfJson accessor) {
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", end}, {"byteLength", bytes}, {"target", target}});
    accessor["bufferView"] = json["bufferViews"].size() - 1;
    json["accessors"].push_back(std::move(accessor));
    end += bytes;
  };
  add(counts.vertices * kPointBytes, kGltfVertices,
      {{"componentType", kGltfFloat},
       {"count", counts.vertices},
       {"type", "VEC3"},
       {"min", as_doubles(bounds.low)},
       {"max", as_doubles(bounds.high)}});
  if (options.normals) {
    attributes["NORMAL"] = 1;
    add(counts.vertices * kPointBytes, kGltfVertices,
        {{"componentType", kGltfFloat}, {"count", counts.vertices}, {"type", "VEC3"}});
  }
  GltfJson primitive{{"attributes", attributes}};
  if (counts.triangles > 0) {
    add(counts.triangles * kTriangleBytes, kGltfIndices,
        {{"componentType", kGltfUint32}, {"count", counts.triangles * 3}, {"type", "SCALAR"}});
    primitive["indices"] = json["accessors"].size() - 1;
  } else {
    primitive["mode"] = kGltfPoints;
  }
  json["meshes"] = {{{"primitives", GltfJson::array({primitive})}}};
  json["buffers"] = {{{"byteLength", end}}};
  return gltf_text(json);
}

// Bytes to keep for the scene: as many as the longest numbers take, in a multiple of four.
std::uint64_t reserved_bytes(const MeshFileOptions& options) {
  constexpr float kLong = -1.17549435e-38F;
  constexpr std::uint64_t kMany = std::uint64_t{1} << 60;
  const std::string longest = scene_text(options, {kMany, kMany}, {{kLong, kLong, kLong}, {kLong, kLong, kLong}});
  constexpr std::size_t kSpare = 32;
  return (longest.size() + kSpare) / 4 * 4;
}

class GlbSink final : public MeshFileSink {
 public:
  GlbSink(const MeshTarget& target, const MeshFileOptions& options)
      : MeshFileSink(target, options), json_bytes_(reserved_bytes(options)), faces_(open_side("faces.part")) {
    if (options.normals) normals_ = &open_side("normals.part");
    if (continued()) {
      load_bounds(saved_state(6));
    } else {
      file().write(glb_begin("", json_bytes_, 0));
      file().write(glb_chunk(0));
    }
  }

 private:
  std::uint64_t data_begin() const { return kGlbHeaderBytes + json_bytes_ + kGlbChunkHeaderBytes; }

  void load_bounds(const std::vector<std::uint64_t>& numbers) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bounds_.low[axis] = std::bit_cast<float>(static_cast<std::uint32_t>(numbers[axis]));
      bounds_.high[axis] = std::bit_cast<float>(static_cast<std::uint32_t>(numbers[3 + axis]));
    }
  }

  std::vector<std::uint64_t> state() const override {
    std::vector<std::uint64_t> numbers;
    for (const Point& corner : {bounds_.low, bounds_.high}) {
      for (const float coordinate : corner) numbers.push_back(std::bit_cast<std::uint32_t>(coordinate));
    }
    return numbers;
  }

  void write_piece(const MeshPiece& piece) override {
    check_glb_fits(path(), this->vertices() + piece.vertices.size(), this->triangles() + piece.triangles.size(),
                   options().normals, data_begin());
    bounds_.add(piece.vertices);
    write_records(file(), records_, piece.vertices.size(), kPointBytes,
                  [&](std::byte*& out, std::size_t n) { store_point(out, piece.vertices[n]); });
    if (normals_ != nullptr) {
      write_records(*normals_, records_, piece.normals.size(), kPointBytes,
                    [&](std::byte*& out, std::size_t n) { store_point(out, unit_normal(piece.normals[n])); });
    }
    write_records(faces_, records_, piece.triangles.size(), kTriangleBytes,
                  [&](std::byte*& out, std::size_t n) { store_indices(out, piece.triangles[n]); });
  }

  // glTF has no normals without a direction.
  static Point unit_normal(const Point& normal) { return normal == Point{0, 0, 0} ? Point{0, 0, 1} : normal; }

  void complete() override {
    if (normals_ != nullptr) file().append(*normals_);
    file().append(faces_);
    const std::uint64_t total = data_begin() + vertices() * (options().normals ? 24 : 12) + triangles() * 12;
    const std::string json = scene_text(options(), {vertices(), triangles()}, bounds_);
    // An empty BIN chunk should not be there: the scene's blanks cover its header.
    const std::uint64_t json_bytes = json_bytes_ + (vertices() == 0 ? kGlbChunkHeaderBytes : 0);
    std::vector<std::byte> header = glb_begin(json, json_bytes, total);
    if (vertices() > 0) {
      const std::vector<std::byte> chunk = glb_chunk(total - data_begin());
      header.insert(header.end(), chunk.begin(), chunk.end());
    }
    file().overwrite(0, header);
    check_written(total, header);
  }

  std::uint64_t json_bytes_;
  OutputDescriptor& faces_;
  OutputDescriptor* normals_ = nullptr;
  Bounds bounds_;
  std::vector<std::byte> records_;
};

}  // namespace

std::unique_ptr<MeshSink> open_glb(const MeshTarget& target, const MeshFileOptions& options) {
  return std::make_unique<GlbSink>(target, options);
}

}  // namespace isoweave
