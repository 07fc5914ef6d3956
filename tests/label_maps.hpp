// Label maps for tests: integers in memory.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "isoweave/generate.hpp"
#include "isoweave/volume.hpp"

namespace isoweave::testing {

using Labels = std::vector<std::uint16_t>;

// Reads like a file: forward, and each slice once.
class LabelMap final : public SliceSource {
 public:
  LabelMap(std::array<std::int64_t, 3> dims, Labels labels) : labels_(std::move(labels)) {
    info_.path = "labels";
    info_.format = "memory";
    info_.dims = dims;
    info_.type = SampleType::kUint16;
  }

  const VolumeInfo& info() const override { return info_; }
  VolumeInfo& info() { return info_; }

  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    if (first < next_ || first + count > info_.dims[2]) throw std::invalid_argument("not forward, or outside");
    next_ = first + count;
    slices_read += count;
    std::memcpy(out.data(), labels_.data() + first * info_.slice_samples(),
                static_cast<std::size_t>(count) * info_.slice_bytes());
  }

  std::int64_t slices_read = 0;

 private:
  VolumeInfo info_;
  Labels labels_;
  std::int64_t next_ = 0;
};

// Blobs of labels 1, 2 and 300 that touch each other and the border, a block of label 7 in a corner, a block of label 9
// far from where every axis begins, and background.
inline Labels touching_blobs(const std::array<std::int64_t, 3>& dims) {
  GenerateOptions options;
  options.kind = "noise";
  options.dims = dims;
  options.type = SampleType::kUint8;
  const auto source = generate_volume(options);
  std::vector<std::uint8_t> values(static_cast<std::size_t>(dims[0] * dims[1] * dims[2]));
  source->read(0, dims[2], std::as_writable_bytes(std::span(values)));
  std::vector<std::uint8_t> sorted = values;
  std::ranges::sort(sorted);
  const auto share = [&](std::size_t part) { return sorted[sorted.size() * part / 10]; };
  Labels labels;
  for (const std::uint8_t value : values) {
    labels.push_back(value < share(3) ? 0 : value < share(6) ? 1 : value < share(8) ? 2 : 300);
  }
  for (std::int64_t k = dims[2] - 4; k < dims[2]; ++k) {
    for (std::int64_t j = 0; j < 3; ++j) {
      std::fill_n(labels.begin() + (k * dims[1] + j) * dims[0], 5, std::uint16_t{7});
    }
  }
  for (std::int64_t k = dims[2] - 9; k < dims[2] - 3; ++k) {
    for (std::int64_t j = dims[1] - 7; j < dims[1] - 2; ++j) {
      std::fill_n(labels.begin() + (k * dims[1] + j + 1) * dims[0] - 6, 5, std::uint16_t{9});
    }
  }
  return labels;
}

}  // namespace isoweave::testing
