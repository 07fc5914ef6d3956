#include "simplify/kernels_in_lanes.hpp"

namespace isoweave {

const Kernels& portable_kernels() {
  static constexpr Kernels kTable = KernelsInLanes<2>::table();
  return kTable;
}

}  // namespace isoweave
