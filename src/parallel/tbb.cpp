// Executor over oneTBB.
//
// ThreadSanitizer cannot see the synchronisation inside an uninstrumented libtbb. Under it this file is compiled
// without instrumentation, with ISOWEAVE_TSAN set, and tells the two edges that for_blocks promises: what the caller
// did comes before every body, and every body before the return.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "parallel/float_environment.hpp"
#include "parallel/parallel.hpp"

#ifdef ISOWEAVE_TSAN
extern "C" void __tsan_acquire(void* address);
extern "C" void __tsan_release(void* address);
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

}  // namespace

// Made once: making one costs as much as a small loop, and a slab runs dozens of loops.
struct Executor::Arena {
  explicit Arena(int threads) : tasks(threads) {}
  tbb::task_arena tasks;
};

namespace {

int checked_threads(int threads) {
  if (threads < 0 || threads > Executor::kMostThreads) {
    throw std::invalid_argument("threads: expected 0 to " + std::to_string(Executor::kMostThreads) + ", found " +
                                std::to_string(threads));
  }
  return threads > 0 ? threads : std::min(tbb::this_task_arena::max_concurrency(), Executor::kMostThreads);
}

}  // namespace

Executor::Executor(int threads)
    : threads_(checked_threads(threads)), arena_(threads_ > 1 ? std::make_shared<Arena>(threads_) : nullptr) {}

void Executor::run(std::int64_t count, std::int64_t grain, void* body, BlockFunction call) const {
  if (count <= 0) return;
  const std::int64_t blocks = (count + grain - 1) / grain;
  const auto run_block = [&](std::int64_t block) {
    const StandardFloats floats;  // of this worker
    call(body, block * grain, std::min(count, (block + 1) * grain));
  };
  if (threads_ == 1 || blocks == 1) {
    for (std::int64_t block = 0; block < blocks; ++block) run_block(block);
    return;
  }
  char started = 0;
  char finished = 0;
  tsan_release(&started);
  arena_->tasks.execute([&] {
    tbb::parallel_for(
        std::int64_t{0}, blocks,
        [&](std::int64_t block) {
          tsan_acquire(&started);
          run_block(block);
          tsan_release(&finished);
        },
        tbb::simple_partitioner());
  });
  tsan_acquire(&finished);
}

}  // namespace isoweave
