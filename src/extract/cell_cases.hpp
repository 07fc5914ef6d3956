// The cases of the crossed cells of a row, one after the other.
#pragma once

#include <algorithm>
#include <array>
#include <bit>

#include "extract/cell_kernels.hpp"
#include "extract/cube_rules.hpp"

namespace isoweave {

// Calls visit(bit, case) for the crossed cells among the 32 of a half of word w; bits are counted from the half's
// first. Always inlined, as code compiled for one instruction set must not be linked into another.
template <class Visit>
[[gnu::always_inline]] inline void for_cells(const CellRow& row, std::size_t w, unsigned half, const Visit& visit) {
  std::array<std::uint64_t, 4> inside;  // 32 cells, and the bit behind them
  for (std::size_t r = 0; r < 4; ++r) {
    const std::uint64_t next = w + 1 < row.words ? row.inside[r][w + 1] : 0;
    inside[r] = half == 0 ? row.inside[r][w] : row.inside[r][w] >> 32 | next << 32;
  }
  for (auto crossed = static_cast<std::uint32_t>(row.crossed[w] >> 32 * half); crossed != 0; crossed &= crossed - 1) {
    const int bit = std::countr_zero(crossed);
    const auto pair = [&](std::size_t r) { return static_cast<std::uint32_t>(inside[r] >> bit & 3); };
    visit(bit, cell_case(pair(0), pair(1), pair(2), pair(3)));
  }
}

[[gnu::always_inline]] inline std::uint32_t count_triangles_of_cells(const CellRow& row) {
  std::uint32_t count = 0;
  for (std::size_t w = 0; w < row.words; ++w) {
    if (row.crossed[w] == 0) continue;
    for (const unsigned half : {0U, 1U}) {
      for_cells(row, w, half, [&](int, std::uint32_t cell) { count += kCaseTable[cell].triangles; });
    }
  }
  return count;
}

// The numbers of the first crossings of word w, in the order of edge_row().
inline std::array<std::uint32_t, 8> first_numbers(const CellRow& row, std::size_t w) {
  std::array<std::uint32_t, 8> first;
  for (std::size_t r = 0; r < 4; ++r) first[r] = row.x_base[r][w];
  for (std::size_t dz = 0; dz < 2; ++dz) {
    first[edge_row(1, 0, dz)] = first[2 * dz] + static_cast<std::uint32_t>(std::popcount(row.crossings[2 * dz][w]));
  }
  for (std::size_t dy = 0; dy < 2; ++dy) first[edge_row(2, dy, 0)] = row.z_base[dy][w];
  return first;
}

// Calls visit(bit of the row, case, numbers) for the crossed cells of word w of a row, one after the other. Numbers are
// those of the crossings at the cell's bit of all rows, then those at the next bit; that of an absent crossing means
// nothing.
template <class Visit>
inline void for_cell_numbers(const CellRow& row, std::size_t w, const Visit& visit) {
  std::array<std::uint32_t, 16> numbers;
  std::array<std::uint32_t, 8> next = first_numbers(row, w);
  for (const unsigned half : {0U, 1U}) {
    std::array<std::uint32_t, 8> crossings;
    for (std::size_t r = 0; r < 8; ++r) crossings[r] = static_cast<std::uint32_t>(row.crossings[r][w] >> 32 * half);
    for_cells(row, w, half, [&](int bit, std::uint32_t cell) {
      std::copy(next.begin(), next.end(), numbers.begin());
      for (std::size_t r = 0; r < 8; ++r) next[r] += crossings[r] >> bit & 1;
      if (half == 1 && bit == 31 && w + 1 < row.words) next = first_numbers(row, w + 1);
      std::copy(next.begin(), next.end(), numbers.begin() + 8);
      visit(64 * w + 32 * half + static_cast<std::size_t>(bit), cell, numbers);
    });
  }
}

// The same for all words of the row.
template <class Visit>
inline void for_cell_numbers(const CellRow& row, const Visit& visit) {
  for (std::size_t w = 0; w < row.words; ++w) {
    if (row.crossed[w] != 0) for_cell_numbers(row, w, visit);
  }
}

}  // namespace isoweave
