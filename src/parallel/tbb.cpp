// Loops by oneTBB.
//
// ThreadSanitizer cannot see the synchronisation inside an uninstrumented libtbb. Under it this file is compiled
// without instrumentation, with ISOWEAVE_TSAN set, and tells the two edges that for_blocks promises: what the caller
// did comes before every body, and every body before the return.
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <optional>

#include "parallel/arena.hpp"

#ifdef ISOWEAVE_TSAN
#include <sanitizer/tsan_interface.h>
#endif

namespace isoweave {
namespace {

#ifdef ISOWEAVE_TSAN
void tsan_acquire(void* address) { __tsan_acquire(address); }
void tsan_release(void* address) { __tsan_release(address); }
#else
void tsan_acquire(void*) {}
void tsan_release(void*) {}
#endif

// Made once: making one costs as much as a small loop, and a slab runs dozens of loops.
class TbbArena final : public Arena {
 public:
  explicit TbbArena(int threads) : tasks_(threads) {
    if (threads > tbb::info::default_concurrency()) {
      more_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    }
  }

  void run(const BlockLoop& loop) override {
    char started = 0;
    char finished = 0;
    tsan_release(&started);
    tasks_.execute([&] {
      tbb::parallel_for(
          std::int64_t{0}, loop.blocks(),
          [&](std::int64_t block) {
            tsan_acquire(&started);
            loop.run(block);
            tsan_release(&finished);
          },
          tbb::simple_partitioner());
    });
    tsan_acquire(&finished);
  }

 private:
  // Without it oneTBB starts no more threads than there are processors, and says so on the standard error.
  std::optional<tbb::global_control> more_;
  tbb::task_arena tasks_;  // gets its slots when it runs first
};

}  // namespace

std::shared_ptr<Arena> Arena::make(int threads) { return std::make_shared<TbbArena>(threads); }

int Arena::threads_for(int wanted) { return wanted > 0 ? wanted : tbb::this_task_arena::max_concurrency(); }

}  // namespace isoweave
