// Counts of 64 bits that become sizes of memory.
// Threads: none, the function has no memory
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>

#include "parallel/size.hpp"

namespace isoweave::testing::parallel_size_test {
namespace {

TEST(Size, CountsAndProductsThatFitAreTaken) {
  EXPECT_EQ(to_size(std::int64_t{7}), 7U);
  EXPECT_EQ(to_size(std::uint64_t{3}, 5), 15U);
  EXPECT_EQ(to_size(std::uint64_t{3}, 0), 0U);
  EXPECT_EQ(to_size(std::numeric_limits<std::size_t>::max() / 4, 4), std::numeric_limits<std::size_t>::max() - 3);
}

TEST(Size, AProductThatNoMemoryHoldsIsRefused) {
  EXPECT_THROW(to_size(std::numeric_limits<std::size_t>::max() / 4 + 1, 4), std::bad_array_new_length);
  EXPECT_THROW(to_size(std::int64_t{1} << 62, 8), std::bad_array_new_length);
}

}  // namespace
}  // namespace isoweave::testing::parallel_size_test
