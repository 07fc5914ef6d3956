#include "slab/slice_window.hpp"

#include <algorithm>
#include <cstring>
#include <span>

namespace isoweave {

std::int64_t SliceWindow::advance(std::int64_t first, std::int64_t end) {
  const VolumeInfo& volume = source_.info();
  first = std::clamp(first, first_, end_);
  end = std::clamp(end, end_, volume.dims[2]);
  const std::size_t bytes = volume.slice_bytes();
  const std::size_t kept = static_cast<std::size_t>(end_ - first) * bytes;
  if (first > first_ && kept > 0) {
    std::memmove(buffer_.data(), buffer_.data() + static_cast<std::size_t>(first - first_) * bytes, kept);
  }
  const std::int64_t count = end - end_;
  buffer_.resize(kept + static_cast<std::size_t>(count) * bytes);
  if (count > 0) source_.read(end_, count, std::span(buffer_.data(), buffer_.size()).subspan(kept));
  first_ = first;
  end_ = end;
  return count;
}

}  // namespace isoweave
