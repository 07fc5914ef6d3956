// Points with equal coordinates get one number.
#pragma once

#include <cstdint>
#include <vector>

#include "isoweave/mesh.hpp"

namespace isoweave {

// Numbers points in the order of their first appearance: an open-addressing hash table of their numbers.
class Welder {
 public:
  static constexpr std::uint32_t kMostPoints = ~std::uint32_t{0};

  // points: where they are kept; empty, and changed by no one else.
  explicit Welder(std::vector<Point>& points);

  // The number of this point, which is added if it is new. Where there are kMostPoints already, a new point is not
  // added and gets kMostPoints as its number.
  std::uint32_t number(const Point& point);

 private:
  std::uint32_t& find(const Point& point);
  void grow();

  std::vector<Point>& points_;
  std::vector<std::uint32_t> slots_;
};

}  // namespace isoweave
