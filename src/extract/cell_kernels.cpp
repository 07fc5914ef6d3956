#include "extract/cell_kernels.hpp"

#include <algorithm>
#include <bit>
#include <vector>

#include "extract/cell_cases.hpp"
#include "parallel/instruction_sets.hpp"

namespace isoweave {

const CellKernels& avx2_cell_kernels();
const CellKernels& avx512_cell_kernels();

namespace {

std::uint32_t ones(std::uint64_t word) { return static_cast<std::uint32_t>(std::popcount(word)); }

std::uint32_t count_triangles(const CellRow& row) { return count_triangles_of_cells(row); }

// The numbers of the first crossings of word w.
std::array<std::uint32_t, 8> bases(const CellRow& row, std::size_t w) {
  std::array<std::uint32_t, 8> base;
  for (std::size_t r = 0; r < 4; ++r) base[r] = row.x_base[r][w];
  for (std::size_t dz = 0; dz < 2; ++dz) base[edge_row(1, 0, dz)] = base[2 * dz] + ones(row.crossings[2 * dz][w]);
  for (std::size_t dy = 0; dy < 2; ++dy) base[edge_row(2, dy, 0)] = row.z_base[dy][w];
  return base;
}

void write_triangles(const CellRow& row, std::span<std::array<std::uint32_t, 3>> triangles) {
  std::array<std::uint32_t, 3>* out = triangles.data();
  for (std::size_t w = 0; w < row.words; ++w) {
    if (row.crossed[w] == 0) continue;
    std::array<std::uint32_t, 8> next = bases(row, w);
    for (const unsigned half : {0U, 1U}) {
      std::array<std::uint32_t, 8> crossings;
      for (std::size_t r = 0; r < 8; ++r) crossings[r] = static_cast<std::uint32_t>(row.crossings[r][w] >> 32 * half);
      for_cells(row, w, half, [&](int bit, std::uint32_t cell) {
        // The numbers of the crossings at the cell's bit of all rows, then those at the next bit. The number of an
        // absent crossing means nothing.
        std::array<std::uint32_t, 16> numbers;
        std::copy(next.begin(), next.end(), numbers.begin());
        for (std::size_t r = 0; r < 8; ++r) next[r] += crossings[r] >> bit & 1;
        if (half == 1 && bit == 31 && w + 1 < row.words) next = bases(row, w + 1);
        std::copy(next.begin(), next.end(), numbers.begin() + 8);
        const std::uint8_t* place = kCornerPlaces[cell].data();
        for (std::size_t t = 0; t < kCaseTable[cell].triangles; ++t, ++out) {
          for (std::uint32_t& corner : *out) corner = numbers[*place++];
        }
      });
    }
  }
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
