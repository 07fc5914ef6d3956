#include "volume/label_box.hpp"

#include "volume/labels.hpp"

namespace isoweave {

LabelBox::LabelBox(const SliceWindow& map, const Region& box, Label label)
    : map_(map), box_(box), label_(label), info_(map.info()) {
  info_.type = SampleType::kUint8;
  for (std::size_t axis = 0; axis < 3; ++axis) info_.dims[axis] = box.end[axis] - box.first[axis];
}

void LabelBox::read(std::int64_t first, std::int64_t count, std::span<std::byte> out) {
  const VolumeInfo& map = map_.info();
  const std::int64_t bytes = static_cast<std::int64_t>(sample_bytes(map.type));
  auto* mask = reinterpret_cast<std::uint8_t*>(out.data());
  for (std::int64_t k = first; k < first + count; ++k) {
    const std::byte* const slice = map_.slice(box_.first[2] + k);
    for (std::int64_t j = box_.first[1]; j < box_.end[1]; ++j, mask += info_.dims[0]) {
      mask_row(slice + (j * map.dims[0] + box_.first[0]) * bytes, map.type, info_.dims[0], label_, mask);
    }
  }
}

}  // namespace isoweave
