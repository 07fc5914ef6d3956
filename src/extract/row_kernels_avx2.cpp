// Compiled for AVX2.
#include "extract/row_kernels_in_lanes.hpp"

namespace isoweave {

const RowKernels& avx2_row_kernels() {
  static constexpr RowKernels kTable = RowKernelsInLanes<FlagLanes<32>>::table();
  return kTable;
}

}  // namespace isoweave
