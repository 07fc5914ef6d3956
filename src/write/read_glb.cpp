// GLB as isoweave writes it without packing: one mesh of float positions, perhaps normals, and 32-bit indices.
#include <bit>
#include <limits>
#include <nlohmann/json.hpp>

#include "write/glb_scene.hpp"
#include "write/mesh_input.hpp"

namespace isoweave::mesh_io {
namespace {

using Json = nlohmann::json;

constexpr std::uint64_t kLongestScene = std::uint64_t{16} << 20;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinChunk = 0x004e4942;

class GlbReader {
 public:
  explicit GlbReader(MeshInput& input) : input_(input) {}

  TriangleMesh read() {
    const std::string scene = read_container();
    try {
      take_scene(Json::parse(scene));
    } catch (const Json::exception& error) {
      input_.fail(std::string("its scene is not as isoweave writes it: ") + error.what());
    }
    check_mesh_numbers(input_, mesh_);
    return std::move(mesh_);
  }

 private:
  std::uint32_t next_u32() {
    std::array<std::byte, 4> bytes{};
    input_.read(bytes);
    std::uint32_t value = 0;
    for (std::size_t n = 4; n-- > 0;) value = value << 8 | std::to_integer<std::uint32_t>(bytes[n]);
    return value;
  }

  // Checks the lengths, and gives the scene.
  std::string read_container() {
    next_u32();  // the magic, by which the file was told
    const std::uint32_t version = next_u32();
    if (version != 2) input_.fail("expected version 2 of glTF, found " + std::to_string(version));
    const std::uint32_t total = next_u32();
    if (total != input_.size()) {
      input_.fail("expected " + std::to_string(total) + " bytes, found " + std::to_string(input_.size()));
    }
    const std::uint32_t length = next_u32();
    if (next_u32() != kJsonChunk || length > input_.remaining() || length > kLongestScene) {
      input_.fail("expected a scene of at most 16 MiB at the beginning, found none");
    }
    std::string scene(length, '\0');
    input_.read(std::as_writable_bytes(std::span(scene)));
    if (input_.remaining() == 0) return scene;
    const std::uint32_t data = next_u32();
    if (next_u32() != kBinChunk || data != input_.remaining()) {
      input_.fail("expected one chunk of data up to the end, found another");
    }
    data_ = input_.size() - data;
    return scene;
  }

  void take_scene(const Json& scene) {
    if (scene.at("asset").at("generator") != kGltfGenerator) {
      input_.fail("expected a GLB file that isoweave wrote, found another: its units and axes could be any");
    }
    if (scene.contains("extensionsRequired")) input_.fail("is compressed, which is not read");
    if (!scene.contains("meshes")) return;
    const Json& primitive = scene.at("meshes").at(0).at("primitives").at(0);
    const Json& attributes = primitive.at("attributes");
    mesh_.vertices = read_points(scene, attributes.at("POSITION"));
    if (attributes.contains("NORMAL")) mesh_.normals = read_points(scene, attributes.at("NORMAL"));
    if (mesh_.normals.size() != mesh_.vertices.size() && !mesh_.normals.empty()) {
      input_.fail("expected one normal for each vertex");
    }
    if (!primitive.contains("indices")) return;
    const std::uint64_t corners = open(scene, primitive.at("indices"), kGltfUint32, 4);
    if (corners % 3 != 0) input_.fail("expected three indices for each triangle");
    mesh_.triangles.resize(static_cast<std::size_t>(corners / 3));
    for (auto& triangle : mesh_.triangles) {
      for (std::uint32_t& index : triangle) index = next_u32();
    }
  }

  std::vector<Point> read_points(const Json& scene, const Json& accessor) {
    std::vector<Point> points(static_cast<std::size_t>(open(scene, accessor, kGltfFloat, 12)));
    for (Point& point : points) {
      for (float& coordinate : point) coordinate = std::bit_cast<float>(next_u32());
    }
    return points;
  }

  // Moves to the data of an accessor, after they were compared with the file; gives their number.
  std::uint64_t open(const Json& scene, const Json& number, int type, std::uint64_t each) {
    const Json& accessor = scene.at("accessors").at(number.get<std::size_t>());
    const Json& view = scene.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    const auto count = accessor.at("count").get<std::uint64_t>();
    const auto offset = view.at("byteOffset").get<std::uint64_t>();
    const std::uint64_t left = data_ == 0 || offset > input_.size() - data_ ? 0 : input_.size() - data_ - offset;
    if (accessor.at("componentType") != type || count > left / each) {
      input_.fail("expected " + std::to_string(count) + " numbers of " + std::to_string(each) + " bytes, found " +
                  std::to_string(left) + " bytes");
    }
    input_.move_to(data_ + offset);
    return count;
  }

  MeshInput& input_;
  std::uint64_t data_ = 0;  // where the chunk of data begins; 0: there is none
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_glb(MeshInput& input) { return GlbReader(input).read(); }

}  // namespace isoweave::mesh_io
