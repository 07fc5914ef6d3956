// GLB, glTF 2.0 in one file: a scene as JSON, then positions, normals and indices. Positions are written as they come,
// behind a place kept for the scene; normals and indices wait in files of their own.
#include <atomic>

#include "isoweave/error.hpp"
#include "mesh/write/glb_scene.hpp"
#include "mesh/write/mesh_file_sink.hpp"
#include "mesh/write/mesh_format.hpp"
#include "mesh/write/mesh_levels.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kPointBytes = 12;
constexpr std::size_t kTriangleBytes = 12;

struct Counts {
  std::uint64_t vertices = 0, triangles = 0;
};

// Numbers of a viewed float are those of the float: its double has the same value.
std::array<double, 3> as_doubles(const Point& point) { return {point[0], point[1], point[2]}; }

// Adds a mesh of so many vertices and triangles, whose data begin at byte `end` of the BIN chunk, and moves `end`
// behind them.
void add_mesh(GltfJson& json, const std::string& path, bool normals, const Counts& counts, const Bounds& bounds,
              std::uint64_t& end) {
  const auto add = [&](std::uint64_t bytes, int target, GltfJson accessor) {
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", end}, {"byteLength", bytes}, {"target", target}});
    accessor["bufferView"] = json["bufferViews"].size() - 1;
    json["accessors"].push_back(std::move(accessor));
    end += bytes;
    return json["accessors"].size() - 1;
  };
  GltfJson attributes;
  attributes["POSITION"] = add(counts.vertices * kPointBytes, kGltfVertices,
                               {{"componentType", kGltfFloat},
                                {"count", counts.vertices},
                                {"type", "VEC3"},
                                {"min", as_doubles(bounds.low)},
                                {"max", as_doubles(bounds.high)}});
  if (normals) {
    attributes["NORMAL"] = add(counts.vertices * kPointBytes, kGltfVertices,
                               {{"componentType", kGltfFloat}, {"count", counts.vertices}, {"type", "VEC3"}});
  }
  GltfJson primitive{{"attributes", attributes}};
  if (counts.triangles > 0) {
    primitive["indices"] = add(counts.triangles * kTriangleBytes, kGltfIndices,
                               {{"componentType", kGltfUint32}, {"count", counts.triangles * 3}, {"type", "SCALAR"}});
  } else {
    primitive["mode"] = kGltfPoints;
  }
  json["meshes"].push_back(gltf_mesh(path, std::move(primitive)));
}

std::string scene_text(const std::string& path, const MeshFileOptions& options, const Counts& counts,
                       const Bounds& bounds) {
  if (counts.vertices == 0) return gltf_text(gltf_empty_scene(options));
  GltfJson json = gltf_scene(options);
  std::uint64_t end = 0;
  add_mesh(json, path, options.normals, counts, bounds, end);
  json["buffers"] = {{{"byteLength", end}}};
  return gltf_text(json);
}

// The bytes to keep for the scene: as many as the longest numbers take, in a multiple of four.
std::uint64_t reserved_bytes(const std::string& path, const MeshFileOptions& options) {
  constexpr float kLong = -1.17549435e-38F;
  constexpr std::uint64_t kMany = std::uint64_t{1} << 60;
  const std::string longest = scene_text(path, options, {kMany, kMany}, {{kLong, kLong, kLong}, {kLong, kLong, kLong}});
  constexpr std::size_t kSpare = 32;
  return (longest.size() + kSpare) / 4 * 4;
}

class GlbSink final : public MeshFileSink {
 public:
  GlbSink(const MeshTarget& target, const MeshFileOptions& options)
      : MeshFileSink(target, options),
        json_bytes_(reserved_bytes(target.path, options)),
        faces_(open_side("faces.part")) {
    if (options.normals) normals_ = &open_side("normals.part");
    if (continued()) {
      bounds_.load(saved_state(6));
    } else {
      file().write(glb_begin("", json_bytes_, 0));
      file().write(glb_chunk(0));
    }
  }

 private:
  std::uint64_t data_begin() const { return kGlbHeaderBytes + json_bytes_ + kGlbChunkHeaderBytes; }

  std::vector<std::uint64_t> state() const override { return bounds_.state(); }

  void write_piece(const MeshPiece& piece) override {
    check_glb_fits(path(), this->vertices() + piece.vertices.size(), this->triangles() + piece.triangles.size(),
                   options().normals, data_begin());
    bounds_.add(piece.vertices);
    write_records(file(), records_, piece.vertices.size(), kPointBytes,
                  [&](std::byte*& out, std::size_t n) { store_point(out, piece.vertices[n]); });
    if (normals_ != nullptr) {
      write_records(*normals_, records_, piece.normals.size(), kPointBytes,
                    [&](std::byte*& out, std::size_t n) { store_point(out, gltf_normal(piece.normals[n])); });
    }
    write_records(faces_, records_, piece.triangles.size(), kTriangleBytes,
                  [&](std::byte*& out, std::size_t n) { store_indices(out, piece.triangles[n]); });
  }

  void complete() override {
    if (normals_ != nullptr) file().append(*normals_);
    file().append(faces_);
    const std::uint64_t total = data_begin() + vertices() * (options().normals ? 24 : 12) + triangles() * 12;
    const std::string json = scene_text(path(), options(), {vertices(), triangles()}, bounds_);
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

// Levels of detail, each with a mesh of its own in the one chunk of data.
class GlbLevels final : public LevelFile {
 public:
  GlbLevels(const std::string& path, std::span<const MeshFileOptions> levels) : LevelFile(path, levels), file_(path) {
    for (const LevelParts& level : this->levels()) bytes_ += data_bytes(level.vertices(), level.triangles());
  }

  void check_room(const LevelParts&, std::uint64_t vertices, std::uint64_t triangles) override {
    const std::uint64_t more = data_bytes(vertices, triangles);
    check_glb_fits(path(), 0, 0, false, bytes_.fetch_add(more, std::memory_order_relaxed) + more);
  }

 private:
  std::uint64_t data_bytes(std::uint64_t vertices, std::uint64_t triangles) {
    return vertices * kPointBytes * (options().normals ? 2 : 1) + triangles * kTriangleBytes;
  }

  // A level that has vanished is a node without a mesh.
  GltfJson scene(std::uint64_t& end) {
    if (levels().front().vertices() == 0) return gltf_empty_scene(options());
    std::vector<MeshFileOptions> level_options;
    std::vector<GltfJson> nodes;
    std::size_t meshes = 0;
    for (const LevelParts& level : levels()) {
      level_options.push_back(level.options());
      nodes.push_back(GltfJson::object());
      if (level.vertices() > 0) nodes.back()["mesh"] = meshes++;
      if (has_offset(level.options())) nodes.back()["translation"] = level.options().offset;
    }
    GltfJson json = gltf_levels(level_options, std::move(nodes));
    for (const LevelParts& level : levels()) {
      if (level.vertices() == 0) continue;
      add_mesh(json, path(), options().normals, {level.vertices(), level.triangles()}, level.bounds(), end);
    }
    json["buffers"] = {{{"byteLength", end}}};
    return json;
  }

  void write() override {
    std::uint64_t data = 0;
    const std::string text = gltf_text(scene(data));
    const std::uint64_t json_bytes = (text.size() + 3) / 4 * 4;
    const std::uint64_t total = kGlbHeaderBytes + json_bytes + (data > 0 ? kGlbChunkHeaderBytes + data : 0);
    check_glb_fits(path(), 0, 0, false, total);
    file_.write(glb_begin(text, json_bytes, total));
    if (data > 0) file_.write(glb_chunk(data));
    for (LevelParts& level : levels()) level.append_to(file_);
    if (file_.size() != total) throw CannotWrite(path() + ": its counts and its size differ");
    file_.commit();
  }

  AtomicFile file_;
  std::atomic<std::uint64_t> bytes_{0};  // of the chunk of data
};

}  // namespace

std::unique_ptr<LevelFile> open_glb_levels(const std::string& path, std::span<const MeshFileOptions> levels) {
  return std::make_unique<GlbLevels>(path, levels);
}

std::unique_ptr<MeshSink> open_glb(const MeshTarget& target, const MeshFileOptions& options) {
  return std::make_unique<GlbSink>(target, options);
}

}  // namespace isoweave
