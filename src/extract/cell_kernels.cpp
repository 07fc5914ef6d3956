#include "extract/cell_kernels.hpp"

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
  std::array<std::uint64_t, 4> here;
  std::array<std::uint64_t, 4> next;
  for (std::size_t r = 0; r < 4; ++r) {
    here[r] = row.inside[r][w];
    next[r] = here[r] >> 1 | (w + 1 < row.words ? row.inside[r][w + 1] << 63 : 0);
  }
  for (std::uint64_t crossed = row.crossed[w]; crossed != 0; crossed &= crossed - 1) {
    const int bit = std::countr_zero(crossed);
    const auto pair = [&](std::size_t r) {
      return static_cast<std::uint32_t>((here[r] >> bit & 1) | (next[r] >> bit & 1) << 1);
    };
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

// The edges of the cells of a word.
struct Edges {
  Edges(const CellRow& row, std::size_t w) : base(bases(row, w)), next_base{} {
    for (std::size_t r = 0; r < 8; ++r) crossings[r] = row.crossings[r][w];
    if (w + 1 < row.words) next_base = bases(row, w + 1);
  }

  // Numbers of the crossings at a bit of all rows, then at the next bit. Where there is none the number means nothing.
  std::array<std::uint32_t, 16> numbers_at(int bit) const {
    const std::uint64_t below = (std::uint64_t{1} << bit) - 1;
    std::array<std::uint32_t, 16> numbers;
    for (std::size_t r = 0; r < 8; ++r) {
      numbers[r] = base[r] + ones(crossings[r] & below);
      numbers[8 + r] = bit < 63 ? numbers[r] + (crossings[r] >> bit & 1) : next_base[r];
    }
    return numbers;
  }

  std::array<std::uint64_t, 8> crossings;
  std::array<std::uint32_t, 8> base;
  std::array<std::uint32_t, 8> next_base;  // of the next word
};

void write_triangles(const CellRow& row, std::array<std::uint32_t, 3>* out) {
  for (std::size_t w = 0; w < row.words; ++w) {
    if (row.crossed[w] == 0) continue;
    const Edges edges(row, w);
    for_cells(row, w, [&](int bit, std::uint32_t cell) {
      const std::array<std::uint32_t, 16> numbers = edges.numbers_at(bit);
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
