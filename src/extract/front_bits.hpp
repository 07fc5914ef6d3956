// Where an extraction from the cubes of a lattice stands between two slabs. Processors and a device write and read the
// same: one goes on where the other was.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "files/state_file.hpp"

namespace isoweave {

struct FrontBits {
  std::int64_t next_layer = -1;  // which begins at this slice
  // Of the points of one or more padded slices, row by row, the last of which is that one: bit n of a row tells whether
  // sample n - 1 is inside.
  std::vector<std::uint64_t> inside;

  void write(StateWriter& state) const;

  // Throws BadInput where no extraction of a volume of such dims that keeps so many slices could stand there. Layers
  // end at `end_layer`.
  static FrontBits read(StateReader& state, const std::array<std::int64_t, 3>& dims, std::int64_t end_layer,
                        std::size_t slices = 1);
};

}  // namespace isoweave
