#include "simplify/kernels.hpp"

#include <vector>

#include "parallel/instruction_sets.hpp"

namespace isoweave {

const Kernels& portable_kernels();
const Kernels& avx2_kernels();
const Kernels& avx512_kernels();

std::span<const Kernels* const> all_kernels() {
  static const std::vector<const Kernels*> kAll = [] {
    std::vector<const Kernels*> list{&portable_kernels()};
#ifdef ISOWEAVE_X86
    if (__builtin_cpu_supports("avx2")) list.push_back(&avx2_kernels());
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) list.push_back(&avx512_kernels());
#endif
    return list;
  }();
  return kAll;
}

const Kernels& kernels() { return newest_of(all_kernels()); }

}  // namespace isoweave
