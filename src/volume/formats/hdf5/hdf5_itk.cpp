// ITK's images in HDF5: a group with the samples, the origin, the spacing, and a direction for each axis.
#include "files/quoted.hpp"
#include "volume/formats/hdf5/hdf5_place.hpp"

namespace isoweave {
namespace {

constexpr const char* kImages = "/ITKImage";
constexpr const char* kSamples = "VoxelData";

// Numbers of a dataset of the image, `count` of them; 0: any number. Throws BadInput for any other.
std::vector<double> numbers_of(const Hdf5File& file, const std::string& name, std::size_t count) {
  std::optional<std::vector<double>> numbers = numbers_in(file, name);
  const bool right = numbers && (count == 0 ? !numbers->empty() : numbers->size() == count);
  if (!right) {
    bad_input(file.path, (count == 0 ? "numbers" : std::to_string(count) + " numbers") + " in " + in_quotes(name),
              numbers ? std::to_string(numbers->size()) : "none");
  }
  return std::move(*numbers);
}

// The names of the axes, from the slowest axis of the samples to the fastest. The parts of a sample lie together.
std::vector<std::string> names_of(std::size_t dimensions, std::size_t rank) {
  std::vector<std::string> names{"x", "y", "z", "time"};
  names.resize(dimensions, "");
  std::vector<std::string> turned(names.rbegin(), names.rend());
  if (rank > dimensions) turned.emplace_back("channel");
  return turned;
}

}  // namespace

std::optional<Hdf5Place> itk_place(const Hdf5File& file, const std::string& named) {
  if (!named.empty() && (!named.starts_with(kImages) || step_of_path(named, 0) != kSamples)) return std::nullopt;
  const std::string image = named.empty() ? std::string(kImages) + "/0" : folder_of_path(named);
  const Hdf5Handle samples = open_object(file, image + "/" + kSamples);
  if (!samples) return std::nullopt;
  Hdf5Place place;
  place.format = "ITK";
  place.dataset = image + "/" + kSamples;
  const std::vector<double> spacing = numbers_of(file, image + "/Spacing", 0);
  const std::size_t dimensions = spacing.size();
  const std::vector<double> origin = numbers_of(file, image + "/Origin", dimensions);
  const std::vector<double> directions = numbers_of(file, image + "/Directions", dimensions * dimensions);
  const std::size_t rank = describe_dataset(file.session, samples.id(), place.dataset).shape.size();
  place.axis_names = names_of(dimensions, rank);
  for (std::size_t axis = 0; axis < std::min<std::size_t>(dimensions, 3); ++axis) {
    place.axes.steps[axis] = {0, 0, 0};
    for (std::size_t row = 0; row < std::min<std::size_t>(dimensions, 3); ++row) {
      // The direction of an axis is a row of the file.
      place.axes.steps[axis][row] = directions[axis * dimensions + row] * spacing[axis];
    }
    place.axes.origin[axis] = origin[axis];
  }
  place.space = Space::kLps;
  return place;
}

}  // namespace isoweave
