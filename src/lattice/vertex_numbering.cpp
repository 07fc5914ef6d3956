#include "lattice/vertex_numbering.hpp"

#include <algorithm>

namespace isoweave {
namespace {

constexpr std::uint8_t kInside = 7;  // between the corners of a cube

}  // namespace

VertexNumbering VertexNumbering::of_cube_edges(const std::array<std::int64_t, 3>& dims) {
  return {{dims}, 3, 256, {1, 2, 4}};
}

VertexNumbering VertexNumbering::of_kuhn_edges(const std::array<std::int64_t, 3>& dims) {
  return {{dims}, 7, 512, {1, 2, 3, 4, 5, 6, 7}};
}

VertexNumbering VertexNumbering::of_cubes(const std::array<std::int64_t, 3>& dims) {
  VertexNumbering numbering{{dims}, 10, 512, {1, 2, 4}};
  std::fill_n(numbering.directions.begin() + 3, 7, kInside);
  return numbering;
}

VertexNumbering VertexNumbering::of_dual_cubes(const std::array<std::int64_t, 3>& dims) {
  VertexNumbering numbering{{dims}, 16, 1024};
  numbering.directions.fill(kInside);
  numbering.border_slots = 8;
  return numbering;
}

bool VertexNumbering::fits() const {
  std::int64_t ids = std::int64_t{slots} * width;
  for (const std::int64_t n : lattice.dims) {
    if (n < 1 || __builtin_mul_overflow(ids, n + 2, &ids)) return false;
  }
  return true;
}

std::int64_t VertexNumbering::layer_of(std::uint64_t id) const {
  const Place place = this->place(id);
  return place.along(2) ? place.low[2] : place.low[2] - 1;
}

bool VertexNumbering::is_on_border(std::uint64_t id) const {
  const Place place = this->place(id);
  if (id % slots >= border_slots) return true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (place.along(axis)) continue;
    if (place.low[axis] == 0 || place.low[axis] + 1 == lattice.dims[axis]) return true;
  }
  return false;
}

}  // namespace isoweave
