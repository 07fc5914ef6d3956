// Label maps: their values as whole numbers, and as masks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "isoweave/volume.hpp"
#include "volume/row_source.hpp"

namespace isoweave {

// The values of a label map as integers without a scaling. A map of such integers gives its samples as they are. Floats
// and scaled integers become int64, and each of them is checked: a value that is no whole number, or that a float
// cannot tell from its neighbours, is BadInput with its place.
class LabelNumbers final : public BufferedSource {
 public:
  // volume: the map, or the part of it that begins at `first`. It must outlive the source. Throws BadInput where slope
  // or intercept are not whole numbers.
  explicit LabelNumbers(SliceSource& volume, const std::array<std::int64_t, 3>& first = {0, 0, 0});

  const VolumeInfo& info() const override { return info_; }
  bool skips() const override { return volume_.skips(); }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override;
  std::span<const std::byte> held() const override;
  std::uint64_t held_bytes() const override {
    return held_by_slices(volume_) + (is_plain() ? 0 : volume_.info().slice_bytes());
  }

 private:
  bool is_plain() const { return info_.type == volume_.info().type; }

  SliceSource& volume_;
  const std::array<std::int64_t, 3> first_;
  VolumeInfo info_;
  std::vector<std::byte> slice_;  // as stored, where it is to become integers
};

// Sets `mask` to 1 where a sample of a row is the label, and to 0 elsewhere. Samples are integers.
void mask_row(const std::byte* samples, SampleType type, std::int64_t count, Label label, std::uint8_t* mask);

}  // namespace isoweave
