// Loops by threads of our own, where oneTBB is not there.
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "parallel/arena.hpp"
#include "system/process.hpp"

namespace isoweave {
namespace {

// One loop while it runs. Threads take the next block until there is none.
class RunningLoop {
 public:
  explicit RunningLoop(const BlockLoop& loop) : loop_(loop), blocks_(loop.blocks()) {}

  bool is_taken() const { return next_.load(std::memory_order_relaxed) >= blocks_; }

  void take_part() {
    try {
      for (std::int64_t block = next_++; block < blocks_; block = next_++) loop_.run(block);
    } catch (...) {
      next_ = blocks_;
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
    }
  }

  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

  std::size_t wanted_helpers() const { return static_cast<std::size_t>(blocks_ - 1); }

  std::size_t helpers = 0;  // at work on it; under the arena's mutex

 private:
  const BlockLoop& loop_;
  std::int64_t blocks_;
  std::atomic<std::int64_t> next_{0};
  std::mutex mutex_;
  std::exception_ptr failure_;
};

// Helpers wait for a loop, take part in it and wait for the next one. A loop does not wait for helpers that have not
// arrived: a short loop is over before they wake up.
class OwnArena final : public Arena {
 public:
  explicit OwnArena(int threads) : most_helpers_(static_cast<std::size_t>(threads - 1)) {
    helpers_.reserve(most_helpers_);
  }

  ~OwnArena() override {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    begun_.notify_all();
    for (std::thread& helper : helpers_) helper.join();
  }

  // A loop inside another one, or beside it, has its own thread only: nothing can wait for itself.
  void run(const BlockLoop& loop) override {
    RunningLoop running(loop);
    const bool helped = begin(running);
    running.take_part();
    if (helped) end(running);
    running.rethrow();
  }

 private:
  bool begin(RunningLoop& loop) {
    {
      const std::lock_guard lock(mutex_);
      if (loop_ != nullptr) return false;
      start_helpers(std::min(most_helpers_, loop.wanted_helpers()));
      loop_ = &loop;
    }
    begun_.notify_all();
    return true;
  }

  void end(const RunningLoop& loop) {
    std::unique_lock lock(mutex_);
    loop_ = nullptr;
    left_.wait(lock, [&] { return loop.helpers == 0; });
  }

  // Starts helpers. Where the system gives fewer threads, loops have fewer.
  void start_helpers(std::size_t wanted) {
    try {
      while (helpers_.size() < wanted) helpers_.emplace_back([this] { help(); });
    } catch (const std::system_error&) {
      most_helpers_ = helpers_.size();
    }
  }

  void help() {
    std::unique_lock lock(mutex_);
    while (true) {
      begun_.wait(lock, [&] { return stop_ || (loop_ != nullptr && !loop_->is_taken()); });
      if (stop_) return;
      RunningLoop& loop = *loop_;
      ++loop.helpers;
      lock.unlock();
      loop.take_part();
      lock.lock();
      if (--loop.helpers == 0) left_.notify_all();
    }
  }

  std::size_t most_helpers_;
  std::vector<std::thread> helpers_;

  std::mutex mutex_;
  std::condition_variable begun_, left_;
  RunningLoop* loop_ = nullptr;  // underway
  bool stop_ = false;
};

}  // namespace

std::shared_ptr<Arena> Arena::make(int threads) { return std::make_shared<OwnArena>(threads); }

int Arena::threads_for(int wanted) { return wanted > 0 ? wanted : system::processors(); }

}  // namespace isoweave
