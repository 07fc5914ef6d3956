// Compiled for AVX2.
#include "simplify/kernels_in_lanes.hpp"

namespace isoweave {

const Kernels& avx2_kernels() {
  static constexpr Kernels kTable = KernelsInLanes<4>::table();
  return kTable;
}

}  // namespace isoweave
