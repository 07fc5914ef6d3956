// Compiled for AVX2.
#include "simplify/kernels_in_lanes.hpp"

namespace isoweave {

extern constexpr Kernels kAvx2Kernels = KernelsInLanes<4>::table("avx2");

}  // namespace isoweave
