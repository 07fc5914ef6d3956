// A label of a map as a volume of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "isoweave/label.hpp"
#include "isoweave/volume.hpp"
#include "volume/slice_window.hpp"

namespace isoweave {

// The mask of a label in a box of the map, read from the slices that a window holds.
class LabelBox final : public SliceSource {
 public:
  LabelBox(const SliceWindow& map, const Region& box, Label label);

  const VolumeInfo& info() const override { return info_; }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override;

  std::int64_t first_slice() const { return box_.first[2]; }

 private:
  const SliceWindow& map_;
  Region box_;
  Label label_;
  VolumeInfo info_;
};

}  // namespace isoweave
