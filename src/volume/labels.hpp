// Label maps: their values as whole numbers, and as masks.
#pragma once

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
  // The map must outlive the source. Throws BadInput where slope or intercept are not whole numbers.
  explicit LabelNumbers(SliceSource& map);

  const VolumeInfo& info() const override { return info_; }
  bool skips() const override { return map_.skips(); }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override;
  std::span<const std::byte> held() const override;
  std::uint64_t held_bytes() const override {
    return held_by_slices(map_) + (is_plain() ? 0 : map_.info().slice_bytes());
  }
  Region in_file(const Region& samples) const override { return samples_in_file(map_, samples); }

 private:
  bool is_plain() const { return info_.type == map_.info().type; }

  SliceSource& map_;
  VolumeInfo info_;
  std::vector<std::byte> slice_;  // as stored, where it is to become integers
};

// Sets `mask` to 1 where a sample of a row is the label, and to 0 elsewhere. Samples are integers.
void mask_row(const std::byte* samples, SampleType type, std::int64_t count, Label label, std::uint8_t* mask);

}  // namespace isoweave
