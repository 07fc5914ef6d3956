// A sink that works beside the caller gets everything in order, and its errors come back.
// Threads: OverlappedSink.*
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "isoweave/error.hpp"
#include "output/overlapped_sink.hpp"

namespace isoweave::testing::pipeline_overlapped_sink_test {
namespace {

using namespace std::chrono_literals;

// Takes its time, so that a caller who did not wait would be seen; fails at one piece.
class SlowSink final : public MeshSink {
 public:
  explicit SlowSink(std::size_t failing = 1000) : failing_(failing) {}

  void append(const MeshPiece& piece) override {
    std::this_thread::sleep_for(5ms);
    if (seen.size() == failing_) throw CannotWrite("full");
    seen.push_back(piece.vertices[0][0]);
  }
  void finish() override {}

  std::vector<float> seen;

 private:
  std::size_t failing_;
};

TEST(OverlappedSink, HandsPiecesOnInOrderFromTwoBuffers) {
  for (const bool overlaps : {false, true}) {
    SlowSink slow;
    OverlappedSink sink(slow, overlaps);
    std::array<Point, 2> buffers{};
    for (std::size_t n = 0; n < 6; ++n) {
      Point& buffer = buffers[n % 2];
      buffer[0] = static_cast<float>(n);
      sink.append({.vertices = {&buffer, 1}});
    }
    sink.wait();
    EXPECT_EQ(slow.seen, (std::vector<float>{0, 1, 2, 3, 4, 5}));
  }
}

TEST(OverlappedSink, TellsAFailureAtTheNextCall) {
  SlowSink slow(1);
  OverlappedSink sink(slow, true);
  const Point point{};
  sink.append({.vertices = {&point, 1}});
  sink.append({.vertices = {&point, 1}});
  EXPECT_THROW(sink.append({.vertices = {&point, 1}}), CannotWrite);
  EXPECT_THROW(sink.wait(), CannotWrite);
  EXPECT_EQ(slow.seen.size(), 1U);
}

TEST(OverlappedSink, EndsWithWhatItHasInHand) {
  SlowSink slow;
  const Point point{};
  OverlappedSink(slow, true).append({.vertices = {&point, 1}});
  EXPECT_EQ(slow.seen.size(), 1U);
}

}  // namespace
}  // namespace isoweave::testing::pipeline_overlapped_sink_test
