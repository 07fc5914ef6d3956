// Arrays of N5: attributes.json. Its axes begin with the fastest; here they are turned round.
#include <algorithm>
#include <numeric>

#include "files/input_file.hpp"
#include "files/quoted.hpp"
#include "volume/formats/chunked/zarr_node.hpp"

namespace isoweave {
namespace {

std::vector<Codec> codecs_of(const Json& metadata, const std::string& path) {
  const Json* compression = member(metadata, "compression");
  std::string name =
      compression == nullptr ? text_member(metadata, "compressionType") : text_member(*compression, "type");
  if (name == "raw") return {};
  if (name == "lz4") return {Codec::kLz4Frames};
  const std::optional<Codec> codec = zarr_codec(name);
  if (!codec || *codec == Codec::kCrc32c) {
    bad_input(path, "compression raw, gzip, zstd, blosc or lz4", in_quotes(name));
  }
  return {*codec};
}

}  // namespace

ChunkedArray n5_array(const ZarrNode& node) {
  const Json& metadata = node.metadata;
  const std::string& path = node.header;
  ChunkedArray array;
  array.folder = node.folder;
  array.header = path;
  array.format = "n5";
  for (const std::int64_t size : integers_member(metadata, "dimensions", path)) array.axes.push_back({size, {}});
  array.chunk = integers_member(metadata, "blockSize", path);
  name_axes(array.axes, member(metadata, "axes"));
  std::reverse(array.axes.begin(), array.axes.end());
  std::reverse(array.chunk.begin(), array.chunk.end());
  const std::string type = text_member(metadata, "dataType");
  const std::optional<SampleType> known = parse_sample_type(type);
  if (!known) {
    bad_input(path, "dataType of integers of 8 to 64 bits or floats of 32 or 64 bits",
              type.empty() ? "another kind" : in_quotes(type));
  }
  array.type = *known;
  array.big_endian = true;
  array.codecs = codecs_of(metadata, path);
  array.stored_order.resize(array.axes.size());
  std::iota(array.stored_order.begin(), array.stored_order.end(), std::size_t{0});
  array.separator = '/';
  array.reversed_keys = true;
  array.block_headers = true;
  return array;
}

}  // namespace isoweave
