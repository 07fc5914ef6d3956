#include "pipeline/parts/block_source.hpp"

#include <algorithm>
#include <utility>

namespace isoweave {

BlockSource::BlockSource(std::unique_ptr<SliceSource> volume, const Region& samples, const Region& own)
    : part_(crop_volume(std::move(volume), samples)),
      rows_(*part_),
      own_(own),
      ranges_(static_cast<std::size_t>(part_->info().dims[2])) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    own_.first[axis] -= samples.first[axis];
    own_.end[axis] -= samples.first[axis];
  }
}

void BlockSource::read(std::int64_t first, std::int64_t count, std::span<std::byte> out) {
  part_->read(first, count, out);
  const std::size_t slice = info().slice_bytes();
  for (std::int64_t k = first; k < first + count; ++k, out = out.subspan(slice))
    measure_rows(k, 0, info().dims[1], out);
}

void BlockSource::read_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) {
  rows_.read(k, first, count, out);
  measure_rows(k, first, count, out);
}

void BlockSource::measure_rows(std::int64_t k, std::int64_t first, std::int64_t count,
                               std::span<const std::byte> rows) {
  if (k < own_.first[2] || k >= own_.end[2] || own_.first[0] >= own_.end[0]) return;
  const std::size_t sample = sample_bytes(info().type);
  const std::size_t row = static_cast<std::size_t>(info().dims[0]) * sample;
  for (std::int64_t j = std::max(first, own_.first[1]); j < std::min(first + count, own_.end[1]); ++j) {
    const std::byte* const from = rows.data() + static_cast<std::size_t>(j - first) * row;
    ranges_[static_cast<std::size_t>(k)].merge(sample_range(from + static_cast<std::size_t>(own_.first[0]) * sample,
                                                            info().type, own_.end[0] - own_.first[0]));
  }
}

}  // namespace isoweave
