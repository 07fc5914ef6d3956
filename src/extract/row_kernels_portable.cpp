#include "extract/row_kernels_in_lanes.hpp"

namespace isoweave {

const RowKernels& portable_row_kernels() {
  static constexpr RowKernels kTable = RowKernelsInLanes<FlagLanes<16>>::table();
  return kTable;
}

}  // namespace isoweave
