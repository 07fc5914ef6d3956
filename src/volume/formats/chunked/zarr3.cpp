// Arrays of Zarr 3: zarr.json.
#include <algorithm>
#include <numeric>
#include <utility>

#include "files/input_file.hpp"
#include "files/quoted.hpp"
#include "volume/formats/chunked/zarr_node.hpp"

namespace isoweave {
namespace {

// A name alone, or an object of a name and its configuration.
struct Named {
  std::string name;
  Json configuration;
};

Named named(const Json* json) {
  if (json == nullptr) return {};
  if (json->is_string()) return {json->get<std::string>(), {}};
  const Json* configuration = member(*json, "configuration");
  return {text_member(*json, "name"), configuration == nullptr ? Json() : *configuration};
}

std::vector<Named> named_list(const Json* json, const std::string& what, const std::string& path) {
  if (json == nullptr || !json->is_array()) bad_input(path, "a list of " + what, "none");
  std::vector<Named> list;
  for (const Json& entry : *json) list.push_back(named(&entry));
  return list;
}

bool is_big_endian(const Named& bytes, const std::string& path) {
  const std::string endian = text_member(bytes.configuration, "endian");
  if (!endian.empty() && endian != "little" && endian != "big")
    bad_input(path, "endian little or big", in_quotes(endian));
  return endian == "big";
}

// Transpositions come first; each reorders the axes that the one before gave.
void transpose(ChunkedArray& array, const Named& codec) {
  const std::vector<std::int64_t> order = integers_member(codec.configuration, "order", array.header);
  std::vector<std::size_t> axes;
  for (const std::int64_t entry : order) {
    const bool known = entry >= 0 && std::cmp_less(entry, array.stored_order.size());
    if (known) axes.push_back(array.stored_order[static_cast<std::size_t>(entry)]);
  }
  std::vector<std::size_t> sorted = axes;
  std::sort(sorted.begin(), sorted.end());
  const bool repeated = std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
  if (axes.size() != array.stored_order.size() || repeated || order.size() != axes.size()) {
    bad_input(array.header, "an order of all axes for codec 'transpose'", "another");
  }
  array.stored_order = axes;
}

void take_shards(ChunkedArray& array, const Named& codec);

// Reads the chain from the samples to the bytes of a file, and turns it round.
void take_codecs(ChunkedArray& array, const std::vector<Named>& chain) {
  std::size_t n = 0;
  while (n < chain.size() && chain[n].name == "transpose") transpose(array, chain[n++]);
  if (n == chain.size()) bad_input(array.header, "codec 'bytes' or 'sharding_indexed'", "neither");
  if (chain[n].name == "sharding_indexed") {
    if (n > 0 || chain.size() > 1 || array.shards) {
      bad_input(array.header, "codec 'sharding_indexed' alone", "others beside or around it");
    }
    return take_shards(array, chain[n]);
  }
  if (chain[n].name != "bytes") {
    bad_input(array.header, "codec 'bytes' or 'sharding_indexed'", in_quotes(chain[n].name));
  }
  array.big_endian = is_big_endian(chain[n], array.header);
  for (++n; n < chain.size(); ++n) {
    const std::optional<Codec> codec = zarr_codec(chain[n].name);
    if (!codec) bad_input(array.header, "codec gzip, zlib, zstd, blosc, lz4 or crc32c", in_quotes(chain[n].name));
    array.codecs.insert(array.codecs.begin(), *codec);
  }
}

// The chunks of the array become shards of smaller chunks.
void take_shards(ChunkedArray& array, const Named& codec) {
  const std::string& path = array.header;
  const Json& configuration = codec.configuration;
  const std::vector<std::int64_t> inner = integers_member(configuration, "chunk_shape", path);
  Shards shards;
  if (inner.size() != array.chunk.size()) bad_input(path, "a chunk_shape of all axes in a shard", "another");
  for (std::size_t n = 0; n < inner.size(); ++n) {
    if (inner[n] < 1 || array.chunk[n] % inner[n] != 0) {
      bad_input(path, "shards of whole chunks",
                std::to_string(array.chunk[n]) + " samples in chunks of " + std::to_string(inner[n]));
    }
    shards.chunks.push_back(array.chunk[n] / inner[n]);
  }
  const std::string location = text_member(configuration, "index_location");
  if (!location.empty() && location != "start" && location != "end") {
    bad_input(path, "index_location start or end", in_quotes(location));
  }
  shards.index_at_end = location != "start";
  const std::vector<Named> index = named_list(member(configuration, "index_codecs"), "index_codecs", path);
  const bool plain = !index.empty() && index[0].name == "bytes" && !is_big_endian(index[0], path);
  shards.index_sum = index.size() == 2 && index[1].name == "crc32c";
  if (!plain || index.size() != (shards.index_sum ? 2 : 1)) {
    bad_input(path, "an index of a shard in codecs 'bytes' and 'crc32c'", "others");
  }
  array.shards = shards;
  array.chunk = inner;
  take_codecs(array, named_list(member(configuration, "codecs"), "codecs", path));
}

void take_keys(ChunkedArray& array, const Named& encoding) {
  const std::string separator = text_member(encoding.configuration, "separator");
  if (!separator.empty() && separator != "." && separator != "/") {
    bad_input(array.header, "separator '.' or '/'", in_quotes(separator));
  }
  if (encoding.name == "default") {
    array.separator = separator.empty() ? '/' : separator[0];
    array.key_prefix = std::string("c") + array.separator;
  } else if (encoding.name == "v2") {
    array.separator = separator.empty() ? '.' : separator[0];
  } else {
    bad_input(array.header, "chunk_key_encoding default or v2", in_quotes(encoding.name));
  }
}

}  // namespace

ChunkedArray zarr3_array(const ZarrNode& node) {
  const Json& metadata = node.metadata;
  const std::string& path = node.header;
  const Json* version = member(metadata, "zarr_format");
  if (version == nullptr || integer_of(*version) != 3) bad_input(path, "zarr_format 3", "another");
  const Json* transformers = member(metadata, "storage_transformers");
  if (transformers != nullptr && !transformers->empty()) bad_input(path, "no storage_transformers", "some");
  ChunkedArray array;
  array.folder = node.folder;
  array.header = path;
  array.format = "zarr";
  for (const std::int64_t size : integers_member(metadata, "shape", path)) array.axes.push_back({size, {}});
  const Named grid = named(member(metadata, "chunk_grid"));
  if (grid.name != "regular") bad_input(path, "chunk_grid regular", in_quotes(grid.name));
  array.chunk = integers_member(grid.configuration, "chunk_shape", path);
  const std::string type = text_member(metadata, "data_type");
  const std::optional<StoredType> known = parse_stored_type(type == "bool" ? "uint8" : type);
  if (!known) {
    bad_input(path, "data_type of integers of 8 to 64 bits or floats of 16 to 64 bits",
              type.empty() ? "another kind" : in_quotes(type));
  }
  array.type = known->type;
  array.is_half = known->is_half;
  array.stored_order.resize(array.axes.size());
  std::iota(array.stored_order.begin(), array.stored_order.end(), std::size_t{0});
  take_keys(array, named(member(metadata, "chunk_key_encoding")));
  take_codecs(array, named_list(member(metadata, "codecs"), "codecs", path));
  array.fill = fill_sample(member(metadata, "fill_value"), *known, array.big_endian, path);
  name_axes(array.axes, member(metadata, "dimension_names"));
  return array;
}

}  // namespace isoweave
