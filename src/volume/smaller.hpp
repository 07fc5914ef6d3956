// Where a smaller volume lies.
#pragma once

#include <array>
#include <cstdint>

#include "isoweave/volume.hpp"

namespace isoweave {

// Moves the origin to the place of sample `at`, or to a place between samples.
void move_origin(Geometry& geometry, const std::array<double, 3>& at);

// The volume with one sample in the middle of each block of step x step x step samples; blocks at the upper ends may be
// cut off. Throws std::invalid_argument for a step below 1.
VolumeInfo smaller_info(const VolumeInfo& volume, std::int64_t step);

// The samples of the whole in the blocks of a box of samples of the smaller volume.
Region blocks_in_whole(Region samples, const VolumeInfo& whole, std::int64_t step);

}  // namespace isoweave
