#include "extract/cell_kernels.hpp"

#include <algorithm>
#include <bit>
#include <vector>

#include "extract/rules.hpp"

namespace isoweave {

const CellKernels& avx512_cell_kernels();

namespace {

std::uint32_t ones(std::uint64_t word) { return static_cast<std::uint32_t>(std::popcount(word)); }

// Calls visit(bit, case) for the crossed cells of word w.
template <class Visit>
void for_cells(const CellRow& row, std::size_t w, const Visit& visit) {
  std::array<std::array<std::uint64_t, 4>, 2> halves;  // 32 cells each, and the bit behind them
  for (std::size_t r = 0; r < 4; ++r) {
    const std::uint64_t next = w + 1 < row.words ? row.inside[r][w + 1] : 0;
    halves[0][r] = row.inside[r][w];
    halves[1][r] = row.inside[r][w] >> 32 | next << 32;
  }
  for (std::uint64_t crossed = row.crossed[w]; crossed != 0; crossed &= crossed - 1) {
    const int bit = std::countr_zero(crossed);
    const auto& half = halves[static_cast<std::size_t>(bit >> 5)];
    const auto pair = [&](std::size_t r) { return static_cast<std::uint32_t>(half[r] >> (bit & 31) & 3); };
    visit(bit, cell_case(pair(0), pair(1), pair(2), pair(3)));
  }
}

std::uint32_t count_triangles(const CellRow& row) {
  std::uint32_t count = 0;
  for (std::size_t w = 0; w < row.words; ++w) {
    for_cells(row, w, [&](int, std::uint32_t cell) { count += kCaseTable[cell].triangles; });
  }
  return count;
}

// Numbers of the first crossings of word w.
std::array<std::uint32_t, 8> bases(const CellRow& row, std::size_t w) {
  std::array<std::uint32_t, 8> base;
  for (std::size_t r = 0; r < 4; ++r) base[r] = row.x_base[r][w];
  for (std::size_t dz = 0; dz < 2; ++dz) base[edge_row(1, 0, dz)] = base[2 * dz] + ones(row.crossings[2 * dz][w]);
  for (std::size_t dy = 0; dy < 2; ++dy) base[edge_row(2, dy, 0)] = row.z_base[dy][w];
  return base;
}

void write_triangles(const CellRow& row, std::array<std::uint32_t, 3>* out) {
  for (std::size_t w = 0; w < row.words; ++w) {
    if (row.crossed[w] == 0) continue;
    std::array<std::uint64_t, 8> crossings;
    for (std::size_t r = 0; r < 8; ++r) crossings[r] = row.crossings[r][w];
    std::array<std::uint32_t, 8> next = bases(row, w);
    for_cells(row, w, [&](int bit, std::uint32_t cell) {
      // Of the crossings at the cell's bit of all rows, then of those at the next bit. Where there is none the number
      // means nothing.
      std::array<std::uint32_t, 16> numbers;
      std::copy(next.begin(), next.end(), numbers.begin());
      for (std::size_t r = 0; r < 8; ++r) next[r] += static_cast<std::uint32_t>(crossings[r] >> bit & 1);
      if (bit == 63 && w + 1 < row.words) next = bases(row, w + 1);
      std::copy(next.begin(), next.end(), numbers.begin() + 8);
      const std::uint8_t* place = kCornerPlaces[cell].data();
      for (std::size_t t = 0; t < kCaseTable[cell].triangles; ++t, ++out) {
        for (std::uint32_t& corner : *out) corner = numbers[*place++];
      }
    });
  }
}

constexpr CellKernels kPortable{count_triangles, write_triangles};

}  // namespace

std::span<const CellKernels* const> all_cell_kernels() {
  static const std::vector<const CellKernels*> kAll = [] {
    std::vector<const CellKernels*> list{&kPortable};
#ifdef ISOWEAVE_X86
    if (__builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vbmi") && __builtin_cpu_supports("avx512vpopcntdq")) {
      list.push_back(&avx512_cell_kernels());
    }
#endif
    return list;
  }();
  return kAll;
}

const CellKernels& cell_kernels() {
  static const CellKernels& best = *all_cell_kernels().back();
  return best;
}

}  // namespace isoweave
