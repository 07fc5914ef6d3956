// Loops over blocks, by whichever threads the build has: every block once, exceptions, loops in loops.
// Threads: Executor.*
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cfenv>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include "parallel/parallel.hpp"

namespace isoweave::testing::parallel_executor_test {
namespace {

constexpr std::int64_t kCount = 10007;

std::vector<int> visits_of(const Executor& executor, std::int64_t count, std::int64_t grain) {
  std::vector<int> visits(static_cast<std::size_t>(count), 0);
  executor.for_each(count, grain, [&](std::int64_t n) { ++visits[static_cast<std::size_t>(n)]; });
  return visits;
}

TEST(Executor, VisitsEachElementOnce) {
  for (const int threads : {1, 2, 5}) {
    const Executor executor(threads);
    for (const std::int64_t count : {std::int64_t{0}, std::int64_t{1}, kCount}) {
      for (const std::int64_t grain : {1, 64, 100000}) {
        EXPECT_EQ(visits_of(executor, count, grain), std::vector<int>(static_cast<std::size_t>(count), 1))
            << threads << ' ' << count << ' ' << grain;
      }
    }
  }
}

TEST(Executor, BlocksDependOnCountAndGrainOnly) {
  const auto blocks = [](int threads) {
    std::mutex mutex;
    std::set<std::pair<std::int64_t, std::int64_t>> found;
    Executor(threads).for_blocks(1000, 300, [&](std::int64_t begin, std::int64_t end) {
      const std::lock_guard lock(mutex);
      found.emplace(begin, end);
    });
    return found;
  };
  EXPECT_EQ(blocks(1),
            (std::set<std::pair<std::int64_t, std::int64_t>>{{0, 300}, {300, 600}, {600, 900}, {900, 1000}}));
  EXPECT_EQ(blocks(4), blocks(1));
}

TEST(Executor, RefusesNumbersOfThreadsThatCannotBe) {
  EXPECT_THROW(Executor(-1), std::invalid_argument);
  EXPECT_THROW(Executor(Executor::kMostThreads + 1), std::invalid_argument);
  EXPECT_GE(Executor(0).threads(), 1);
  EXPECT_EQ(Executor(3).threads(), Executor::has_threads() ? 3 : 1);
}

TEST(Executor, OneThreadIsTheCallers) {
  const std::thread::id caller = std::this_thread::get_id();
  Executor(1).for_each(100, 1, [&](std::int64_t) { EXPECT_EQ(std::this_thread::get_id(), caller); });
}

// Once nobody is inside of a body any more.
TEST(Executor, RethrowsAnExceptionWhenEveryBodyHasEnded) {
  for (const int threads : {1, 2, 5}) {
    const Executor executor(threads);
    for (int round = 0; round < 50; ++round) {
      std::atomic<int> inside{0};
      std::string found;
      try {
        executor.for_each(100, 1, [&](std::int64_t n) {
          ++inside;
          std::this_thread::yield();
          --inside;
          if (n % 10 == 3) throw std::runtime_error("a body");
        });
      } catch (const std::runtime_error& error) {
        found = error.what();
      }
      EXPECT_EQ(found, "a body");
      EXPECT_EQ(inside, 0);
      EXPECT_EQ(visits_of(executor, 100, 7), std::vector<int>(100, 1));
    }
  }
}

TEST(Executor, LoopsMayRunInLoopsAndBesideEachOther) {
  const Executor executor(4);
  std::atomic<std::int64_t> sum{0};
  const auto run = [&] {
    for (int round = 0; round < 20; ++round) {
      executor.for_each(8, 1, [&](std::int64_t) {
        executor.for_each(50, 3, [&](std::int64_t n) { sum += n; });
        Executor(1).for_each(50, 3, [&](std::int64_t n) { sum += n; });
      });
    }
  };
  std::thread beside(run);
  run();
  beside.join();
  EXPECT_EQ(sum, 2 * 20 * 8 * 2 * 1225);
}

// Ordinary writes before a loop are seen in it, and those in it after it.
TEST(Executor, OrdersWhatIsAroundAndInLoops) {
  const Executor executor(4);
  std::vector<std::int64_t> numbers(2000, 0);
  for (std::int64_t round = 0; round < 100; ++round) {
    for (std::int64_t& number : numbers) ++number;
    executor.for_each(2000, 10, [&](std::int64_t n) { numbers[static_cast<std::size_t>(1999 - n)] += n; });
  }
  for (std::int64_t n = 0; n < 2000; ++n) EXPECT_EQ(numbers[static_cast<std::size_t>(n)], 100 * (1 + 1999 - n));
}

TEST(Executor, RoundsToNearestInEveryThread) {
  if (std::fesetround(FE_UPWARD) != 0) GTEST_SKIP() << "no other rounding here";
  std::atomic<int> others{0};
  Executor(3).for_each(64, 1, [&](std::int64_t) { others += std::fegetround() == FE_TONEAREST ? 0 : 1; });
  EXPECT_EQ(std::fegetround(), FE_UPWARD);
  std::fesetround(FE_TONEAREST);
  EXPECT_EQ(others, 0);
}

TEST(Executor, KeepsSmallNumbersInEveryThread) {
#ifdef __SSE2__
  constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x40;
  const unsigned usual = _mm_getcsr();
  for (const unsigned host : {kFlushToZero, kDenormalsAreZero}) {
    for (const int threads : {1, 2, 5}) {
      _mm_setcsr(usual | host);
      std::atomic<int> kept = 0;
      Executor(threads).for_each(64, 1, [&](std::int64_t) {
        if ((_mm_getcsr() & (kFlushToZero | kDenormalsAreZero)) == 0) ++kept;
      });
      const unsigned after = _mm_getcsr();
      _mm_setcsr(usual);
      EXPECT_EQ(kept, 64) << threads;
      EXPECT_EQ(after & host, host) << "the caller's is back";
    }
  }
#else
  GTEST_SKIP() << "only tried on x86";
#endif
}

}  // namespace
}  // namespace isoweave::testing::parallel_executor_test
