// The owners of tasks: which rank works on which block.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/parts/block_mesh.hpp"

namespace isoweave {

// The work that a block of the first stage is expected to be, by four of its slices.
std::uint64_t block_weight(const VolumeOpener& open, const CellBox& cells, const Task& task);

// The rank of each task. Blocks of a stage are cut into one piece for each rank along the curve of Morton (1966), by
// the work that is expected in their cells. weights: of the tasks of the first stage.
std::vector<std::uint32_t> plan_ranks(const BlockStages& stages, const std::vector<std::uint64_t>& weights, int ranks);

}  // namespace isoweave
