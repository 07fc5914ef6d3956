// How much of a closed surface lies on the border of the volume.
#pragma once

#include <cstddef>
#include <cstdint>

#include "extract/cube_rules.hpp"
#include "isoweave/volume.hpp"

namespace isoweave {

// The samples of slice k that are inside and lie in a face of the volume, each counted once for every such face. A cap
// crosses about one cell for each.
std::uint64_t count_cap_samples(const std::byte* slice, std::int64_t k, const VolumeInfo& volume, const IsoRule& rule);

}  // namespace isoweave
