#include "volume/smaller.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace isoweave {

void move_origin(Geometry& geometry, const std::array<double, 3>& at) {
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      geometry.origin[row] += geometry.direction[3 * row + axis] * (geometry.spacing[axis] * at[axis]);
    }
  }
}

VolumeInfo smaller_info(const VolumeInfo& volume, std::int64_t step) {
  if (step < 1) throw std::invalid_argument("step: expected at least 1, found " + std::to_string(step));
  VolumeInfo smaller = volume;
  const double middle = static_cast<double>(step - 1) / 2;
  move_origin(smaller.geometry, {middle, middle, middle});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    smaller.dims[axis] = (smaller.dims[axis] - 1) / step + 1;
    smaller.geometry.spacing[axis] *= static_cast<double>(step);
  }
  return smaller;
}

Region blocks_in_whole(Region samples, const VolumeInfo& whole, std::int64_t step) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    samples.first[axis] *= step;
    samples.end[axis] = std::min(samples.end[axis] * step, whole.dims[axis]);
  }
  return samples;
}

}  // namespace isoweave
