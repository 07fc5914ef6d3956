// MINC 2: one image, its dimensions with starts, steps and directions, and the range of values that samples stand for.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "files/header_text.hpp"
#include "files/quoted.hpp"
#include "volume/formats/hdf5/hdf5_place.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

constexpr const char* kMincImage = "/minc-2.0/image/0/image";
constexpr const char* kRange = "/minc-2.0/image/0/image-";
constexpr const char* kDimensions = "/minc-2.0/dimensions/";

struct SpatialName {
  const char* minc;
  const char* ours;
};
constexpr std::array<SpatialName, 3> kSpatial{{{"xspace", "x"}, {"yspace", "y"}, {"zspace", "z"}}};

std::string our_name(std::string_view name) {
  for (const SpatialName& entry : kSpatial) {
    if (name == entry.minc) return entry.ours;
  }
  return name == "vector_dimension" ? "channel" : std::string(name);
}

std::vector<std::string> names_of(std::string_view order) {
  std::vector<std::string> names;
  while (!order.empty()) {
    const std::size_t comma = std::min(order.find(','), order.size());
    names.push_back(our_name(trimmed(order.substr(0, comma))));
    order.remove_prefix(std::min(comma + 1, order.size()));
  }
  return names;
}

double number_or(const ArrayAttributes& attributes, const std::string& name, double otherwise) {
  const auto numbers = attributes.numbers(name);
  return numbers && numbers->size() == 1 ? numbers->front() : otherwise;
}

// position = sum over the axes of (start + index * step) * direction.
void take_dimension(Hdf5Place& place, const Hdf5File& file, std::size_t axis) {
  const std::string name = std::string(kDimensions) + kSpatial[axis].minc;
  const Hdf5Handle dimension = open_object(file, name);
  if (!dimension) bad_input(file.path, "a dimension " + in_quotes(name), "none");
  const ArrayAttributes attributes = hdf5_attributes(file.session, dimension.id());
  if (text_in(attributes, "spacing").starts_with("irregular")) {
    bad_input(file.path, "samples at one distance along " + in_quotes(name), "an irregular spacing");
  }
  if (!attributes.numbers("step")) {
    place.notes.push_back("the spacing of axis " + std::to_string(axis) + " is not given and taken as 1");
  }
  Vector3 direction{0, 0, 0};
  direction[axis] = 1;
  const auto cosines = attributes.numbers("direction_cosines");
  if (cosines && cosines->size() == 3) std::copy(cosines->begin(), cosines->end(), direction.begin());
  const double step = number_or(attributes, "step", 1), start = number_or(attributes, "start", 0);
  for (std::size_t row = 0; row < 3; ++row) {
    place.axes.steps[axis][row] = direction[row] * step;
    place.axes.origin[row] += direction[row] * start;
  }
  place.units[axis] = text_in(attributes, "units");
}

// Directions may lie across the axes of the world, which then have no units of their own.
void check_units(const Hdf5Place& place, const std::string& path) {
  std::string known;
  for (const std::string& unit : place.units) {
    if (known.empty()) known = unit;
    if (unit == known || unit.empty()) continue;
    bad_input(path, "one unit for all dimensions", in_quotes(known) + " and " + in_quotes(unit));
  }
}

// The least and the largest stored sample that stand for a value.
std::pair<double, double> valid_range(const ArrayAttributes& image, SampleType type) {
  const auto range = image.numbers("valid_range");
  if (range && range->size() == 2 && (*range)[0] != (*range)[1]) {
    return {std::min((*range)[0], (*range)[1]), std::max((*range)[0], (*range)[1])};
  }
  return visit_sample_type(type, []<class Sample>() {
    return std::pair(static_cast<double>(std::numeric_limits<Sample>::lowest()),
                     static_cast<double>(std::numeric_limits<Sample>::max()));
  });
}

// The values of image-min or image-max: one, or one for each index along the first axes of the image.
std::vector<double> values_in(const Hdf5File& file, const std::string& name) {
  std::optional<std::vector<double>> values = numbers_in(file, kRange + name);
  return values ? std::move(*values) : std::vector<double>();
}

// How many of the first axes have so many indices in all. Throws BadInput where none have.
std::size_t axes_of_range(const std::vector<std::int64_t>& shape, std::size_t values, const std::string& path) {
  std::uint64_t indices = 1;
  for (std::size_t n = 0; n < shape.size(); ++n) {
    if (indices == values) return n;
    if (__builtin_mul_overflow(indices, static_cast<std::uint64_t>(shape[n]), &indices)) break;
  }
  bad_input(path, "image-min and image-max for each index along the first axes of the image",
            std::to_string(values) + " values");
}

void take_scaling(Hdf5Place& place, const Hdf5File& file, const ArrayAttributes& image, const Hdf5Dataset& dataset) {
  const bool is_real = !dataset.type || dataset.type->is_half || dataset.type->type == SampleType::kFloat32 ||
                       dataset.type->type == SampleType::kFloat64;
  if (is_real) return;
  const std::vector<double> least = values_in(file, "min"), most = values_in(file, "max");
  const bool empty =
      least == most && std::adjacent_find(least.begin(), least.end(), std::not_equal_to<>()) == least.end();
  if (least.empty() || most.empty() || empty) {
    place.notes.emplace_back("image-min and image-max give no range of values, and samples are read as stored");
    return;
  }
  if (least.size() != most.size()) {
    bad_input(file.path, std::to_string(least.size()) + " values in image-max as in image-min",
              std::to_string(most.size()));
  }
  place.scaled_axes = axes_of_range(dataset.shape, least.size(), file.path);
  const auto [low, high] = valid_range(image, dataset.type->type);
  const double largest_sample = std::ldexp(1.0, 8 * static_cast<int>(sample_bytes(dataset.type->type)));
  for (std::size_t n = 0; n < least.size(); ++n) {
    place.slope.push_back((most[n] - least[n]) / (high - low));
    place.intercept.push_back(least[n] - low * place.slope.back());
    const double largest = std::abs(place.slope.back()) * largest_sample + std::abs(place.intercept.back());
    if (!(largest <= static_cast<double>(std::numeric_limits<float>::max()))) {
      bad_input(file.path, "values that fit in float32 by image-min and image-max",
                rounded_text(least[n]) + " to " + rounded_text(most[n]));
    }
  }
}

}  // namespace

std::optional<Hdf5Place> minc_place(const Hdf5File& file, const std::string& named) {
  if (!named.empty() && named != kMincImage) return std::nullopt;
  const Hdf5Handle image = open_object(file, kMincImage);
  if (!image) return std::nullopt;
  Hdf5Place place;
  place.format = "MINC";
  place.has_values = true;
  place.dataset = kMincImage;
  place.space = Space::kRas;
  const Hdf5Dataset dataset = describe_dataset(file.session, image.id(), kMincImage);
  const ArrayAttributes attributes = hdf5_attributes(file.session, image.id());
  place.axis_names = names_of(text_in(attributes, "dimorder"));
  if (place.axis_names.size() != dataset.shape.size()) {
    bad_input(file.path, std::to_string(dataset.shape.size()) + " names of axes in dimorder",
              in_quotes(text_in(attributes, "dimorder")));
  }
  for (std::size_t axis = 0; axis < kSpatial.size(); ++axis) {
    const auto& names = place.axis_names;
    if (std::find(names.begin(), names.end(), kSpatial[axis].ours) != names.end()) take_dimension(place, file, axis);
  }
  check_units(place, file.path);
  take_scaling(place, file, attributes, dataset);
  return place;
}

}  // namespace isoweave
