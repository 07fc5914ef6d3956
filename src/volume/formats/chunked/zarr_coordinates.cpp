// Attributes of arrays of Zarr and N5, and the coordinates that xarray keeps beside an array of Zarr.
#include <algorithm>
#include <utility>

#include "isoweave/error.hpp"
#include "volume/formats/chunked/zarr_node.hpp"
#include "volume/grid_coordinates.hpp"

namespace isoweave {
namespace {

// All samples of an array of one axis.
std::vector<double> numbers_in(const ChunkedArray& array) {
  AxisChoice choice;
  choice.at = {0};
  choice.axis[0] = choice.place[0] = 0;
  OpenedVolume volume = open_chunks(array, choice);
  const auto count = static_cast<std::uint64_t>(volume.info.dims[0]);
  return read_coordinates(*volume.samples, volume.info.type, volume.swap_bytes, count, array.header);
}

// The array that metadata describe; nothing for one of a type or codec that is not read.
std::optional<ChunkedArray> readable_array(const StorePtr& store, const ZarrNode& node) {
  try {
    return array_of(store, node);
  } catch (const BadInput&) {
    return std::nullopt;
  }
}

AxisCoordinates coordinates_at(const StorePtr& store, const std::string& group, const std::string& name) {
  if (name.empty() || name == ".." || name.find('/') != std::string::npos) return {};
  const std::optional<ZarrNode> node = open_node(*store, group + "/" + name);
  if (!node || !node->is_array || node->format == ZarrNode::Format::kN5) return {};
  const std::optional<ChunkedArray> array = readable_array(store, *node);
  if (array && array->axes.size() != 1) return {};
  const bool readable = array && array->axes[0].size > 0 && std::cmp_less_equal(array->axes[0].size, kMostCoordinates);
  return coordinates_of(name, readable ? numbers_in(*array) : std::vector<double>(), attributes_of(*node));
}

}  // namespace

ArrayAttributes attributes_of(const ZarrNode& node) {
  const bool turned = node.format == ZarrNode::Format::kN5;
  const auto numbers = [node, turned](const std::string& name) {
    const Json* value = member(node.attributes, name);
    if (value != nullptr && value->is_number()) return std::optional(std::vector{value->get<double>()});
    std::optional<std::vector<double>> list = numbers_of(value);
    if (list && turned) std::reverse(list->begin(), list->end());
    return list;
  };
  const auto texts = [node, turned](const std::string& name) {
    std::vector<std::string> list;
    const Json* value = member(node.attributes, name);
    if (value != nullptr && value->is_string()) list.push_back(value->get<std::string>());
    if (value != nullptr && value->is_array()) {
      for (const Json& entry : *value) list.push_back(entry.is_string() ? entry.get<std::string>() : std::string());
    }
    if (turned) std::reverse(list.begin(), list.end());
    return list;
  };
  const auto has = [node](const std::string& name) { return member(node.attributes, name) != nullptr; };
  return {numbers, texts, has};
}

std::vector<AxisCoordinates> zarr_coordinates(const StorePtr& store, const ZarrNode& node, const std::string& group,
                                              const std::vector<ArrayAxis>& axes) {
  std::vector<AxisCoordinates> coordinates(axes.size());
  if (node.format == ZarrNode::Format::kN5) return coordinates;
  for (std::size_t n = 0; n < axes.size(); ++n) coordinates[n] = coordinates_at(store, group, axes[n].name);
  return coordinates;
}

}  // namespace isoweave
