// Internal checks, in the builds that have them.
// Threads: none, one thread.
#include <gtest/gtest.h>

#include "parallel/array.hpp"
#include "parallel/check.hpp"
#include "parallel/parallel.hpp"
#include "simplify/zone.hpp"

namespace isoweave::testing::parallel_check_test {
namespace {

class InternalChecks : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!kChecks) GTEST_SKIP() << "expected a build with ISOWEAVE_CHECKS";
  }
};

TEST_F(InternalChecks, AnElementPastTheEndIsNamed) {
  Array<int> array;
  array.resize(3);
  array[2] = 1;
  EXPECT_THROW(array[3] = 1, std::logic_error);
}

TEST_F(InternalChecks, APieceThatBreaksItsPromisesIsNamed) {
  SurfacePiece piece;
  piece.positions.resize(3);
  piece.ids.resize(3);
  for (std::size_t n = 0; n < 3; ++n) {
    piece.positions[n] = {static_cast<double>(n == 1), static_cast<double>(n == 2), 0};
    piece.ids[n] = n;
  }
  piece.triangles.resize(1);
  piece.triangles[0] = {0, 1, 3};
  Zone zone({});
  EXPECT_THROW(zone.append(piece, Executor(1)), std::logic_error);
}

}  // namespace
}  // namespace isoweave::testing::parallel_check_test
