#include "volume/row_source.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "isoweave/error.hpp"

namespace isoweave {

void RowSource::read_part_of_row(std::int64_t, std::int64_t, std::int64_t, std::span<std::byte>) {
  throw std::logic_error("this volume has no parts of rows");
}

RowReader::RowReader(SliceSource& volume) : volume_(volume), rows_(dynamic_cast<RowSource*>(&volume)) {}

void RowReader::read(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) {
  if (rows_ != nullptr) return rows_->read_rows(k, first, count, out);
  const VolumeInfo& info = volume_.info();
  if (count == info.dims[1]) return volume_.read(k, 1, out);
  if (held_ != k) {
    slice_.resize(info.slice_bytes());
    volume_.read(k, 1, slice_);
    held_ = k;
  }
  const std::size_t row = static_cast<std::size_t>(info.dims[0]) * sample_bytes(info.type);
  const auto from = slice_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(first) * row);
  std::copy_n(from, static_cast<std::size_t>(count) * row, out.begin());
}

std::uint64_t held_by_rows(const SliceSource& volume) {
  const bool holds_slice = dynamic_cast<const RowSource*>(&volume) == nullptr && volume.held().empty();
  return held_by_slices(volume) + (holds_slice ? volume.info().slice_bytes() : 0);
}

std::uint64_t held_by_slices(const SliceSource& volume) {
  const auto* buffered = dynamic_cast<const BufferedSource*>(&volume);
  return buffered != nullptr ? buffered->held_bytes() : 0;
}

Region samples_in_file(const SliceSource& volume, const Region& samples) {
  const auto* buffered = dynamic_cast<const BufferedSource*>(&volume);
  return buffered != nullptr ? buffered->in_file(samples) : samples;
}

std::string sample_in_file(const SliceSource& volume, const std::array<std::int64_t, 3>& sample) {
  const Region samples = samples_in_file(volume, {sample, {sample[0] + 1, sample[1] + 1, sample[2] + 1}});
  bool is_one = true;
  for (std::size_t axis = 0; axis < 3; ++axis) is_one = is_one && samples.end[axis] - samples.first[axis] == 1;
  std::string text = is_one ? "sample " : "samples ";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis > 0) text += ",";
    text += std::to_string(samples.first[axis]);
    if (!is_one) text += ":" + std::to_string(samples.end[axis]);
  }
  return text;
}

void require_skipping(const SliceSource& volume) {
  if (volume.skips()) return;
  throw BadInput(volume.info().path +
                 ": expected a volume that can be read anywhere, for blocks, found one that has "
                 "to be read from its beginning: unpack it first");
}

std::optional<SampleBytes> constant_sample(const SliceSource& volume) {
  const auto* rows = dynamic_cast<const RowSource*>(&volume);
  return rows != nullptr ? rows->constant() : std::nullopt;
}

const SampleRange* known_range(const SliceSource& volume, std::int64_t k) {
  const auto* rows = dynamic_cast<const RowSource*>(&volume);
  return rows != nullptr ? rows->range(k) : nullptr;
}

std::optional<std::uint32_t> known_crc(const SliceSource& volume, std::int64_t k) {
  const auto* rows = dynamic_cast<const RowSource*>(&volume);
  return rows != nullptr ? rows->crc(k) : std::nullopt;
}

}  // namespace isoweave
