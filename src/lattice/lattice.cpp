#include "lattice/lattice.hpp"

namespace isoweave {

bool Lattice::fits(const std::array<std::int64_t, 3>& dims) {
  std::int64_t ids = 3 * 256;
  for (const std::int64_t n : dims) {
    if (n < 1 || __builtin_mul_overflow(ids, n + 2, &ids)) return false;
  }
  return true;
}

bool Lattice::is_on_border(std::uint64_t edge) const {
  const Edge place = this->edge(edge);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis == place.axis) continue;
    if (place.low[axis] == 0 || place.low[axis] + 1 == dims[axis]) return true;
  }
  return false;
}

}  // namespace isoweave
