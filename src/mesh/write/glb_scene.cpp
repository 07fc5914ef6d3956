#include "mesh/write/glb_scene.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "files/length_units.hpp"
#include "mesh/write/mesh_file_sink.hpp"

namespace isoweave {
namespace {

constexpr std::uint32_t kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinChunk = 0x004e4942;

// The turn to y up as a quaternion. RAS: half a turn about the middle of y and z, (x, y, z) -> (-x, z, y). Others: a
// quarter turn about x, (x, y, z) -> (x, z, -y).
std::array<double, 4> turn_to_y_up(const std::string& space) {
  const double half = std::sqrt(0.5);
  if (space == "RAS") return {0, half, half, 0};
  return {-half, 0, 0, half};
}

// Without a material a surface is of metal, which is dark in most lights. The colour is linear, as glTF wants it.
GltfJson gltf_material(const std::string& name, const std::array<double, 4>& linear) {
  GltfJson surface;
  surface["baseColorFactor"] = linear;
  surface["metallicFactor"] = 0.0;
  surface["roughnessFactor"] = 0.8;
  GltfJson material{{"name", name}, {"pbrMetallicRoughness", surface}};
  if (linear[3] < 1) material["alphaMode"] = "BLEND";
  return material;
}

// sRGB as a linear number (IEC 61966-2-1).
double linear_of(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

GltfJson material_of(const MeshPart& part) {
  const auto [red, green, blue, opacity] = part.color;
  return gltf_material(part.name, {linear_of(red), linear_of(green), linear_of(blue), opacity});
}

}  // namespace

std::string gltf_name(const std::string& path) { return std::filesystem::path(path).stem().string(); }

GltfJson gltf_mesh(const std::string& name, std::size_t material, GltfJson primitive) {
  primitive["material"] = material;
  return {{"name", name}, {"primitives", GltfJson::array({std::move(primitive)})}};
}

void Bounds::add(std::span<const Point> points) {
  for (const Point& point : points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], point[axis]);
      high[axis] = std::max(high[axis], point[axis]);
    }
  }
}

std::vector<std::uint64_t> Bounds::state() const {
  std::vector<std::uint64_t> numbers;
  for (const Point& corner : {low, high}) {
    for (const float coordinate : corner) numbers.push_back(std::bit_cast<std::uint32_t>(coordinate));
  }
  return numbers;
}

void Bounds::load(const std::vector<std::uint64_t>& state) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = std::bit_cast<float>(static_cast<std::uint32_t>(state[axis]));
    high[axis] = std::bit_cast<float>(static_cast<std::uint32_t>(state[3 + axis]));
  }
}

GltfJson gltf_scene(const MeshFileOptions& options, const GltfJson& placed) {
  GltfJson json;
  json["asset"] = {{"version", "2.0"}, {"generator", kGltfGenerator}};
  GltfJson& extras = json["asset"]["extras"];
  extras["comments"] = options.comments;
  extras["unit"] = options.unit;
  extras["space"] = options.space;
  if (has_offset(options)) extras["offset"] = options.offset;
  // Bone, as in pictures by render.
  json["materials"] = GltfJson::array({gltf_material("surface", {0.73, 0.61, 0.456, 1.0})});
  json["scene"] = 0;
  json["scenes"] = {{{"nodes", {0}}}};
  GltfJson root{{"rotation", turn_to_y_up(options.space)}};
  const double metres = unit_in(unit_or_usual(options.unit), "m").value_or(1);
  if (metres != 1) root["scale"] = {metres, metres, metres};
  if (placed.is_null() && has_offset(options)) {
    root["children"] = {1};
    json["nodes"] = {root, {{"mesh", 0}, {"translation", options.offset}}};
  } else if (placed.is_null()) {
    root["mesh"] = 0;
    json["nodes"] = GltfJson::array({root});  // {root} is root to some compilers
  } else {
    root["children"] = {1};
    json["nodes"] = {root, placed};
  }
  return json;
}

GltfJson gltf_levels(const std::vector<MeshFileOptions>& options, std::vector<GltfJson> levels) {
  GltfJson json = gltf_scene(options.front(), GltfJson::object());
  json["nodes"].erase(1);  // the root's child is the finest level
  const GltfJson root = std::exchange(json["nodes"][0], GltfJson{{"children", {1}}});
  std::vector<GltfJson> placed;
  for (std::size_t level = 0; level < levels.size(); ++level) {
    GltfJson& node = levels[level];
    if (node.contains("translation") || node.contains("scale")) {
      placed.push_back(std::exchange(node, GltfJson::object()));
      node["children"] = {1 + levels.size() + placed.size() - 1};
    }
    for (const char* key : {"rotation", "scale"}) {
      if (root.contains(key)) node[key] = root.at(key);
    }
    node["name"] = "lod" + std::to_string(level);
    node["extras"]["comments"] = options[level].comments;
    if (level > 0) levels[0]["extensions"]["MSFT_lod"]["ids"].push_back(level + 1);
  }
  for (GltfJson& node : levels) json["nodes"].push_back(std::move(node));
  for (GltfJson& node : placed) json["nodes"].push_back(std::move(node));
  if (levels.size() > 1) json["extensionsUsed"] = {"MSFT_lod"};
  return json;
}

GltfJson gltf_parts(const std::string& path, std::span<const MeshPart> parts, std::vector<GltfJson> nodes,
                    GltfJson placed) {
  GltfJson json = gltf_scene(parts.front().options, GltfJson::object());
  json["asset"]["extras"].erase("comments");  // each part has its own
  GltfJson root = std::move(json["nodes"][0]);
  root["name"] = gltf_name(path);
  json["nodes"] = GltfJson::array();
  json["materials"] = GltfJson::array();
  const std::size_t first = placed.is_null() ? 1 : 2;
  GltfJson children = GltfJson::array();
  for (std::size_t n = 0; n < parts.size(); ++n) {
    nodes[n]["name"] = parts[n].name;
    nodes[n]["extras"]["comments"] = parts[n].options.comments;
    json["materials"].push_back(material_of(parts[n]));
    children.push_back(first + n);
  }
  (placed.is_null() ? root : placed)["children"] = std::move(children);
  json["nodes"].push_back(std::move(root));
  if (!placed.is_null()) json["nodes"].push_back(std::move(placed));
  for (GltfJson& node : nodes) json["nodes"].push_back(std::move(node));
  return json;
}

GltfJson gltf_empty_scene(const MeshFileOptions& options) {
  GltfJson json = gltf_scene(options);
  json.erase("nodes");
  json.erase("materials");
  json["scenes"] = GltfJson::array({GltfJson::object({{"name", "empty"}})});
  return json;
}

std::string gltf_text(const GltfJson& scene) { return scene.dump(-1, ' ', false, GltfJson::error_handler_t::replace); }

std::vector<std::byte> glb_begin(const std::string& json, std::uint64_t json_bytes, std::uint64_t total) {
  if (json.size() > json_bytes) throw std::logic_error("the scene of a GLB file is longer than was foreseen");
  std::vector<std::byte> bytes(kGlbHeaderBytes + json_bytes, std::byte{' '});
  std::byte* out = bytes.data();
  for (const std::uint64_t word : {std::uint64_t{kGlbMagic}, std::uint64_t{2}, total, json_bytes}) {
    store_u32(out, static_cast<std::uint32_t>(word));
  }
  store_u32(out, kJsonChunk);
  std::transform(json.begin(), json.end(), out, [](char c) { return static_cast<std::byte>(c); });
  return bytes;
}

std::vector<std::byte> glb_chunk(std::uint64_t bytes) {
  std::vector<std::byte> header(kGlbChunkHeaderBytes);
  std::byte* out = header.data();
  store_u32(out, static_cast<std::uint32_t>(bytes));
  store_u32(out, kBinChunk);
  return header;
}

}  // namespace isoweave
