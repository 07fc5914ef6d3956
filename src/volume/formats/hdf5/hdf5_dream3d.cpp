// DREAM.3D, versions 6 and 7: arrays of cells beside the grid that they belong to.
#include "volume/formats/hdf5/hdf5_place.hpp"

namespace isoweave {
namespace {

constexpr const char* kContainers = "/DataContainers/";
constexpr const char* kGrid = "/_SIMPL_GEOMETRY/";
constexpr std::array<const char*, 4> kNames{"z", "y", "x", "channel"};

std::vector<double> three_in(const Hdf5File& file, const std::string& name) {
  std::optional<std::vector<double>> numbers = numbers_in(file, name);
  if (!numbers || numbers->size() != 3) return {};
  return std::move(*numbers);
}

// Whether an array has one entry, of one or more parts, for each cell of the grid.
bool is_of_cells(const std::vector<std::int64_t>& shape, const std::vector<double>& cells) {
  if (shape.size() < 3 || shape.size() > kNames.size() || cells.empty()) return false;
  for (std::size_t n = 0; n < 3; ++n) {
    if (static_cast<double>(shape[n]) != cells[2 - n]) return false;
  }
  return true;
}

}  // namespace

std::optional<Hdf5Place> dream3d_place(const Hdf5File& file, const std::string& named) {
  if (!named.starts_with(kContainers)) return std::nullopt;
  const std::string grid = folder_of_path(folder_of_path(named)) + kGrid;
  const std::vector<double> cells = three_in(file, grid + "DIMENSIONS");
  const Hdf5Handle array = open_object(file, named);
  if (!array) return std::nullopt;
  const std::vector<std::int64_t> shape = describe_dataset(file.session, array.id(), named).shape;
  if (!is_of_cells(shape, cells)) return std::nullopt;
  std::vector<double> spacing = three_in(file, grid + "SPACING");
  // Until version 6.4 the field had another name.
  if (spacing.empty()) spacing = three_in(file, grid + "RESOLUTION");
  const std::vector<double> origin = three_in(file, grid + "ORIGIN");
  Hdf5Place place;
  place.format = "DREAM.3D";
  place.dataset = named;
  place.axis_names.assign(kNames.begin(), kNames.begin() + static_cast<std::ptrdiff_t>(shape.size()));
  if (spacing.empty()) place.notes.emplace_back("the spacing of the grid is not given and taken as 1");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double step = spacing.empty() ? 1 : spacing[axis];
    place.axes.steps[axis][axis] = step;
    // The origin is the corner of the first cell, whose sample is in its middle.
    place.axes.origin[axis] = (origin.empty() ? 0 : origin[axis]) + step / 2;
  }
  return place;
}

}  // namespace isoweave
