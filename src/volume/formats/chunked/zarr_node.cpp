#include "volume/formats/chunked/zarr_node.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "files/input_file.hpp"
#include "files/quoted.hpp"
#include "volume/samples.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {
namespace {

namespace fs = std::filesystem;

// A field that Zarr 3 does not define may change what the others mean, unless its own words say otherwise.
void check_zarr3_fields(const Json& metadata, bool is_array, const std::string& header) {
  static constexpr std::array<std::string_view, 12> kFields{
      "zarr_format", "node_type", "attributes",      "consolidated_metadata",
      "shape",       "data_type", "chunk_grid",      "chunk_key_encoding",
      "fill_value",  "codecs",    "dimension_names", "storage_transformers"};
  constexpr std::size_t kOfGroups = 4;
  const auto known = std::span(kFields).first(is_array ? kFields.size() : kOfGroups);
  for (const auto& [name, value] : metadata.items()) {
    const Json* needed = member(value, "must_understand");
    const bool optional = needed != nullptr && needed->is_boolean() && !needed->get<bool>();
    if (optional || std::find(known.begin(), known.end(), name) != known.end()) continue;
    bad_input(header, "fields of Zarr 3, or others with must_understand false in them", in_quotes(name));
  }
}

ZarrNode zarr3_node(const std::string& folder, const std::string& header, Json metadata) {
  ZarrNode node{ZarrNode::Format::kZarr3, false, folder, header, std::move(metadata), {}};
  const std::string type = text_member(node.metadata, "node_type");
  if (type != "array" && type != "group") bad_input(header, "node_type array or group", in_quotes(type));
  node.is_array = type == "array";
  check_zarr3_fields(node.metadata, node.is_array, header);
  if (const Json* attributes = member(node.metadata, "attributes")) node.attributes = *attributes;
  return node;
}

[[noreturn]] void refuse_fill(const Json& value, const StoredType& type, const std::string& path) {
  const std::string text = value.is_string() ? value.get<std::string>() : std::string(value.type_name());
  bad_input(path, "a fill value of " + std::string(stored_type_name(type)), in_quotes(text));
}

// "0x7fc00000": the bits of a sample.
template <class Sample>
std::optional<Sample> sample_of_bits(std::string_view text) {
  std::uint64_t bits = 0;
  if (!text.starts_with("0x") || text.size() != 2 + 2 * sizeof(Sample)) return std::nullopt;
  const auto [end, error] = std::from_chars(text.data() + 2, text.data() + text.size(), bits, 16);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  Sample sample{};
  if constexpr (std::endian::native == std::endian::big) bits <<= 8 * (sizeof bits - sizeof sample);
  std::memcpy(&sample, &bits, sizeof sample);
  return sample;
}

template <class Sample, class Number>
std::optional<Sample> checked(Number number) {
  return std::in_range<Sample>(number) ? std::optional(static_cast<Sample>(number)) : std::nullopt;
}

constexpr double kLargestWhole = 0x1p53;  // whole numbers up to it are all doubles

template <class Sample>
std::optional<Sample> sample_of(const Json& value) {
  using Limits = std::numeric_limits<Sample>;
  if (value.is_boolean()) return static_cast<Sample>(value.get<bool>() ? 1 : 0);
  if (value.is_string()) {
    const std::string text = value.get<std::string>();
    if constexpr (Limits::has_quiet_NaN) {
      if (text == "NaN") return Limits::quiet_NaN();
      if (text == "Infinity") return Limits::infinity();
      if (text == "-Infinity") return -Limits::infinity();
    }
    return sample_of_bits<Sample>(text);
  }
  if (!value.is_number()) return std::nullopt;
  if constexpr (Limits::is_integer) {
    if (value.is_number_unsigned()) return checked<Sample>(value.get<std::uint64_t>());
    if (value.is_number_integer()) return checked<Sample>(value.get<std::int64_t>());
  }
  const auto number = value.get<double>();
  if constexpr (Limits::is_integer) {
    if (std::abs(number) > kLargestWhole || number != std::floor(number)) return std::nullopt;
    return checked<Sample>(static_cast<std::int64_t>(number));
  } else if (std::isfinite(number) && std::abs(number) > static_cast<double>(Limits::max())) {
    return std::nullopt;
  }
  return static_cast<Sample>(number);
}

// The bits of a half, given as they are or as a number.
std::optional<std::uint16_t> half_in(const Json& value) {
  const std::string text = value.is_string() ? value.get<std::string>() : std::string();
  if (text.starts_with("0x")) return sample_of_bits<std::uint16_t>(text);
  const std::optional<float> number = sample_of<float>(value);
  return number ? half_of(*number) : std::nullopt;
}

}  // namespace

std::optional<ZarrNode> open_node(ObjectStore& store, const std::string& folder) {
  const std::string zarr3 = folder + "/zarr.json", n5 = folder + "/attributes.json";
  const std::string array = folder + "/.zarray", group = folder + "/.zgroup", attributes = folder + "/.zattrs";
  std::vector<ObjectPart> names;
  for (const std::string& name : {zarr3, array, attributes, group, n5}) names.push_back(json_object(name));
  store.expect(names);
  if (std::optional<Json> json = look_for_json(store, zarr3)) return zarr3_node(folder, zarr3, std::move(*json));
  std::optional<Json> of_array = look_for_json(store, array), of_user = look_for_json(store, attributes);
  if (of_array || of_user) {
    const bool is_array = of_array.has_value();
    ZarrNode node{ZarrNode::Format::kZarr2, is_array, folder, is_array ? array : attributes, {}, {}};
    if (of_user) node.attributes = *of_user;
    node.metadata = std::move(is_array ? *of_array : *of_user);
    return node;
  }
  if (std::optional<Json> json = look_for_json(store, group)) {
    return ZarrNode{ZarrNode::Format::kZarr2, false, folder, group, std::move(*json), {}};
  }
  std::optional<Json> json = look_for_json(store, n5);
  if (!json) return std::nullopt;
  ZarrNode node{ZarrNode::Format::kN5, false, folder, n5, std::move(*json), {}};
  node.is_array = member(node.metadata, "dimensions") != nullptr && member(node.metadata, "dataType") != nullptr;
  node.attributes = node.metadata;
  return node;
}

ChunkedArray array_of(const StorePtr& store, const ZarrNode& node) {
  ChunkedArray array;
  switch (node.format) {
    case ZarrNode::Format::kZarr2:
      array = zarr2_array(node);
      break;
    case ZarrNode::Format::kZarr3:
      array = zarr3_array(node);
      break;
    case ZarrNode::Format::kN5:
      array = n5_array(node);
      break;
  }
  array.store = store;
  check_array(array);
  return array;
}

std::array<std::byte, 8> fill_sample(const Json* value, const StoredType& type, bool big_endian,
                                     const std::string& path) {
  std::array<std::byte, 8> bytes{};
  if (value == nullptr || value->is_null()) return bytes;
  visit_sample_type(type.type, [&]<class Sample>() {
    std::optional<Sample> sample;
    if constexpr (std::is_same_v<Sample, std::uint16_t>) {
      sample = type.is_half ? half_in(*value) : sample_of<Sample>(*value);
    } else {
      sample = sample_of<Sample>(*value);
    }
    if (!sample) refuse_fill(*value, type, path);
    std::memcpy(bytes.data(), &*sample, sizeof(Sample));
    const bool swap = big_endian != (std::endian::native == std::endian::big);
    if (swap) swap_sample_bytes(std::span(bytes).first(sizeof(Sample)), sizeof(Sample));
  });
  return bytes;
}

void name_axes(std::vector<ArrayAxis>& axes, const Json* names) {
  if (names == nullptr || !names->is_array() || names->size() != axes.size()) return;
  for (std::size_t n = 0; n < axes.size(); ++n) {
    const Json& name = (*names)[n];
    axes[n].name = name.is_string() ? name.get<std::string>() : std::string();
  }
}

std::string inside(const std::string& folder, const std::string& name, const std::string& path) {
  const fs::path relative(name);
  const bool leads_out =
      std::any_of(relative.begin(), relative.end(), [](const fs::path& part) { return part == ".."; });
  if (relative.is_absolute() || leads_out) bad_input(path, "a path inside the folder", in_quotes(name));
  return name.empty() ? folder : folder + "/" + name;
}

}  // namespace isoweave
