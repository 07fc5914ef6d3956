#include "volume/crossed_bricks.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include "volume/samples.hpp"
#include "volume/threshold.hpp"

namespace isoweave {
namespace {

enum class Side : std::uint8_t { kOutside, kInside, kBoth };

// The sides of a surface that the samples of a brick lie on.
Side side_of(const BrickLevel& level, std::size_t at, SampleType type, const IndexedSurface& surface) {
  return visit_sample_type(type, [&]<class T>() {
    T low, high;
    std::memcpy(&low, level.low.data() + at * sizeof(T), sizeof(T));
    std::memcpy(&high, level.high.data() + at * sizeof(T), sizeof(T));
    if (low > high) return Side::kOutside;  // no sample is a number
    const Threshold<T> threshold = threshold_for<T>(surface.iso, surface.above);
    const auto is_inside = [&](T sample) {
      return threshold.reachable && (surface.above ? sample >= threshold.value : sample <= threshold.value);
    };
    const bool has_nan = !level.nan.empty() && level.nan[at] != 0;
    if (is_inside(low) != is_inside(high) || (is_inside(low) && has_nan)) return Side::kBoth;
    return is_inside(low) ? Side::kInside : Side::kOutside;
  });
}

// A sample of a brick: its least number, or NaN where there is no number.
SampleBytes sample_of(const BrickLevel& level, std::size_t at, SampleType type) {
  SampleBytes bytes{};
  visit_sample_type(type, [&]<class T>() {
    T low, high;
    std::memcpy(&low, level.low.data() + at * sizeof(T), sizeof(T));
    std::memcpy(&high, level.high.data() + at * sizeof(T), sizeof(T));
    if constexpr (std::is_floating_point_v<T>) {
      if (low > high) low = std::numeric_limits<T>::quiet_NaN();
    }
    std::memcpy(bytes.data(), &low, sizeof(T));
  });
  return bytes;
}

}  // namespace

CrossedBricks::CrossedBricks(const VolumeIndex& index, std::span<const IndexedSurface> surfaces)
    : index_(index), size_(index.levels().front().size), crossed_(index.levels().front().count()) {
  for (const IndexedSurface& surface : surfaces) {
    margin_ = std::max(margin_, surface.margin);
    add(surface, index.levels().size() - 1, {0, 0, 0});
  }
}

// Goes down the pyramid to where a brick lies on one side as a whole.
void CrossedBricks::add(const IndexedSurface& surface, std::size_t level, const std::array<std::int64_t, 3>& at) {
  const BrickLevel& bricks = index_.levels()[level];
  const Side side = side_of(bricks, bricks.at(at[0], at[1], at[2]), index_.type(), surface);
  if (side == Side::kOutside || (side == Side::kInside && !surface.closed)) return;
  if (level == 0) return add_brick(surface, at, side == Side::kBoth);
  const std::array<std::int64_t, 3>& size = index_.levels()[level - 1].size;
  for (std::int64_t k = 2 * at[2]; k < std::min(2 * at[2] + 2, size[2]); ++k) {
    for (std::int64_t j = 2 * at[1]; j < std::min(2 * at[1] + 2, size[1]); ++j) {
      for (std::int64_t i = 2 * at[0]; i < std::min(2 * at[0] + 2, size[0]); ++i) add(surface, level - 1, {i, j, k});
    }
  }
}

// Adds a brick that is crossed, or an inside one that may lie at the border.
void CrossedBricks::add_brick(const IndexedSurface& surface, const std::array<std::int64_t, 3>& at, bool crossed) {
  for (std::size_t axis = 0; axis < 3 && surface.closed; ++axis) {
    crossed = crossed || at.at(axis) == 0 || at.at(axis) == size_.at(axis) - 1;
  }
  if (crossed) crossed_[index_.levels().front().at(at[0], at[1], at[2])] = 1;
}

// The bricks that hold samples [first, last] of an axis, or samples within the margin of them.
CrossedBricks::Range CrossedBricks::around(std::size_t axis, std::int64_t first, std::int64_t last) const {
  const std::int64_t low = std::max<std::int64_t>(first - margin_, 0);
  const std::int64_t high = std::min(last + margin_, index_.dims().at(axis) - 1);
  const std::int64_t most = size_.at(axis) - 1;
  return {std::clamp<std::int64_t>((low + kBrick - 1) / kBrick - 1, 0, most), std::min(high / kBrick, most)};
}

// Whether any brick i of rows of bricks is crossed: of the ranges along j and k.
bool CrossedBricks::any_of(std::int64_t i, const std::array<Range, 2>& row) const {
  for (std::int64_t k = row[1][0]; k <= row[1][1]; ++k) {
    for (std::int64_t j = row[0][0]; j <= row[0][1]; ++j) {
      if (at(i, j, k)) return true;
    }
  }
  return false;
}

bool CrossedBricks::any_in(const Region& box) const {
  const Range along = around(0, box.first[0], box.end[0] - 1);
  const std::array<Range, 2> row{around(1, box.first[1], box.end[1] - 1), around(2, box.first[2], box.end[2] - 1)};
  for (std::int64_t i = along[0]; i <= along[1]; ++i) {
    if (any_of(i, row)) return true;
  }
  return false;
}

std::span<const UnneededRun> CrossedBricks::unneeded(std::int64_t j, std::int64_t k) {
  const std::array<Range, 2> row{around(1, j, j), around(2, k, k)};
  if (row == row_) return runs_;
  row_ = row;
  runs_.clear();
  const BrickLevel& bricks = index_.levels().front();
  for (std::int64_t i = 0; i < size_[0]; ++i) {
    if (any_of(i, row)) continue;
    // Neighbours that are not crossed share samples, so a sample of the first lies on the side of all of them.
    const std::int64_t first = i;
    while (i < size_[0] && !any_of(i, row)) ++i;
    const std::int64_t begin = first == 0 ? 0 : first * kBrick + margin_ + 1;
    const std::int64_t end = i == size_[0] ? index_.dims()[0] : i * kBrick - margin_;
    if (begin >= end) continue;
    runs_.push_back({begin, end, sample_of(bricks, bricks.at(first, row[0][0], row[1][0]), index_.type())});
  }
  return runs_;
}

std::int64_t CrossedBricks::crossed_in(std::int64_t k) const {
  const auto layer = crossed_.begin() + k * size_[0] * size_[1];
  return std::count(layer, layer + size_[0] * size_[1], 1);
}

}  // namespace isoweave
