// The window: the consecutive slices that a slab needs, read forward from a source by a thread of its own.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <span>
#include <thread>

#include "isoweave/volume.hpp"
#include "parallel/array.hpp"

namespace isoweave {

// Holds slices [first, end) in the file's own sample type, while some more behind them are read. Slices lie in a ring.
// If the source holds all slices in memory, they are used there and nothing is read. Memory: bytes().
class SliceWindow {
 public:
  enum class Reading : std::uint8_t { kAhead, kInPlace };  // by a thread of its own; by advance(), and nothing ahead

  // The way to read for a caller with so many threads: a caller with one thread starts no other.
  static Reading reading_with(int threads) { return threads > 1 ? Reading::kAhead : Reading::kInPlace; }

  // Reads the source from slice `first` on. In a build without threads the source is read in place.
  explicit SliceWindow(SliceSource& source, std::int64_t first = 0, Reading reading = Reading::kAhead);
  ~SliceWindow();
  SliceWindow(const SliceWindow&) = delete;
  SliceWindow& operator=(const SliceWindow&) = delete;

  const VolumeInfo& info() const { return source_.info(); }
  std::int64_t end() const { return end_; }
  std::uint64_t bytes() const { return buffer_.capacity(); }
  std::int64_t room() const { return held_.empty() ? room_ : 0; }  // slices in the ring

  // Drops slices before `first` and waits for those up to `end`, both clipped to the volume. Afterwards `ahead` slices
  // more are read while the caller works. Windows only move forward. Returns the number of slices that are new in the
  // window; they are the last ones held. Throws what the source threw when the slices concerned are asked for. Only the
  // new slices are missing then.
  std::int64_t advance(std::int64_t first, std::int64_t end, std::int64_t ahead = 0);

  // Samples of slice k, which must be held.
  const std::byte* slice(std::int64_t k) const {
    return held_.empty() ? place(k) : held_.data() + static_cast<std::size_t>(k) * slice_bytes_;
  }

 private:
  std::byte* place(std::int64_t k) const {
    return const_cast<std::byte*>(buffer_.data()) + static_cast<std::size_t>((k - base_) % room_) * slice_bytes_;
  }
  void wait_for(std::int64_t end, std::int64_t last, std::unique_lock<std::mutex>& lock);
  void make_room(std::int64_t slices, std::unique_lock<std::mutex>& lock);
  void read_on();
  bool can_read() const;
  void read_run(std::unique_lock<std::mutex>& lock);

  SliceSource& source_;
  std::span<const std::byte> held_;  // by the source
  Reading how_;
  std::size_t slice_bytes_;
  std::int64_t slices_;  // of the volume

  // Changed under the mutex; buffer and room only while the reader does not read.
  Array<std::byte> buffer_;
  std::int64_t room_ = 1;    // slices in the ring
  std::int64_t base_;        // a slice that lies at the ring's beginning
  std::int64_t first_;       // the first slice held
  std::int64_t end_;         // of the window
  std::int64_t filled_;      // slices below are in the ring
  std::int64_t needed_ = 0;  // slices below are waited for
  std::int64_t wanted_ = 0;  // slices below are to be read
  bool reading_ = false;
  bool growing_ = false;
  bool stop_ = false;
  std::exception_ptr failure_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::thread reader_;
};

}  // namespace isoweave
