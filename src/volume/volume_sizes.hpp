// Sizes of volumes and ranges of slices, checked.
#pragma once

#include <cstddef>
#include <cstdint>

#include "isoweave/volume.hpp"

namespace isoweave {

// Throws std::invalid_argument unless [first, first + count) lies in the volume, not before `next`, and fits `out`.
void check_slice_range(const VolumeInfo& info, std::int64_t next, std::int64_t first, std::int64_t count,
                       std::size_t out_bytes);

// Size of the volume in bytes. Throws BadInput unless each dimension is at least 1 and the size fits in 63 bits.
std::uint64_t checked_volume_bytes(const VolumeInfo& info);

}  // namespace isoweave
