#include "parallel/parallel.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>

#include "parallel/arena.hpp"
#include "parallel/float_environment.hpp"

namespace isoweave {
namespace {

int checked_threads(int threads) {
  if (threads < 0 || threads > Executor::kMostThreads) {
    throw std::invalid_argument("threads: expected 0 to " + std::to_string(Executor::kMostThreads) + ", found " +
                                std::to_string(threads));
  }
  return std::clamp(Arena::threads_for(threads), 1, Executor::kMostThreads);
}

}  // namespace

void BlockLoop::run(std::int64_t block) const {
  std::optional<StandardFloats> floats;  // of this thread
  if (!has_standard_floats()) floats.emplace();
  call_(body_, block * grain_, std::min(count_, (block + 1) * grain_));
}

Executor::Executor(int threads)
    : threads_(checked_threads(threads)), arena_(threads_ > 1 ? Arena::make(threads_) : nullptr) {}

bool Executor::has_threads() { return Arena::threads_for(2) > 1; }

void Executor::run(std::int64_t count, std::int64_t grain, void* body, BlockFunction call) const {
  if (count <= 0) return;
  const BlockLoop loop(count, grain, body, call);
  if (arena_ != nullptr && loop.blocks() > 1) return arena_->run(loop);
  for (std::int64_t block = 0; block < loop.blocks(); ++block) loop.run(block);
}

}  // namespace isoweave
