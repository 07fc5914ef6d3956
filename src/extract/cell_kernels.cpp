#include "extract/cell_kernels.hpp"

#include <vector>

#include "extract/cell_cases.hpp"
#include "parallel/instruction_sets.hpp"

namespace isoweave {

const CellKernels& avx2_cell_kernels();
const CellKernels& avx512_cell_kernels();

namespace {

std::uint32_t count_triangles(const CellRow& row) { return count_triangles_of_cells(row); }

void write_triangles(const CellRow& row, std::size_t w, std::span<std::array<std::uint32_t, 3>> triangles,
                     std::span<std::uint8_t, 64> cases) {
  std::array<std::uint32_t, 3>* out = triangles.data();
  auto next_case = cases.begin();
  for_cell_numbers(row, w, [&](std::size_t, std::uint32_t cell, const std::array<std::uint32_t, 16>& numbers) {
    *next_case++ = static_cast<std::uint8_t>(cell);
    const std::uint8_t* place = kCornerPlaces[cell].data();
    for (std::size_t t = 0; t < kCaseTable[cell].triangles; ++t, ++out) {
      for (std::uint32_t& corner : *out) corner = numbers[*place++];
    }
  });
}

constexpr CellKernels kPortable{count_triangles, write_triangles};

}  // namespace

std::span<const CellKernels* const> all_cell_kernels() {
  static const std::vector<const CellKernels*> kAll = [] {
    std::vector<const CellKernels*> list{&kPortable};
#ifdef ISOWEAVE_X86
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2")) {
      list.push_back(&avx2_cell_kernels());
    }
    if (__builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vbmi") && __builtin_cpu_supports("avx512vpopcntdq")) {
      list.push_back(&avx512_cell_kernels());
    }
#endif
    return list;
  }();
  return kAll;
}

const CellKernels& cell_kernels() { return newest_of(all_cell_kernels()); }

}  // namespace isoweave
