// How the workers of a parallel schedule share the work that is left, and end together.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <vector>

#include "simplify/zone_view.hpp"

namespace isoweave {

// Vertices that busy workers leave to idle ones.
class WorkPool {
 public:
  // Counts one more worker as busy. A worker is not busy while it waits in take(), nor after it has left.
  void enter() {
    const std::lock_guard lock(mutex_);
    ++working_;
  }

  void leave() {
    const std::lock_guard lock(mutex_);
    if (--working_ == 0) changed_.notify_all();
  }

  bool wanted() const { return wanted_.load(std::memory_order_relaxed); }

  // Takes the older half of a busy worker's stack.
  void give(std::vector<Index>& todo) {
    const auto half = todo.begin() + static_cast<std::ptrdiff_t>(todo.size() / 2);
    {
      const std::lock_guard lock(mutex_);
      vertices_.insert(vertices_.end(), todo.begin(), half);
      wanted_ = false;
    }
    todo.erase(todo.begin(), half);
    changed_.notify_one();
  }

  // Waits for vertices to work on. Returns false when no worker is busy any more.
  bool take(std::vector<Index>& todo) {
    if (failed()) return false;
    std::unique_lock lock(mutex_);
    if (--working_ == 0) changed_.notify_all();
    ++waiting_;
    wanted_ = true;
    changed_.wait(lock, [&] { return !vertices_.empty() || working_ == 0 || failed(); });
    --waiting_;
    ++working_;
    if (vertices_.empty() || failed()) return false;
    todo.swap(vertices_);
    wanted_ = waiting_ > 0;
    return true;
  }

  // Tells the others that a worker has thrown. It may hold vertices for ever, so the others end as soon as they see
  // this.
  void fail() {
    failed_.store(true, std::memory_order_relaxed);
    const std::lock_guard lock(mutex_);
    changed_.notify_all();
  }
  bool failed() const { return failed_.load(std::memory_order_relaxed); }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Index> vertices_;
  std::size_t working_ = 0;
  std::size_t waiting_ = 0;
  std::atomic<bool> wanted_{false};  // a worker waits, and the pool is empty
  std::atomic<bool> failed_{false};
};

// The time that a worker is busy, however it ends.
struct WorkingTime {
  explicit WorkingTime(WorkPool& where) : pool(where) { pool.enter(); }
  ~WorkingTime() {
    if (std::uncaught_exceptions() > exceptions) pool.fail();
    pool.leave();
  }
  WorkingTime(const WorkingTime&) = delete;
  WorkingTime& operator=(const WorkingTime&) = delete;

  WorkPool& pool;
  const int exceptions = std::uncaught_exceptions();
};

}  // namespace isoweave
