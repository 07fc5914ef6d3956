#include "pipeline/ranks/rank_plan.hpp"

#include <algorithm>
#include <bit>
#include <memory>
#include <numeric>
#include <span>

#include "extract/classify.hpp"
#include "isoweave/ranks.hpp"
#include "volume/row_source.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kSlices = 4;                 // of a block that are looked at
constexpr std::uint64_t kCellsPerTriangle = 128;    // that take as long to read and to classify as one triangle
constexpr std::uint64_t kTrianglesPerCrossing = 6;  // along one axis

// The samples that lie at the corners of cells.
Region samples_of(const CellBox& cells, const std::array<std::int64_t, 3>& dims) {
  Region region;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    region.first[axis] = std::clamp<std::int64_t>(cells.first[axis], 0, dims[axis] - 1);
    region.end[axis] = std::clamp<std::int64_t>(cells.end[axis] + 1, region.first[axis] + 1, dims[axis]);
  }
  return region;
}

// The places along a row where the surface crosses it. Bits: whether samples are inside.
std::uint64_t count_changes(std::span<const std::uint64_t> bits) {
  std::uint64_t changes = 0;
  for (std::size_t n = 0; n < bits.size(); ++n) {
    const std::uint64_t next = n + 1 < bits.size() ? bits[n + 1] : 0;
    changes += static_cast<std::uint64_t>(std::popcount(bits[n] ^ (bits[n] >> 1 | next << 63)));
  }
  return changes;
}

// The index of a block with the bits of its three numbers interleaved.
std::uint64_t morton(const BlockIndex& block, const BlockIndex& first) {
  std::uint64_t code = 0;
  for (unsigned bit = 0; bit < 21; ++bit) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      code |= (static_cast<std::uint64_t>(block[axis] - first[axis]) >> bit & 1U) << (3 * bit + axis);
    }
  }
  return code;
}

std::int64_t cells_in(const CellBox& box) {
  std::int64_t cells = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) cells *= std::max<std::int64_t>(box.end[axis] - box.first[axis], 0);
  return cells;
}

CellBox common(const CellBox& a, const CellBox& b) {
  CellBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.first[axis] = std::max(a.first[axis], b.first[axis]);
    box.end[axis] = std::min(a.end[axis], b.end[axis]);
  }
  return box;
}

class Planner {
 public:
  Planner(const BlockStages& stages, const std::vector<std::uint64_t>& weights, int ranks)
      : stages_(stages), tasks_(stages.tasks()), weights_(weights), ranks_(static_cast<double>(ranks)) {
    owners_.resize(to_size(tasks_.count()));
  }

  std::vector<std::uint32_t> run() {
    for (std::size_t stage = 0; stage < tasks_.stages.size(); ++stage) cut(stage);
    return std::move(owners_);
  }

 private:
  void cut(std::size_t stage) {
    std::vector<double> weights(to_size(tasks_.stages[stage]));
    std::vector<std::pair<std::uint64_t, std::size_t>> curve;
    for (std::size_t n = 0; n < weights.size(); ++n) {
      weights[n] = weight(stage, n);
      curve.emplace_back(morton(stages_.block(stage, n), stages_.first_block(stage)), n);
    }
    std::sort(curve.begin(), curve.end());
    const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
    double before = 0;
    for (const auto& [code, n] : curve) {
      const double middle = before + weights[n] / 2;
      owners_[to_size(tasks_.first_of(stage)) + n] =
          static_cast<std::uint32_t>(std::min(ranks_ - 1, middle / all * ranks_));
      before += weights[n];
    }
  }

  // The weight of a task: its share of the blocks of the first stage.
  double weight(std::size_t stage, std::size_t number) const {
    if (stage == 0) return static_cast<double>(weights_[number]);
    const CellBox cells = stages_.grids[stage].cells(stages_.block(stage, number), stages_.all);
    if (cells.empty()) return 1;
    BlockRange range;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      range.first[axis] = stages_.grids[0].block_of(axis, cells.first[axis]);
      range.last[axis] = stages_.grids[0].block_of(axis, cells.end[axis] - 1);
    }
    double sum = 1;
    for (std::int64_t z = range.first[2]; z <= range.last[2]; ++z) {
      for (std::int64_t y = range.first[1]; y <= range.last[1]; ++y) {
        for (std::int64_t x = range.first[0]; x <= range.last[0]; ++x) sum += share({x, y, z}, cells);
      }
    }
    return sum;
  }

  double share(const BlockIndex& block, const CellBox& cells) const {
    const CellBox own = stages_.grids[0].cells(block, stages_.all);
    return static_cast<double>(weights_[to_size(stages_.number(0, block))]) *
           static_cast<double>(cells_in(common(own, cells))) / static_cast<double>(cells_in(own));
  }

  const BlockStages& stages_;
  const TaskList tasks_;
  const std::vector<std::uint64_t>& weights_;
  const double ranks_;
  std::vector<std::uint32_t> owners_;
};

}  // namespace

std::int64_t block_size_for_ranks(const VolumeInfo& volume, int ranks) {
  constexpr std::int64_t kLeast = 64;
  constexpr std::int64_t kBlocksOfRank = 4;
  for (std::int64_t size = 512; size > kLeast; size /= 2) {
    std::int64_t blocks = 1;
    for (const std::int64_t samples : volume.dims) blocks *= (samples + size - 1) / size;
    if (blocks >= kBlocksOfRank * ranks) return size;
  }
  return kLeast;
}

std::uint64_t block_weight(const VolumeOpener& open, const CellBox& cells, const Task& task) {
  const auto part = crop_volume(open(), samples_of(cells, task.volume.dims));
  const auto cells_work = static_cast<std::uint64_t>(cells_in(cells)) / kCellsPerTriangle + 1;
  if (constant_sample(*part)) return cells_work;
  const VolumeInfo& info = part->info();
  RowReader rows(*part);
  std::vector<std::byte> row(to_size(static_cast<std::uint64_t>(info.dims[0])) * sample_bytes(info.type));
  std::vector<std::uint64_t> bits(to_size(static_cast<std::uint64_t>((info.dims[0] + 2 + 63) / 64)));
  const std::int64_t step = std::max<std::int64_t>(info.dims[2] / kSlices, 1);
  std::uint64_t changes = 0;
  for (std::int64_t k = step / 2; k < info.dims[2]; k += step) {
    for (std::int64_t j = 0; j < info.dims[1]; ++j) {
      rows.read(k, j, 1, row);
      classify_row(row.data(), info.type, info.dims[0], task.rule, bits);
      changes += count_changes(bits);
    }
  }
  return changes * kTrianglesPerCrossing * static_cast<std::uint64_t>(step) + cells_work;
}

std::vector<std::uint32_t> plan_ranks(const BlockStages& stages, const std::vector<std::uint64_t>& weights, int ranks) {
  return Planner(stages, weights, ranks).run();
}

}  // namespace isoweave
