#include "volume/slice_window.hpp"

#include <algorithm>
#include <cstring>
#include <span>

#include "parallel/parallel.hpp"
#include "parallel/size.hpp"

namespace isoweave {
namespace {

// The reader looks up after so many bytes, so nobody waits longer for it to end.
constexpr std::size_t kRunBytes = std::size_t{8} << 20;

}  // namespace

SliceWindow::SliceWindow(SliceSource& source, std::int64_t first, Reading reading)
    : source_(source),
      held_(source.held()),
      how_(Executor::has_threads() ? reading : Reading::kInPlace),
      slice_bytes_(source.info().slice_bytes()),
      slices_(source.info().dims[2]),
      base_(std::clamp<std::int64_t>(first, 0, slices_)),
      first_(base_),
      end_(first_),
      filled_(first_) {}

SliceWindow::~SliceWindow() {
  if (!reader_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  reader_.join();
}

std::int64_t SliceWindow::advance(std::int64_t first, std::int64_t end, std::int64_t ahead) {
  std::unique_lock lock(mutex_);
  const std::int64_t new_end = std::clamp(end, end_, slices_);
  const std::int64_t last = how_ == Reading::kAhead ? std::clamp(new_end + ahead, new_end, slices_) : new_end;
  first_ = std::clamp(first, first_, end_);
  const std::int64_t count = new_end - end_;
  if (held_.empty()) wait_for(new_end, last, lock);
  end_ = new_end;
  return count;
}

// Asks the reader for the slices below `end`, and for those up to `last` after them, and waits for the former.
void SliceWindow::wait_for(std::int64_t end, std::int64_t last, std::unique_lock<std::mutex>& lock) {
  if (last - first_ > room_ || buffer_.empty()) make_room(std::max<std::int64_t>(last - first_, 1), lock);
  needed_ = end;
  wanted_ = last;
  while (how_ == Reading::kInPlace && can_read()) read_run(lock);
  if (!reader_.joinable() && filled_ < wanted_ && !failure_) reader_ = std::thread([this] { read_on(); });
  changed_.notify_all();
  changed_.wait(lock, [&] { return filled_ >= end || failure_; });
  if (filled_ < end) std::rethrow_exception(failure_);
}

// Enlarges the ring in place, as two rings at a time would be the peak of a run. Slices that had wrapped around to the
// beginning of the ring move behind the others, as far as there is room now.
void SliceWindow::make_room(std::int64_t slices, std::unique_lock<std::mutex>& lock) {
  growing_ = true;
  changed_.wait(lock, [&] { return !reading_; });
  const std::int64_t at = room_ > 0 ? (first_ - base_) % room_ : 0;
  const std::int64_t wrapped = std::max<std::int64_t>(at + (filled_ - first_) - room_, 0);
  const std::int64_t behind = std::min(wrapped, slices - room_);
  const auto bytes = [&](std::int64_t count) { return to_size(count, slice_bytes_); };
  buffer_.resize(bytes(slices));
  if (wrapped > 0) {
    std::memcpy(buffer_.data() + bytes(room_), buffer_.data(), bytes(behind));
    std::memmove(buffer_.data(), buffer_.data() + bytes(behind), bytes(wrapped - behind));
  }
  base_ = first_ - at;
  room_ = slices;
  growing_ = false;
}

bool SliceWindow::can_read() const { return filled_ < wanted_ && filled_ < first_ + room_ && !growing_ && !failure_; }

void SliceWindow::read_on() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return stop_ || can_read(); });
    if (stop_) return;
    read_run(lock);
    changed_.notify_all();
  }
}

// Reads the next slices, as far as they lie side by side in the ring. Slices that the caller waits for are read on
// their own, so that later slices cannot delay them.
void SliceWindow::read_run(std::unique_lock<std::mutex>& lock) {
  const auto most = std::max<std::int64_t>(static_cast<std::int64_t>(kRunBytes / slice_bytes_), 1);
  const std::int64_t wanted = filled_ < needed_ ? needed_ : wanted_;
  const std::int64_t end =
      std::min({wanted, first_ + room_, filled_ + most, filled_ + room_ - (filled_ - base_) % room_});
  const std::int64_t count = end - filled_;
  const std::span<std::byte> run(place(filled_), static_cast<std::size_t>(count) * slice_bytes_);
  reading_ = true;
  lock.unlock();
  std::exception_ptr failure;
  try {
    source_.read(filled_, count, run);
  } catch (...) {
    failure = std::current_exception();
  }
  lock.lock();
  reading_ = false;
  failure_ = failure;
  if (!failure) filled_ += count;
}

}  // namespace isoweave
