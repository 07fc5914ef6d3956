// The space above and below a triangle, and which cells of a grid it may touch.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "lattice/triangles.hpp"

namespace isoweave {

// The space up to a height above and below a triangle, which must have an area, between planes.
class Prism {
 public:
  struct Plane {
    measure::Vector out;  // of length 1
    double at;            // the largest coordinate along it
  };

  Prism(const measure::TriangleCorners& t, double height) {
    using measure::operator-;
    using measure::operator*;
    const measure::Vector normal = measure::cross(t[1] - t[0], t[2] - t[0]);
    add(normal, t[0], height);
    add(-1.0 * normal, t[0], height);
    for (std::size_t n = 0; n < 3; ++n) add(measure::cross(t[(n + 1) % 3] - t[n], normal), t[n], 0);
  }

  const std::array<Plane, 5>& planes() const { return planes_; }

 private:
  void add(const measure::Vector& out, const measure::Vector& through, double beyond) {
    using measure::operator*;
    const measure::Vector unit = (1 / std::sqrt(measure::dot(out, out))) * out;
    planes_[count_++] = {unit, measure::dot(unit, through) + beyond};
  }

  std::array<Plane, 5> planes_{};
  std::size_t count_ = 0;
};

// Tells which cells of a grid may touch a prism: those that no plane of it parts from it, but for rounding.
class CellsOfPrism {
 public:
  CellsOfPrism(const Prism& prism, const std::array<double, 3>& lengths) {
    constexpr double kSlack = 1e-6;  // of a cell
    for (std::size_t n = 0; n < planes_.size(); ++n) {
      const auto& [out, at] = prism.planes()[n];
      Plane& plane = planes_[n];
      double nearest = 0;  // where a cell is the least far out, from its first corner
      double size = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        plane.step[axis] = out[axis] * lengths[axis];
        nearest += std::min(plane.step[axis], 0.0);
        size += std::abs(plane.step[axis]);
      }
      plane.most = at - nearest + kSlack * size;
    }
  }

  template <class Cell>
  bool may_touch(const Cell& cell) const {
    const auto x = static_cast<double>(cell[0]);
    const auto y = static_cast<double>(cell[1]);
    const auto z = static_cast<double>(cell[2]);
    bool touches = true;
    for (const Plane& p : planes_) touches &= x * p.step[0] + y * p.step[1] + z * p.step[2] <= p.most;
    return touches;
  }

 private:
  struct Plane {
    std::array<double, 3> step;  // how far out a cell is, for each of its numbers
    double most;
  };
  std::array<Plane, 5> planes_;
};

}  // namespace isoweave
