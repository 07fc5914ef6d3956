// The view that extraction has of the samples of a window.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "extract/gradient.hpp"
#include "volume/slice_window.hpp"
#include "volume/threshold.hpp"

namespace isoweave {

// Read access to the samples of a window; NaN outside the volume. Integers of 64 bits are counted from the whole number
// below `iso`, so that no sample near the iso-value is rounded.
template <class T>
class SampleView {
 public:
  explicit SampleView(const SliceWindow& window, double iso = 0)
      : window_(window), dims_(window.info().dims), iso_(iso) {
    if constexpr (kIsWide<T>) {
      base_.base = nearest_integer<T>(std::floor(iso));
      iso_ = iso - static_cast<double>(base_.base);
    }
  }

  // The iso-value, counted as the samples of rows are.
  double iso() const { return iso_; }

  // Whether there are samples at an index along an axis.
  bool reaches(std::size_t axis, std::int64_t at) const { return at >= 0 && at < dims_[axis]; }

  SampleRow<T> row(std::int64_t j, std::int64_t k) const {
    if (j < 0 || k < 0 || j >= dims_[1] || k >= dims_[2]) return {};
    return {reinterpret_cast<const T*>(window_.slice(k)) + j * dims_[0], dims_[0], base_};
  }

 private:
  const SliceWindow& window_;
  std::array<std::int64_t, 3> dims_;
  double iso_;
  [[no_unique_address]] SampleBase<T> base_{};
};

}  // namespace isoweave
