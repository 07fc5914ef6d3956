// The slices that a window holds, as a volume of their own.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "isoweave/volume.hpp"
#include "volume/slice_window.hpp"

namespace isoweave {

// The volume of a window, read once more from the slices that the window holds at that time.
class WindowVolume final : public SliceSource {
 public:
  // The window must outlive the volume.
  explicit WindowVolume(const SliceWindow& window) : window_(window) {}

  const VolumeInfo& info() const override { return window_.info(); }

  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    const std::size_t bytes = info().slice_bytes();
    std::byte* to = out.data();
    for (std::int64_t k = first; k < first + count; ++k, to += bytes) std::copy_n(window_.slice(k), bytes, to);
  }

 private:
  const SliceWindow& window_;
};

}  // namespace isoweave
