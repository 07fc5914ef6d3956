#include <gtest/gtest.h>

#include <cmath>

#include "isoweave/measure.hpp"

namespace isoweave::testing::measure_digest_test {
namespace {

const Point kA{0, 0, 0};
const Point kB{1, 0.5F, -2};
const Point kC{0.25F, 3, 1};

// The rotation in which a triangle is stored says nothing about it.
TEST(MeasureDigest, SameForEveryRotation) {
  EXPECT_EQ(triangle_digest(kA, kB, kC), triangle_digest(kB, kC, kA));
  EXPECT_EQ(triangle_digest(kA, kB, kC), triangle_digest(kC, kA, kB));
}

TEST(MeasureDigest, SameForEveryRotationOfCornersAboveEachOther) {
  const Point low{1, 2, 3}, middle{1, 2, 4}, high{1, 2, 5};
  EXPECT_EQ(triangle_digest(low, high, middle), triangle_digest(high, middle, low));
  EXPECT_EQ(triangle_digest(low, high, middle), triangle_digest(middle, low, high));
}

// Two equal corners leave two candidates for "smallest first"; the rotation must still be unique.
TEST(MeasureDigest, SameForEveryRotationWithEqualCorners) {
  EXPECT_EQ(triangle_digest(kA, kA, kB), triangle_digest(kA, kB, kA));
  EXPECT_EQ(triangle_digest(kA, kA, kB), triangle_digest(kB, kA, kA));
}

TEST(MeasureDigest, ChangesWithOrientation) { EXPECT_NE(triangle_digest(kA, kB, kC), triangle_digest(kA, kC, kB)); }

TEST(MeasureDigest, ChangesWithEveryCoordinate) {
  const std::uint64_t digest = triangle_digest(kA, kB, kC);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Point moved = kB;
    moved[axis] = std::nextafter(moved[axis], 100.0F);
    EXPECT_NE(digest, triangle_digest(kA, moved, kC)) << "axis " << axis;
  }
}

// A sum that comes out as -0 on one schedule is the same place.
TEST(MeasureDigest, NegativeZeroIsZero) {
  EXPECT_EQ(triangle_digest({0, 0, 0}, kB, kC), triangle_digest({-0.0F, 0, -0.0F}, kB, kC));
}

// Written in files and in pages: the value must not change between versions.
TEST(MeasureDigest, ValueIsFixed) {
  EXPECT_EQ(digest_text(triangle_digest(kA, kB, kC)), "86b2a401233c161f");
  EXPECT_EQ(digest_text(triangle_digest(kA, kA, kB)), "216bc84fb7d91ae6");
  EXPECT_EQ(digest_text(triangle_digest(kB, kB, kC)), "48db282abde6409b");
}

TEST(MeasureDigest, TextHasSixteenDigits) {
  EXPECT_EQ(digest_text(0), "0000000000000000");
  EXPECT_EQ(digest_text(0x0123456789abcdefU), "0123456789abcdef");
  EXPECT_EQ(digest_text(~std::uint64_t{0}), "ffffffffffffffff");
}

}  // namespace
}  // namespace isoweave::testing::measure_digest_test
