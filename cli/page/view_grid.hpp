// Places on a grid of 16 bits, in which both pages draw: fine enough to look at, and small to send.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "isoweave/mesh.hpp"
#include "isoweave/run.hpp"

namespace isoweave::cli {

// x, y, z in steps of the grid.
using GridPoint = std::array<std::uint16_t, 3>;

// x, y, z of three corners.
using GridTriangle = std::array<std::uint16_t, 9>;

// 65536 steps along the longest side of a box.
struct ViewGrid {
  static constexpr double kSteps = 65535;

  std::array<double, 3> origin{};
  double step = 1;

  // The grid of the box around one point or more.
  static ViewGrid around(std::span<const Point> points);

  // The nearest point of the grid. Points outside of the box go to its border.
  GridPoint place(const Point& point) const;
  GridTriangle place(const TriangleCorners& triangle) const;
};

}  // namespace isoweave::cli
