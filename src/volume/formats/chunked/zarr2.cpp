// Arrays of Zarr 2: .zarray.
#include <array>
#include <numeric>
#include <string_view>
#include <tuple>
#include <utility>

#include "files/input_file.hpp"
#include "files/quoted.hpp"
#include "volume/formats/chunked/zarr_node.hpp"

namespace isoweave {
namespace {

// "<i2": byte order, kind and bytes. Tells as well whether the most significant byte comes first.
std::pair<StoredType, bool> stored_type_of(const Json& metadata, const std::string& path) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kTypes{{{"b1", "uint8"},
                                                                                         {"u1", "uint8"},
                                                                                         {"i1", "int8"},
                                                                                         {"u2", "uint16"},
                                                                                         {"i2", "int16"},
                                                                                         {"u4", "uint32"},
                                                                                         {"i4", "int32"},
                                                                                         {"u8", "uint64"},
                                                                                         {"i8", "int64"},
                                                                                         {"f2", "float16"},
                                                                                         {"f4", "float32"},
                                                                                         {"f8", "float64"}}};
  const std::string text = text_member(metadata, "dtype");
  const std::string_view name = std::string_view(text).substr(text.empty() ? 0 : 1);
  for (const auto& [known, type] : kTypes) {
    if (known == name && std::string_view("<>|").find(text[0]) != std::string_view::npos) {
      return {parse_stored_type(type).value(), text[0] == '>'};
    }
  }
  bad_input(path, "a dtype of integers of 8 to 64 bits or floats of 16 to 64 bits",
            text.empty() ? "a structure or none" : in_quotes(text));
}

std::vector<Codec> zarr2_codecs(const Json& metadata, const std::string& path) {
  const Json* filters = member(metadata, "filters");
  if (filters != nullptr && filters->is_array() && !filters->empty()) {
    bad_input(path, "an array without filters", "filter " + in_quotes(text_member((*filters)[0], "id")));
  }
  const Json* compressor = member(metadata, "compressor");
  if (compressor == nullptr || compressor->is_null()) return {};
  const std::string name = text_member(*compressor, "id");
  const std::optional<Codec> codec = zarr_codec(name);
  if (!codec) bad_input(path, "compressor gzip, zlib, zstd, blosc or lz4", in_quotes(name));
  return {*codec};
}

}  // namespace

ChunkedArray zarr2_array(const ZarrNode& node) {
  const Json& metadata = node.metadata;
  const std::string& path = node.header;
  const Json* version = member(metadata, "zarr_format");
  if (version == nullptr || integer_of(*version) != 2) bad_input(path, "zarr_format 2", "another");
  ChunkedArray array;
  array.folder = node.folder;
  array.header = path;
  array.format = "zarr";
  for (const std::int64_t size : integers_member(metadata, "shape", path)) array.axes.push_back({size, {}});
  array.chunk = integers_member(metadata, "chunks", path);
  StoredType stored;
  std::tie(stored, array.big_endian) = stored_type_of(metadata, path);
  array.type = stored.type;
  array.is_half = stored.is_half;
  array.codecs = zarr2_codecs(metadata, path);
  array.fill = fill_sample(member(metadata, "fill_value"), stored, array.big_endian, path);
  array.stored_order.resize(array.axes.size());
  const std::string order = text_member(metadata, "order");
  if (order == "F") {
    std::iota(array.stored_order.rbegin(), array.stored_order.rend(), std::size_t{0});
  } else if (order == "C") {
    std::iota(array.stored_order.begin(), array.stored_order.end(), std::size_t{0});
  } else {
    bad_input(path, "order C or F", in_quotes(order));
  }
  const std::string separator = text_member(metadata, "dimension_separator");
  if (!separator.empty() && separator != "." && separator != "/") {
    bad_input(path, "dimension_separator '.' or '/'", in_quotes(separator));
  }
  array.separator = separator.empty() ? '.' : separator[0];
  name_axes(array.axes, member(node.attributes, "_ARRAY_DIMENSIONS"));
  return array;
}

}  // namespace isoweave
