// The metadata of neuroglancer's precomputed volumes.
#include "volume/formats/chunked/precomputed_info.hpp"

#include <array>
#include <limits>
#include <numeric>
#include <utility>

#include "files/input_file.hpp"
#include "files/quoted.hpp"
#include "volume/formats/chunked/zarr_node.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kMostSamples = std::int64_t{1} << 40;

// Three whole numbers along x, y, z, each at least `least`.
std::array<std::int64_t, 3> triple(const Json& json, std::string_view key, std::int64_t least,
                                   const std::string& path) {
  const std::vector<std::int64_t> list = integers_member(json, key, path);
  const bool fits = list.size() == 3 && std::ranges::all_of(list, [least](std::int64_t value) {
                      return value >= least && value <= kMostSamples;
                    });
  if (!fits) {
    bad_input(path, "three whole numbers from " + std::to_string(least) + " on as '" + std::string(key) + "'",
              "others");
  }
  return {list[0], list[1], list[2]};
}

std::uint32_t bits_of(const Json& json, std::string_view key, const std::string& path) {
  const Json* const value = member(json, key);
  const std::optional<std::int64_t> bits = value == nullptr ? std::optional<std::int64_t>(0) : integer_of(*value);
  if (!bits || *bits < 0 || *bits > 64) bad_input(path, "0 to 64 '" + std::string(key) + "'", "others");
  return static_cast<std::uint32_t>(*bits);
}

bool is_gzip(const Json& json, std::string_view key, const std::string& path) {
  const std::string name = text_member(json, key);
  if (!name.empty() && name != "raw" && name != "gzip") {
    bad_input(path, "raw or gzip as '" + std::string(key) + "'", in_quotes(name));
  }
  return name == "gzip";
}

PrecomputedShards shards_of(const Json& json, const std::string& path) {
  const std::string type = text_member(json, "@type"), hash = text_member(json, "hash");
  if (type != "neuroglancer_uint64_sharded_v1") bad_input(path, "neuroglancer_uint64_sharded_v1", in_quotes(type));
  if (hash != "identity" && hash != "murmurhash3_x86_128") {
    bad_input(path, "hash identity or murmurhash3_x86_128", in_quotes(hash));
  }
  const PrecomputedShards shards{bits_of(json, "preshift_bits", path), bits_of(json, "minishard_bits", path),
                                 bits_of(json, "shard_bits", path), hash != "identity",
                                 is_gzip(json, "minishard_index_encoding", path)};
  constexpr std::uint32_t kMostMinishardBits = 24;
  if (shards.minishard_bits > kMostMinishardBits || shards.minishard_bits + shards.shard_bits > 64) {
    bad_input(path, "at most 24 minishard_bits, 64 with those of shards",
              std::to_string(shards.minishard_bits) + " and " + std::to_string(shards.shard_bits));
  }
  return shards;
}

void take_encoding(ChunkedArray& array, const Json& scale) {
  const std::string& path = array.header;
  const std::string encoding = text_member(scale, "encoding");
  if (encoding == "raw") return;
  if (encoding != "compressed_segmentation") {
    bad_input(path, "encoding raw or compressed_segmentation", in_quotes(encoding));
  }
  if (array.type != SampleType::kUint32 && array.type != SampleType::kUint64) {
    bad_input(path, "data_type uint32 or uint64 for compressed_segmentation",
              std::string(sample_type_name(array.type)));
  }
  const std::array<std::int64_t, 3> block = triple(scale, "compressed_segmentation_block_size", 1, path);
  constexpr std::int64_t kMostInBlock = 4096;
  const auto [x, y, z] = block;
  if (x > kMostInBlock || y > kMostInBlock / x || z > kMostInBlock / (x * y)) {
    bad_input(path, "blocks of at most " + std::to_string(kMostInBlock) + " samples", "larger ones");
  }
  array.precomputed->segmentation_block = block;
}

SampleType type_of(const Json& info, const std::string& path) {
  const std::string name = text_member(info, "data_type");
  const std::optional<SampleType> type = parse_sample_type(name);
  if (!type) bad_input(path, "data_type of integers of 8 to 64 bits or floats of 32 bits", in_quotes(name));
  return *type;
}

const Json& chosen_scale(const Json& info, const OpenOptions& options, PrecomputedScale& found,
                         const std::string& path) {
  const Json* const scales = member(info, "scales");
  if (scales == nullptr || !scales->is_array() || scales->empty()) bad_input(path, "a list of scales", "none");
  const std::int64_t scale = options.level.value_or(0);
  if (scale < 0 || std::cmp_greater_equal(scale, scales->size())) {
    bad_input(path, "--level below " + std::to_string(scales->size()), std::to_string(scale));
  }
  found.scale = static_cast<std::size_t>(scale);
  found.scales = scales->size();
  return (*scales)[found.scale];
}

// Samples lie in the middle of their voxels.
AxisPlaces places_of(const Json& scale, const std::array<std::int64_t, 3>& offset, const std::string& path) {
  const std::optional<std::vector<double>> steps = numbers_of(member(scale, "resolution"));
  if (!steps || steps->size() != 3) bad_input(path, "three numbers as 'resolution'", "others");
  AxisPlaces places{{1}, {0}, {""}, {}};
  for (std::size_t a = 3; a-- > 0;) {
    places.step.push_back((*steps)[a]);
    places.begin.push_back((static_cast<double>(offset.at(a)) + 0.5) * (*steps)[a]);
    places.units.emplace_back("nm");
  }
  return places;
}

}  // namespace

PrecomputedScale precomputed_scale(const StorePtr& store, const std::string& folder, const Json& info,
                                   const OpenOptions& options) {
  PrecomputedScale found;
  ChunkedArray& array = found.array;
  array.store = store;
  array.header = folder + "/info";
  array.format = "precomputed";
  const std::string& path = array.header;
  const Json& scale = chosen_scale(info, options, found, path);
  array.folder = inside(folder, text_member(scale, "key"), path);
  array.type = type_of(info, path);
  const Json* const channels = member(info, "num_channels");
  const std::int64_t count = channels == nullptr ? 1 : integer_of(*channels).value_or(0);
  const std::array<std::int64_t, 3> size = triple(scale, "size", 1, path);
  const Json* const sizes = member(scale, "chunk_sizes");
  if (sizes == nullptr || !sizes->is_array() || sizes->empty()) bad_input(path, "a list of chunk_sizes", "none");
  const std::array<std::int64_t, 3> chunk = triple(Json{{"chunk_sizes", (*sizes)[0]}}, "chunk_sizes", 1, path);
  array.axes = {{count, "c"}, {size[2], "z"}, {size[1], "y"}, {size[0], "x"}};
  array.chunk = {count, chunk[2], chunk[1], chunk[0]};
  array.stored_order = {0, 1, 2, 3};
  array.precomputed.emplace();
  if (member(scale, "voxel_offset") != nullptr) {
    array.precomputed->offset = triple(scale, "voxel_offset", -kMostSamples, path);
  }
  take_encoding(array, scale);
  if (const Json* const sharding = member(scale, "sharding"); sharding != nullptr && !sharding->is_null()) {
    array.precomputed->shards = shards_of(*sharding, path);
    if (is_gzip(*sharding, "data_encoding", path)) array.codecs = {Codec::kDeflate};
  }
  found.places = places_of(scale, array.precomputed->offset, path);
  check_array(array);
  return found;
}

}  // namespace isoweave
