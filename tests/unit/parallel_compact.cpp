// Gaps in an array are closed as if its elements were moved one after the other.
// Threads: Compaction.*
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "parallel/array.hpp"
#include "parallel/compact.hpp"

namespace isoweave::testing::parallel_compact_test {
namespace {

using Keep = std::function<bool(std::size_t)>;

// Compacts the squares of 0, 1, 2, ..., each made larger by one on its way.
void expect_closed(std::size_t size, const Keep& keep, int threads) {
  const Executor executor(threads);
  Array<std::uint64_t> array;
  array.resize(size);
  std::vector<std::uint64_t> expected;
  for (std::size_t n = 0; n < size; ++n) {
    array[n] = n * n;
    if (keep(n)) expected.push_back(n * n + 1);
  }
  const Compaction compaction(executor, size, keep);
  std::size_t place = 0;
  for (std::size_t n = 0; n < size; ++n) {
    ASSERT_EQ(compaction[n], keep(n) ? place++ : Compaction::kDropped) << "element " << n << " of " << size;
    if (compaction.stays(n)) {
      ASSERT_EQ(compaction[n], n) << "element of " << size;
    }
  }
  Array<std::uint64_t> moved;
  moved.resize(size);
  std::copy(array.begin(), array.end(), moved.begin());
  compaction.apply(moved);
  for (std::uint64_t& value : moved) ++value;
  ASSERT_EQ(std::vector<std::uint64_t>(moved.begin(), moved.end()), expected) << size << ", threads " << threads;
  compaction.apply(array, [](std::uint64_t& value) { ++value; });
  ASSERT_EQ(std::vector<std::uint64_t>(array.begin(), array.end()), expected) << size << ", threads " << threads;
}

void expect_closed(std::size_t size, const Keep& keep) {
  for (const int threads : {1, 3}) expect_closed(size, keep, threads);
}

TEST(Compaction, SizesAroundThoseOfBlocks) {
  for (const std::size_t size : {0U, 1U, 4095U, 4096U, 4097U, 8192U, 50000U}) {
    expect_closed(size, [](std::size_t n) { return n % 3 != 1; });
  }
}

TEST(Compaction, AnyPartThatIsLeft) {
  constexpr std::size_t kSize = 300000;
  for (const double left : {0.0, 0.01, 0.2, 0.5, 0.9, 0.999, 1.0}) {
    std::vector<bool> keep(kSize);
    std::mt19937 random(11);
    std::bernoulli_distribution stays(left);
    for (std::size_t n = 0; n < kSize; ++n) keep[n] = stays(random);
    expect_closed(kSize, [&](std::size_t n) { return keep[n]; });
  }
}

TEST(Compaction, GapsAtOneEnd) {
  constexpr std::size_t kSize = 100000;
  expect_closed(kSize, [](std::size_t n) { return n >= 30000; });
  expect_closed(kSize, [](std::size_t n) { return n < 30000; });
}

TEST(Compaction, MostOfWhatLiesBeforeTheFirstGapIsKnownToStay) {
  constexpr std::size_t kSize = 100000;
  for (const std::size_t gap : {std::size_t{30000}, std::size_t{8192}, std::size_t{8191}, kSize - 1, kSize}) {
    const Executor executor(2);
    const Compaction compaction(executor, kSize, [&](std::size_t n) { return n != gap; });
    std::size_t stay = 0;
    while (stay < kSize && compaction.stays(stay)) ++stay;
    EXPECT_LE(stay, gap);
    EXPECT_GT(stay + 4096, gap);
    expect_closed(kSize, [&](std::size_t n) { return n < gap || n % 3 == 0; });
  }
}

}  // namespace
}  // namespace isoweave::testing::parallel_compact_test
