// The seam between Executor and whatever runs its loops: tbb.cpp, own_threads.cpp or no_threads.cpp, of which one is
// compiled (ISOWEAVE_THREADS).
#pragma once

#include <cstdint>
#include <memory>

namespace isoweave {

// The blocks of one loop.
class BlockLoop {
 public:
  using Function = void (*)(void*, std::int64_t, std::int64_t);

  BlockLoop(std::int64_t count, std::int64_t grain, void* body, Function call)
      : count_(count), grain_(grain), body_(body), call_(call) {}

  std::int64_t blocks() const { return (count_ + grain_ - 1) / grain_; }

  // Runs one block in the calling thread, with standard floating-point arithmetic.
  void run(std::int64_t block) const;

 private:
  std::int64_t count_, grain_;
  void* body_;
  Function call_;
};

// Threads that run loops together with the caller.
class Arena {
 public:
  Arena() = default;
  virtual ~Arena() = default;
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  // Runs every block, then returns. Once a block has thrown, no other is begun, and the exception is rethrown when the
  // running blocks have ended. May be called from a block, and from several threads.
  virtual void run(const BlockLoop& loop) = 0;

  // An arena of so many threads, more than one, the caller's among them.
  static std::shared_ptr<Arena> make(int threads);

  // The number of threads for a caller who wants so many; 0 wants one per processor.
  static int threads_for(int wanted);
};

}  // namespace isoweave
