// The whole of what the passes need from threads: run a loop over disjoint blocks.
#pragma once

#include <cstdint>
#include <memory>
#include <type_traits>

namespace isoweave {

class Arena;

// How many threads a pass may use. Passes give the same result for any number.
class Executor {
 public:
  static constexpr int kMostThreads = 4096;

  // threads: 0 for one per processor, 1 to run everything in the calling thread. Throws std::invalid_argument for
  // numbers outside 0 to kMostThreads. In a build without threads any number stands for 1.
  explicit Executor(int threads = 0);

  int threads() const { return threads_; }

  // Whether this build may start threads at all.
  static bool has_threads();

  // Calls body(begin, end) for consecutive ranges that cover [0, count), of `grain` elements each but the last,
  // in any order and at the same time. The ranges depend on count and grain only, never on the number of
  // threads. An exception thrown by a body is rethrown here once every running body has ended.
  template <class Body>
  void for_blocks(std::int64_t count, std::int64_t grain, Body&& body) const {
    run(count, grain, const_cast<void*>(static_cast<const void*>(&body)),
        [](void* erased, std::int64_t begin, std::int64_t end) {
          (*static_cast<std::remove_reference_t<Body>*>(erased))(begin, end);
        });
  }

  // Calls body(i) for every i in [0, count).
  template <class Body>
  void for_each(std::int64_t count, std::int64_t grain, Body&& body) const {
    for_blocks(count, grain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i) body(i);
    });
  }

 private:
  using BlockFunction = void (*)(void*, std::int64_t, std::int64_t);
  void run(std::int64_t count, std::int64_t grain, void* body, BlockFunction call) const;

  int threads_;
  std::shared_ptr<Arena> arena_;  // of worker threads; shared by copies, none for one thread
};

}  // namespace isoweave
