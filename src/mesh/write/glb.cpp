// GLB, glTF 2.0 in one file: a scene as JSON, then positions, normals and indices. Positions are written as they come,
// behind a place kept for the scene; normals and indices wait in files of their own.
#include <atomic>

#include "isoweave/error.hpp"
#include "mesh/write/glb_scene.hpp"
#include "mesh/write/joined_meshes.hpp"
#include "mesh/write/mesh_file_sink.hpp"
#include "mesh/write/mesh_format.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kVectorBytes = 12;
constexpr std::size_t kFaceBytes = 12;

struct Counts {
  std::uint64_t vertices = 0, triangles = 0;
};

// Numbers of a viewed float are those of the float: its double has the same value.
std::array<double, 3> as_doubles(const Point& point) { return {point[0], point[1], point[2]}; }

// Adds the mesh of a material, with so many vertices and triangles, whose data begin at byte `end` of the BIN chunk.
// Returns the primitive, and moves `end` behind the data.
GltfJson add_arrays(GltfJson& json, bool normals, const Counts& counts, const Bounds& bounds, std::uint64_t& end) {
  const auto add = [&](std::uint64_t bytes, int target, GltfJson accessor) {
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", end}, {"byteLength", bytes}, {"target", target}});
    accessor["bufferView"] = json["bufferViews"].size() - 1;
    json["accessors"].push_back(std::move(accessor));
    end += bytes;
    return json["accessors"].size() - 1;
  };
  GltfJson attributes;
  attributes["POSITION"] = add(counts.vertices * kVectorBytes, kGltfVertices,
                               {{"componentType", kGltfFloat},
                                {"count", counts.vertices},
                                {"type", "VEC3"},
                                {"min", as_doubles(bounds.low)},
                                {"max", as_doubles(bounds.high)}});
  if (normals) {
    attributes["NORMAL"] = add(counts.vertices * kVectorBytes, kGltfVertices,
                               {{"componentType", kGltfFloat}, {"count", counts.vertices}, {"type", "VEC3"}});
  }
  GltfJson primitive{{"attributes", attributes}};
  if (counts.triangles > 0) {
    primitive["indices"] = add(counts.triangles * kFaceBytes, kGltfIndices,
                               {{"componentType", kGltfUint32}, {"count", counts.triangles * 3}, {"type", "SCALAR"}});
  } else {
    primitive["mode"] = kGltfPoints;
  }
  return primitive;
}

std::string scene_text(const std::string& path, const MeshFileOptions& options, const Counts& counts,
                       const Bounds& bounds) {
  if (counts.vertices == 0) return gltf_text(gltf_empty_scene(options));
  GltfJson json = gltf_scene(options);
  std::uint64_t end = 0;
  json["meshes"] =
      GltfJson::array({gltf_mesh(gltf_name(path), 0, add_arrays(json, options.normals, counts, bounds, end))});
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
    write_records(file(), records_, piece.vertices.size(), kVectorBytes,
                  [&](std::byte*& out, std::size_t n) { store_point(out, piece.vertices[n]); });
    if (normals_ != nullptr) {
      write_records(*normals_, records_, piece.normals.size(), kVectorBytes,
                    [&](std::byte*& out, std::size_t n) { store_point(out, gltf_normal(piece.normals[n])); });
    }
    write_records(faces_, records_, piece.triangles.size(), kFaceBytes,
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

// Several meshes with their data one after another in the one chunk.
class GlbJoined : public JoinedFile {
 public:
  GlbJoined(const std::string& path, std::span<const MeshFileOptions> meshes) : JoinedFile(path, meshes), file_(path) {
    for (const JoinedMesh& mesh : this->meshes()) bytes_ += data_bytes(mesh.vertices(), mesh.triangles());
  }

  void check_room(const JoinedMesh&, std::uint64_t vertices, std::uint64_t triangles) override {
    const std::uint64_t more = data_bytes(vertices, triangles);
    check_glb_fits(path(), 0, 0, false, bytes_.fetch_add(more, std::memory_order_relaxed) + more);
  }

 protected:
  // The scene around the contents of a node for each mesh.
  virtual GltfJson scene(std::vector<GltfJson> nodes) = 0;

  // The name and the number of the material of a mesh.
  virtual std::pair<std::string, std::size_t> look_of(std::size_t mesh) const = 0;

  // Whether the file shows nothing.
  virtual bool is_empty() = 0;

 private:
  std::uint64_t data_bytes(std::uint64_t vertices, std::uint64_t triangles) {
    return vertices * kVectorBytes * (options().normals ? 2 : 1) + triangles * kFaceBytes;
  }

  // A mesh without vertices is a node alone, as glTF has no empty meshes.
  GltfJson whole_scene(std::uint64_t& end) {
    if (is_empty()) return gltf_empty_scene(options());
    std::vector<GltfJson> nodes(meshes().size(), GltfJson::object());
    std::size_t numbered = 0;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (mesh(n).vertices() > 0) nodes[n]["mesh"] = numbered++;
    }
    GltfJson json = scene(std::move(nodes));
    for (std::size_t n = 0; n < meshes().size(); ++n) {
      if (mesh(n).vertices() == 0) continue;
      const auto [name, material] = look_of(n);
      const Counts counts{mesh(n).vertices(), mesh(n).triangles()};
      GltfJson primitive = add_arrays(json, options().normals, counts, mesh(n).bounds(), end);
      json["meshes"].push_back(gltf_mesh(name, material, std::move(primitive)));
    }
    json["buffers"] = {{{"byteLength", end}}};
    return json;
  }

  void write() override {
    std::uint64_t data = 0;
    const std::string text = gltf_text(whole_scene(data));
    const std::uint64_t json_bytes = (text.size() + 3) / 4 * 4;
    const std::uint64_t total = kGlbHeaderBytes + json_bytes + (data > 0 ? kGlbChunkHeaderBytes + data : 0);
    check_glb_fits(path(), 0, 0, false, total);
    file_.write(glb_begin(text, json_bytes, total));
    if (data > 0) file_.write(glb_chunk(data));
    for (JoinedMesh& mesh : meshes()) mesh.append_to(file_);
    if (file_.size() != total) throw CannotWrite(path() + ": its counts and its size differ");
    file_.commit();
  }

  AtomicFile file_;
  std::atomic<std::uint64_t> bytes_{0};  // of the chunk of data
};

// Levels of detail. One that has vanished is a node without a mesh.
class GlbLevels final : public GlbJoined {
 public:
  using GlbJoined::GlbJoined;

 private:
  bool is_empty() override { return mesh(0).vertices() == 0; }

  std::pair<std::string, std::size_t> look_of(std::size_t) const override { return {gltf_name(path()), 0}; }

  GltfJson scene(std::vector<GltfJson> nodes) override {
    std::vector<MeshFileOptions> options;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      options.push_back(mesh(n).options());
      if (has_offset(options.back())) nodes[n]["translation"] = options.back().offset;
    }
    return gltf_levels(options, std::move(nodes));
  }
};

class GlbParts final : public GlbJoined {
 public:
  GlbParts(const std::string& path, std::span<const MeshPart> parts)
      : GlbJoined(path, options_of(parts)), parts_(parts.begin(), parts.end()) {}

 private:
  bool is_empty() override { return corners().empty(); }

  std::pair<std::string, std::size_t> look_of(std::size_t mesh) const override { return {parts_[mesh].name, mesh}; }

  GltfJson scene(std::vector<GltfJson> nodes) override {
    GltfJson placed;
    if (has_offset(options())) placed["translation"] = options().offset;
    return gltf_parts(path(), parts_, std::move(nodes), std::move(placed));
  }

  std::vector<MeshPart> parts_;
};

}  // namespace

std::unique_ptr<JoinedFile> open_glb_levels(const std::string& path, std::span<const MeshFileOptions> levels) {
  return std::make_unique<GlbLevels>(path, levels);
}

std::unique_ptr<JoinedFile> open_glb_parts(const std::string& path, std::span<const MeshPart> parts) {
  return std::make_unique<GlbParts>(path, parts);
}

std::unique_ptr<MeshSink> open_glb(const MeshTarget& target, const MeshFileOptions& options) {
  return std::make_unique<GlbSink>(target, options);
}

}  // namespace isoweave
