// Cubic cells of one size, in which the vertices of a surface become one vertex each.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lattice/vec3.hpp"

namespace isoweave {

class CellGrid {
 public:
  // The number of cells along an axis that keys can name, on either side of the first one.
  static constexpr std::int64_t kMostCells = std::int64_t{1} << 20;

  // low: the middle of the first cell. No position may lie as many cells away as keys can name.
  CellGrid(const Vec3& low, double side) : origin_(low - Vec3{side / 2, side / 2, side / 2}), side_(side) {}

  double side() const { return side_; }

  // The cell of a position. Keys are in the order of z, y, x.
  std::uint64_t key(const Vec3& position) const {
    const Vec3 from = position - origin_;
    return (index(from.z) << (2 * kBits)) | (index(from.y) << kBits) | index(from.x);
  }

  Vec3 middle(std::uint64_t key) const {
    const auto along = [&](std::uint64_t shifted) {
      const auto index = static_cast<std::int64_t>(shifted & (2 * kMostCells - 1));
      return (static_cast<double>(index - kMostCells) + 0.5) * side_;
    };
    return origin_ + Vec3{along(key), along(key >> kBits), along(key >> (2 * kBits))};
  }

  // A place relative to the middle, kept inside the cell and off its sides: vertices of two cells are never at one
  // place.
  Vec3 within(const Vec3& place) const {
    constexpr double kMargin = 1.0 / 256;
    const double most = (0.5 - kMargin) * side_;
    return {std::clamp(place.x, -most, most), std::clamp(place.y, -most, most), std::clamp(place.z, -most, most)};
  }

 private:
  static constexpr unsigned kBits = 21;  // for the cells on both sides

  std::uint64_t index(double from) const {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(from / side_)) + kMostCells);
  }

  Vec3 origin_;
  double side_;
};

}  // namespace isoweave
