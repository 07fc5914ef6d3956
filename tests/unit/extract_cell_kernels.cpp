// Passes over rows of cells: every instruction set against one cell, edge and bit after the other.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "extract/cell_kernels.hpp"
#include "extract/cube_rules.hpp"

namespace isoweave::testing::extract_cell_kernels_test {
namespace {

using Words = std::vector<std::uint64_t>;
using Numbers = std::vector<std::uint32_t>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

bool bit_of(const Words& words, std::size_t bit) {
  return bit / 64 < words.size() && (words[bit / 64] >> (bit % 64) & 1) != 0;
}

// A row of cells with memory of its own. Crossings are random where a cell is crossed and behind the last one of a
// word, numbers everywhere: kernels take them as they are.
class RandomRow {
 public:
  RandomRow(std::size_t words, std::mt19937_64& random) {
    const auto fill = [&](Words& row) {
      for (std::uint64_t& word : row = Words(words)) {
        const std::uint64_t kind = random() % 4;
        word = kind == 0   ? 0
               : kind == 1 ? ~std::uint64_t{0}
               : kind == 2 ? ~std::uint64_t{0} << random() % 64
                           : random();
      }
    };
    fill(crossed_);
    for (Words& row : inside_) fill(row);
    for (Words& row : crossings_) {
      fill(row);
      for (std::size_t w = 0; w < words; ++w) row[w] &= crossed_[w] | behind(crossed_[w]);
    }
    for (auto* const bases : {&x_base_[0], &x_base_[1], &x_base_[2], &x_base_[3], &z_base_[0], &z_base_[1]}) {
      for (std::uint32_t& base : * bases = Numbers(words)) base = static_cast<std::uint32_t>(random()) / 2;
    }
  }

  CellRow view() const {
    CellRow row{.words = crossed_.size(), .crossed = crossed_.data(), .inside{}, .crossings{}, .x_base{}, .z_base{}};
    for (std::size_t r = 0; r < 4; ++r) row.inside[r] = inside_[r].data();
    for (std::size_t r = 0; r < 8; ++r) row.crossings[r] = crossings_[r].data();
    for (std::size_t r = 0; r < 4; ++r) row.x_base[r] = x_base_[r].data();
    for (std::size_t r = 0; r < 2; ++r) row.z_base[r] = z_base_[r].data();
    return row;
  }

  // The cases of the crossed cells of word w.
  std::vector<std::uint8_t> cases(std::size_t w) const {
    std::vector<std::uint8_t> cases;
    for (std::size_t bit = 64 * w; bit < 64 * w + 64; ++bit) {
      if (bit_of(crossed_, bit)) cases.push_back(case_of(bit));
    }
    return cases;
  }

  Triangles expected() const {
    Triangles triangles;
    for (std::size_t bit = 0; bit < 64 * crossed_.size(); ++bit) {
      if (!bit_of(crossed_, bit)) continue;
      const CellCase& shape = kCaseTable[case_of(bit)];
      for (std::size_t t = 0; t < shape.triangles; ++t) {
        std::array<std::uint32_t, 3> triangle;
        for (std::size_t c = 0; c < 3; ++c) triangle[c] = number(kEdgeTable[shape.edges[3 * t + c]], bit);
        triangles.push_back(triangle);
      }
    }
    return triangles;
  }

 private:
  std::uint8_t case_of(std::size_t bit) const {
    unsigned cell = 0;
    for (std::size_t corner = 0; corner < 8; ++corner) {
      if (bit_of(inside_[corner / 2], bit + corner % 2)) cell |= 1U << corner;
    }
    return static_cast<std::uint8_t>(cell);
  }

  // The bits above all that are set.
  static std::uint64_t behind(std::uint64_t word) {
    const int end = 64 - std::countl_zero(word);
    return end < 64 ? ~std::uint64_t{0} << end : 0;
  }

  // Of the crossing on an edge of the cell at a bit; any number where the row has ended.
  std::uint32_t number(CellEdge edge, std::size_t bit) const {
    const std::size_t at = bit + edge.dx;
    const std::size_t w = at / 64;
    if (w >= crossed_.size()) return 0;
    const Words& row = crossings_[edge_row(edge.axis, edge.dy, edge.dz)];
    const Numbers& base = edge.axis == 2 ? z_base_[edge.dy] : x_base_[edge_row(0, edge.dy, edge.dz)];
    std::uint32_t number = base[w];
    if (edge.axis == 1) number += ones_below(crossings_[edge_row(0, 0, edge.dz)], 64 * w + 64, w);
    return number + ones_below(row, at, w);
  }

  // Bits of word w below a bit of the row.
  static std::uint32_t ones_below(const Words& row, std::size_t end, std::size_t w) {
    std::uint32_t count = 0;
    for (std::size_t bit = 64 * w; bit < end; ++bit) count += bit_of(row, bit) ? 1U : 0U;
    return count;
  }

  Words crossed_;
  std::array<Words, 4> inside_;
  std::array<Words, 8> crossings_;
  std::array<Numbers, 4> x_base_;
  std::array<Numbers, 2> z_base_;
};

// Writes the triangles of a row, word by word, and looks at the cases.
void write_row(const CellKernels& kernels, const RandomRow& row, std::span<std::array<std::uint32_t, 3>> out) {
  const CellRow view = row.view();
  for (std::size_t w = 0; w < view.words; ++w) {
    const std::vector<std::uint8_t> expected = row.cases(w);
    std::array<std::uint8_t, 64> cases;
    kernels.write_triangles(view, w, out, cases);
    ASSERT_TRUE(std::ranges::equal(expected, std::span(cases).first(expected.size())));
    for (const std::uint8_t cell : expected) out = out.subspan(kCaseTable[cell].triangles);
  }
}

TEST(CellKernels, TheBestSetIsTheOneInUse) { EXPECT_EQ(&cell_kernels(), all_cell_kernels().back()); }

TEST(CellKernels, EverySetCountsAndWritesTheTrianglesOfTheCrossedCells) {
  constexpr std::array<std::uint32_t, 3> kUntouched{0xaaaaaaaaU, 0xbbbbbbbbU, 0xccccccccU};
  std::mt19937_64 random(3);
  for (const CellKernels* kernels : all_cell_kernels()) {
    for (const std::size_t words : {1U, 2U, 3U, 9U}) {
      for (int repetition = 0; repetition < 50; ++repetition) {
        const RandomRow row(words, random);
        Triangles expected = row.expected();
        ASSERT_EQ(kernels->count_triangles(row.view()), expected.size());
        Triangles written(expected.size() + 6, kUntouched);
        write_row(*kernels, row, std::span(written).first(expected.size()));
        expected.resize(written.size(), kUntouched);
        ASSERT_EQ(written, expected) << words << " words, repetition " << repetition;
      }
    }
  }
}

}  // namespace
}  // namespace isoweave::testing::extract_cell_kernels_test
