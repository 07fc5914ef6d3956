// Compiled for AVX-512.
#include "simplify/kernels_in_lanes.hpp"

namespace isoweave {

const Kernels& avx512_kernels() {
  static constexpr Kernels kTable = KernelsInLanes<8>::table();
  return kTable;
}

}  // namespace isoweave
