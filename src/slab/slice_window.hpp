// The run of consecutive slices that a slab needs, read forward from a source.
#pragma once

#include <cstddef>
#include <cstdint>

#include "isoweave/volume.hpp"
#include "parallel/array.hpp"

namespace isoweave {

// Holds slices [first, end) in the file's own sample type. Memory: (end - first) * slice_bytes.
class SliceWindow {
 public:
  explicit SliceWindow(SliceSource& source) : source_(source), slice_bytes_(source.info().slice_bytes()) {}

  const VolumeInfo& info() const { return source_.info(); }
  std::int64_t end() const { return end_; }
  std::uint64_t bytes() const { return buffer_.capacity(); }

  // Drops slices before `first` and reads on up to `end`, both clipped to the volume. Windows only move forward.
  // Returns the number of slices read; they are the last ones held.
  std::int64_t advance(std::int64_t first, std::int64_t end);

  // Samples of slice k, which must be held.
  const std::byte* slice(std::int64_t k) const {
    return buffer_.data() + static_cast<std::size_t>(k - first_) * slice_bytes_;
  }

 private:
  SliceSource& source_;
  std::size_t slice_bytes_;
  Array<std::byte> buffer_;
  std::int64_t first_ = 0;
  std::int64_t end_ = 0;
};

}  // namespace isoweave
