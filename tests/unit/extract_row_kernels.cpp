// Passes over rows of bits: every instruction set against one bit after the other.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "extract/row_kernels.hpp"

namespace isoweave::testing::extract_row_kernels_test {
namespace {

using Words = std::vector<std::uint64_t>;

// Runs of equal bits, longer than a word here and there.
Words random_words(std::size_t count, std::mt19937_64& random) {
  Words words(count);
  for (std::uint64_t& word : words) {
    const std::uint64_t kind = random() % 4;
    word = kind == 0 ? 0 : kind == 1 ? ~std::uint64_t{0} : kind == 2 ? ~std::uint64_t{0} << random() % 64 : random();
  }
  return words;
}

bool bit_of(const Words& words, std::size_t bit) {
  return bit / 64 < words.size() && (words[bit / 64] >> (bit % 64) & 1) != 0;
}

// expected(bit): what the bit is to be.
template <class Expected>
void expect_bits(const Words& words, const Expected& expected) {
  for (std::size_t bit = 0; bit < 64 * words.size(); ++bit) {
    ASSERT_EQ(bit_of(words, bit), expected(bit)) << "bit " << bit << " of " << words.size() << " words";
  }
}

TEST(RowKernels, TheBestSetIsTheOneInUse) { EXPECT_EQ(&row_kernels(), all_row_kernels().back()); }

TEST(RowKernels, EverySetFindsTheBitsThatDiffer) {
  std::mt19937_64 random(1);
  for (const RowKernels* kernels : all_row_kernels()) {
    for (const std::size_t count : {1u, 2u, 3u, 8u, 9u, 17u, 40u}) {
      for (int repetition = 0; repetition < 20; ++repetition) {
        const Words a = random_words(count, random);
        const Words b = random_words(count, random);
        const Words mask = random_words(count, random);
        Words out(count, random());
        kernels->differ(a.data(), b.data(), count, out.data());
        expect_bits(out, [&](std::size_t bit) { return bit_of(a, bit) != bit_of(b, bit); });
        kernels->differ_along(a.data(), a.data(), mask.data(), count, out.data());
        expect_bits(out, [&](std::size_t bit) { return bit_of(mask, bit) && bit_of(a, bit) != bit_of(a, bit + 1); });
        kernels->differ_along(a.data(), b.data(), mask.data(), count, out.data());
        expect_bits(out, [&](std::size_t bit) { return bit_of(mask, bit) && bit_of(a, bit) != bit_of(b, bit + 1); });
      }
    }
  }
}

TEST(RowKernels, EverySetFindsTheCellsThatAreCrossed) {
  std::mt19937_64 random(2);
  for (const RowKernels* kernels : all_row_kernels()) {
    for (const std::size_t count : {1u, 2u, 3u, 8u, 9u, 17u, 40u}) {
      for (int repetition = 0; repetition < 20; ++repetition) {
        std::array<Words, 4> rows;
        for (Words& row : rows) row = random_words(count, random);
        const Words mask = random_words(count, random);
        Words out(count, random());
        kernels->cells_crossed({rows[0].data(), rows[1].data(), rows[2].data(), rows[3].data()}, mask.data(), count,
                               out.data());
        expect_bits(out, [&](std::size_t bit) {
          int inside = 0;
          for (const Words& row : rows) inside += bit_of(row, bit) + bit_of(row, bit + 1);
          return bit_of(mask, bit) && inside != 0 && inside != 8;
        });
      }
    }
  }
}

}  // namespace
}  // namespace isoweave::testing::extract_row_kernels_test
