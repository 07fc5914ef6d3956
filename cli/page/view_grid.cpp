#include "page/view_grid.hpp"

#include <algorithm>

namespace isoweave::cli {

ViewGrid ViewGrid::around(std::span<const Point> points) {
  ViewGrid grid;
  double longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::ranges::minmax(points, {}, [&](const Point& p) { return p[axis]; });
    grid.origin[axis] = low[axis];
    longest = std::max(longest, double{high[axis]} - double{low[axis]});
  }
  if (longest > 0) grid.step = longest / kSteps;
  return grid;
}

GridPoint ViewGrid::place(const Point& point) const {
  const double scale = 1 / step;
  GridPoint placed{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = (double{point[axis]} - origin[axis]) * scale + 0.5;
    placed[axis] = static_cast<std::uint16_t>(std::clamp(at, 0.0, kSteps));
  }
  return placed;
}

GridTriangle ViewGrid::place(const TriangleCorners& triangle) const {
  GridTriangle placed{};
  for (std::size_t c = 0; c < 3; ++c) {
    std::ranges::copy(place(triangle[c]), placed.begin() + static_cast<std::ptrdiff_t>(3 * c));
  }
  return placed;
}

}  // namespace isoweave::cli
