// VTKHDF image data: arrays of points beside the extent, origin, spacing and direction of the grid.
#include "volume/formats/hdf5/hdf5_place.hpp"

namespace isoweave {
namespace {

constexpr const char* kRoot = "/VTKHDF";
constexpr const char* kPoints = "/VTKHDF/PointData/";

// Numbers of an attribute, or those that stand for it.
std::vector<double> numbers_or(const ArrayAttributes& attributes, const std::string& name,
                               std::vector<double> otherwise) {
  std::optional<std::vector<double>> numbers = attributes.numbers(name);
  return numbers && numbers->size() == otherwise.size() ? std::move(*numbers) : std::move(otherwise);
}

}  // namespace

std::optional<Hdf5Place> vtkhdf_place(const Hdf5File& file, const std::string& named) {
  if (!named.starts_with(kPoints)) return std::nullopt;
  const Hdf5Handle root = open_object(file, kRoot);
  const Hdf5Handle array = open_object(file, named);
  if (!root || !array) return std::nullopt;
  const ArrayAttributes attributes = hdf5_attributes(file.session, root.id());
  const std::size_t rank = describe_dataset(file.session, array.id(), named).shape.size();
  if (text_in(attributes, "Type") != "ImageData" || rank < 3 || rank > 4) return std::nullopt;
  Hdf5Place place;
  place.format = "VTKHDF";
  place.dataset = named;
  place.axis_names = {"z", "y", "x"};
  if (rank == 4) place.axis_names.emplace_back("channel");
  const std::vector<double> extent = numbers_or(attributes, "WholeExtent", {0, 0, 0, 0, 0, 0});
  const std::vector<double> spacing = numbers_or(attributes, "Spacing", {1, 1, 1});
  const std::vector<double> origin = numbers_or(attributes, "Origin", {0, 0, 0});
  const std::vector<double> direction = numbers_or(attributes, "Direction", {1, 0, 0, 0, 1, 0, 0, 0, 1});
  for (std::size_t row = 0; row < 3; ++row) {
    place.axes.origin[row] = origin[row];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      place.axes.steps[axis][row] = direction[3 * row + axis] * spacing[axis];
      // The origin is that of index 0, which the extent need not begin with.
      place.axes.origin[row] += place.axes.steps[axis][row] * extent[2 * axis];
    }
  }
  return place;
}

}  // namespace isoweave
