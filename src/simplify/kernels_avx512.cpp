// Compiled for AVX-512.
#include "simplify/kernels_in_lanes.hpp"

namespace isoweave {

extern constexpr Kernels kAvx512Kernels = KernelsInLanes<8>::table("avx512");

}  // namespace isoweave
