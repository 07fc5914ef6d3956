#include "slab/lattice.hpp"

namespace isoweave {

bool Lattice::fits(const std::array<std::int64_t, 3>& dims) {
  std::int64_t ids = 3 * 256;
  for (const std::int64_t n : dims) {
    if (n < 1 || __builtin_mul_overflow(ids, n + 2, &ids)) return false;
  }
  return true;
}

bool Lattice::is_on_border(std::uint64_t edge) const {
  const std::uint64_t point = edge / 3;
  const std::array<std::uint64_t, 3> index{point % row() - 1, point % plane() / row() - 1, point / plane() - 1};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis == edge % 3) continue;
    if (index[axis] == 0 || index[axis] + 1 == static_cast<std::uint64_t>(dims[axis])) return true;
  }
  return false;
}

}  // namespace isoweave
