#include "extract/row_kernels.hpp"

#include <vector>

#include "parallel/instruction_sets.hpp"

namespace isoweave {

const RowKernels& portable_row_kernels();
const RowKernels& avx2_row_kernels();
const RowKernels& avx512_row_kernels();

std::span<const RowKernels* const> all_row_kernels() {
  static const std::vector<const RowKernels*> kAll = [] {
    std::vector<const RowKernels*> list{&portable_row_kernels()};
#ifdef ISOWEAVE_X86
    if (__builtin_cpu_supports("avx2")) list.push_back(&avx2_row_kernels());
    if (__builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq")) list.push_back(&avx512_row_kernels());
#endif
    return list;
  }();
  return kAll;
}

const RowKernels& row_kernels() { return newest_of(all_row_kernels()); }

}  // namespace isoweave
