// The samples of a window, as extraction reads them.
#pragma once

#include <array>
#include <cstdint>

#include "extract/gradient.hpp"
#include "slab/slice_window.hpp"

namespace isoweave {

// Read access to the samples a window holds; NaN outside the volume.
template <class T>
class SampleView {
 public:
  explicit SampleView(const SliceWindow& window) : window_(window), dims_(window.info().dims) {}

  SampleRow<T> row(std::int64_t j, std::int64_t k) const {
    if (j < 0 || k < 0 || j >= dims_[1] || k >= dims_[2]) return {};
    return {reinterpret_cast<const T*>(window_.slice(k)) + j * dims_[0], dims_[0]};
  }

 private:
  const SliceWindow& window_;
  std::array<std::int64_t, 3> dims_;
};

}  // namespace isoweave
