// The ring that slices are read into, ahead of whoever needs them.
// Threads: SliceWindow.*
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <numeric>
#include <span>
#include <thread>
#include <vector>

#include "isoweave/error.hpp"
#include "volume/slice_window.hpp"

namespace isoweave::testing::slab_slice_window_test {
namespace {

// Slice k holds the number k in every sample; may be slow, and may fail.
class NumberedVolume final : public SliceSource {
 public:
  explicit NumberedVolume(std::int64_t slices, std::int64_t bad = -1) : bad_(bad) {
    info_.dims = {3, 2, slices};
    info_.type = SampleType::kInt32;
  }

  const VolumeInfo& info() const override { return info_; }

  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    EXPECT_GE(first, next_) << "slices are read once, in order";
    if (first <= bad_ && bad_ < first + count) throw BadInput("bad slice");
    next_ = first + count;
    for (std::int64_t k = first; k < first + count; ++k) {
      for (std::size_t n = 0; n < 6; ++n) {
        const auto value = static_cast<std::int32_t>(k);
        std::memcpy(out.data() + 4 * (6 * static_cast<std::size_t>(k - first) + n), &value, 4);
      }
    }
    read_up_to = next_;
  }

  std::atomic<std::int64_t> read_up_to = 0;

 private:
  VolumeInfo info_;
  std::int64_t bad_;
  std::int64_t next_ = 0;
};

void expect_holds(const SliceWindow& window, std::int64_t first, std::int64_t end) {
  for (std::int64_t k = first; k < end; ++k) {
    for (std::size_t n = 0; n < 6; ++n) {
      std::int32_t value = -1;
      std::memcpy(&value, window.slice(k) + 4 * n, 4);
      ASSERT_EQ(value, k);
    }
  }
}

TEST(SliceWindow, HoldsWhatIsAskedForHoweverItMoves) {
  for (const std::int64_t ahead : {0, 1, 5, 100}) {
    for (const std::int64_t step : {1, 2, 7, 40}) {
      NumberedVolume volume(40);
      SliceWindow window(volume);
      std::int64_t total = 0;
      for (std::int64_t first = -1; first < 40; first += step) {
        const std::int64_t end = first + step + 1;
        total += window.advance(first, end, ahead);
        EXPECT_EQ(window.end(), std::min<std::int64_t>(end, 40));
        expect_holds(window, std::max<std::int64_t>(first, 0), window.end());
      }
      EXPECT_EQ(total, 40);
    }
  }
}

TEST(SliceWindow, SlabsMayChangeInThickness) {
  NumberedVolume volume(200);
  SliceWindow window(volume);
  std::int64_t first = 0;
  for (const std::int64_t layers : {8, 16, 32, 1, 1, 50, 3, 60}) {
    window.advance(first, first + layers + 1, layers);
    expect_holds(window, first, first + layers + 1);
    first += layers;
  }
}

TEST(SliceWindow, ReadsAheadWhileNobodyWaits) {
  NumberedVolume volume(100);
  SliceWindow window(volume);
  window.advance(0, 10, 7);
  for (int wait = 0; volume.read_up_to < 17 && wait < 5000; ++wait) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(volume.read_up_to, 17) << "as far as was said, and no further";
  expect_holds(window, 0, 10);
}

TEST(SliceWindow, BeginsWhereItIsTold) {
  NumberedVolume volume(30);
  SliceWindow window(volume, 12);
  EXPECT_EQ(window.advance(12, 15, 4), 3);
  expect_holds(window, 12, 15);
}

TEST(SliceWindow, AFailureIsThrownWhenItsSlicesAreNeededAndNotBefore) {
  NumberedVolume volume(30, 9);
  SliceWindow window(volume);
  window.advance(0, 5, 10);
  expect_holds(window, 0, 5);
  EXPECT_THROW(window.advance(4, 12, 10), BadInput);
  EXPECT_EQ(window.end(), 5);
  expect_holds(window, 4, 5);
  EXPECT_THROW(window.advance(4, 12, 10), BadInput) << "it stays so";
}

TEST(SliceWindow, LooksAtSamplesWhereTheyAreHeld) {
  VolumeInfo info;
  info.dims = {3, 2, 40};
  info.type = SampleType::kInt32;
  std::vector<std::int32_t> samples;
  for (std::int32_t k = 0; k < 40; ++k) samples.insert(samples.end(), 6, k);
  const auto volume = volume_in_memory(info, std::as_bytes(std::span(samples)));
  SliceWindow window(*volume);
  EXPECT_EQ(window.advance(-1, 7, 100), 7);
  EXPECT_EQ(window.advance(6, 50, 1), 33);
  EXPECT_EQ(window.end(), 40);
  EXPECT_EQ(window.bytes(), 0u);
  EXPECT_EQ(window.room(), 0);
  EXPECT_EQ(window.slice(9), reinterpret_cast<const std::byte*>(&samples[9 * 6]));
  expect_holds(window, 6, 40);
}

TEST(SliceWindow, EndsWhileItReads) {
  NumberedVolume volume(1000);
  SliceWindow window(volume);
  window.advance(0, 2, 900);
}

}  // namespace
}  // namespace isoweave::testing::slab_slice_window_test
