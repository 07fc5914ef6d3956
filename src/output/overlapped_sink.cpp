#include "output/overlapped_sink.hpp"

namespace isoweave {

OverlappedSink::~OverlappedSink() {
  if (!worker_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  worker_.join();
}

void OverlappedSink::append(const MeshPiece& piece) {
  if (!overlaps_) return sink_.append(piece);
  wait();
  {
    const std::lock_guard lock(mutex_);
    piece_ = [this, piece] { sink_.append(piece); };
  }
  if (!worker_.joinable()) worker_ = std::thread([this] { work(); });
  changed_.notify_all();
}

void OverlappedSink::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !piece_; });
  if (failure_) std::rethrow_exception(failure_);
}

void OverlappedSink::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return stop_ || piece_; });
    if (!piece_) return;
    lock.unlock();
    std::exception_ptr failure;
    try {
      piece_();
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    piece_ = nullptr;
    failure_ = failure;
    changed_.notify_all();
  }
}

}  // namespace isoweave
