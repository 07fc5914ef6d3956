#include "simplify/kernels.hpp"

#include <vector>

namespace isoweave {

extern const Kernels kPortableKernels;
extern const Kernels kAvx2Kernels;
extern const Kernels kAvx512Kernels;

void measure(const Zone& zone, Star& star, Fan& fan) {
  star.pad(star.neighbour[star.border ? star.count() - 1 : 0]);
  kernels().measure(zone.vertices.data(), zone.vertices[star.vertex].position, star.neighbour.data(), star.count(),
                    fan);
}

std::span<const Kernels* const> all_kernels() {
  static const std::vector<const Kernels*> all = [] {
    std::vector<const Kernels*> list{&kPortableKernels};
#ifdef ISOWEAVE_X86
    if (__builtin_cpu_supports("avx2")) list.push_back(&kAvx2Kernels);
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) list.push_back(&kAvx512Kernels);
#endif
    return list;
  }();
  return all;
}

const Kernels& kernels() {
  static const Kernels& best = *all_kernels().back();
  return best;
}

}  // namespace isoweave
