#include "slab/lattice.hpp"

namespace isoweave {

bool Lattice::fits(const std::array<std::int64_t, 3>& dims) {
  std::int64_t ids = 3 * 256;
  for (const std::int64_t n : dims) {
    if (n < 1 || __builtin_mul_overflow(ids, n + 2, &ids)) return false;
  }
  return true;
}

}  // namespace isoweave
