// The bricks that surfaces cross, and the samples that are needed for that reason.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "volume/gaps.hpp"
#include "volume/row_source.hpp"
#include "volume/volume_index.hpp"

namespace isoweave {

// A surface as the bricks see it.
struct IndexedSurface {
  double iso = 0;  // in stored units
  bool above = true;
  bool closed = true;
  // The samples beside an end of a crossed edge that must be as they are in the volume: 1 where gradients are taken.
  std::int64_t margin = 0;
};

// Samples [begin, end) of a row that are not needed, and a sample that may stand for each of them: it lies on the same
// side of every surface.
struct UnneededRun {
  std::int64_t begin = 0, end = 0;
  SampleBytes sample{};
};

// The bricks that one of several surfaces crosses. Inside bricks at the border of a closed surface count as crossed:
// their outer samples are ends of edges that the caps cross.
class CrossedBricks final : public NeededSamples {
 public:
  // The index must outlive this.
  CrossedBricks(const VolumeIndex& index, std::span<const IndexedSurface> surfaces);

  // A sample is needed when it, or one within the margin, lies in a brick that is crossed.
  bool any_in(const Region& box) const override;

  // The samples of row j of slice k that are not needed, ascending. Valid until the next call.
  std::span<const UnneededRun> unneeded(std::int64_t j, std::int64_t k);

  bool at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return crossed_[static_cast<std::size_t>((k * size_[1] + j) * size_[0] + i)] != 0;
  }
  const std::array<std::int64_t, 3>& size() const { return size_; }  // in bricks

  // Crossed bricks of the layer k of bricks.
  std::int64_t crossed_in(std::int64_t k) const;

 private:
  using Range = std::array<std::int64_t, 2>;  // of bricks, both included

  void add(const IndexedSurface& surface, std::size_t level, const std::array<std::int64_t, 3>& at);
  void add_brick(const IndexedSurface& surface, const std::array<std::int64_t, 3>& at, bool crossed);
  Range around(std::size_t axis, std::int64_t first, std::int64_t last) const;
  bool any_of(std::int64_t i, const std::array<Range, 2>& row) const;

  const VolumeIndex& index_;
  std::array<std::int64_t, 3> size_;
  std::int64_t margin_ = 0;                         // the largest of all surfaces
  std::vector<std::uint8_t> crossed_;               // 1 for a brick that is crossed
  std::array<Range, 2> row_{{{-1, -1}, {-1, -1}}};  // the bricks along j and k that runs_ was made for
  std::vector<UnneededRun> runs_;
};

}  // namespace isoweave
