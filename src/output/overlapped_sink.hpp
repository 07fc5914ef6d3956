// A mesh sink at work while the next piece is made.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

#include "isoweave/mesh.hpp"

namespace isoweave {

// Hands pieces to a sink in a thread of its own, one after the other.
class OverlappedSink {
 public:
  // overlaps: false does everything in the calling thread.
  OverlappedSink(MeshSink& sink, bool overlaps) : sink_(sink), overlaps_(overlaps) {}
  ~OverlappedSink();
  OverlappedSink(const OverlappedSink&) = delete;
  OverlappedSink& operator=(const OverlappedSink&) = delete;

  // Waits for the piece before this one, and returns while the sink takes this one. The spans must stay valid until the
  // next call of append() or wait() has returned. Throws what the sink threw at the piece before.
  void append(const MeshPiece& piece);

  // Returns when the sink has received everything. Throws what it threw.
  void wait();

 private:
  void work();

  MeshSink& sink_;
  bool overlaps_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> piece_;  // underway, or empty
  std::exception_ptr failure_;
  bool stop_ = false;
  std::thread worker_;
};

}  // namespace isoweave
