#include "simplify/kernels_in_lanes.hpp"

namespace isoweave {

extern constexpr Kernels kPortableKernels = KernelsInLanes<2>::table("portable");

}  // namespace isoweave
