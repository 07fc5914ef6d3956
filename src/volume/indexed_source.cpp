#include "volume/indexed_source.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "parallel/size.hpp"
#include "volume/gaps.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

// Fewer bytes are read rather than skipped: asking for the next ones would take as long.
constexpr std::size_t kLeastGap = std::size_t{1} << 15;

Gaps* gaps_of(RowSource* rows) { return rows != nullptr ? rows->gaps() : nullptr; }

const VolumeIndex& checked_index(const VolumeIndex& index, const VolumeInfo& volume) {
  require_index_of(index, volume);
  return index;
}

}  // namespace

IndexedSource::IndexedSource(SliceSource& volume, std::shared_ptr<const VolumeIndex> index,
                             std::span<const IndexedSurface> surfaces)
    : volume_(volume),
      rows_(dynamic_cast<RowSource*>(&volume)),
      reader_(volume),
      gaps_(gaps_of(rows_)),
      index_(std::move(index)),
      bricks_(checked_index(*index_, volume.info()), surfaces),
      sample_bytes_(sample_bytes(info().type)),
      row_bytes_(to_size(info().dims[0], sample_bytes_)) {
  if (gaps_ != nullptr) gaps_->needed = &bricks_;
}

IndexedSource::~IndexedSource() {
  if (gaps_ != nullptr) gaps_->needed = nullptr;
}

void IndexedSource::read(std::int64_t first, std::int64_t count, std::span<std::byte> out) {
  const bool by_rows = gaps_ == nullptr && rows_ != nullptr && rows_->skips();
  if (!by_rows) volume_.read(first, count, out);
  if (!by_rows && gaps_ == nullptr) return;
  const std::size_t slice = info().slice_bytes();
  for (std::int64_t n = 0; n < count; ++n) {
    std::byte* const to = out.data() + static_cast<std::size_t>(n) * slice;
    if (by_rows) {
      read_needed_rows(first + n, 0, info().dims[1], to);
    } else {
      fill(first + n, 0, info().dims[1], to);
    }
  }
}

void IndexedSource::read_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) {
  if (gaps_ == nullptr && rows_ != nullptr && rows_->skips()) return read_needed_rows(k, first, count, out.data());
  reader_.read(k, first, count, out);
  if (gaps_ != nullptr) fill(k, first, count, out.data());
}

// Puts samples on the right side where a chunk may have been left out.
void IndexedSource::fill(std::int64_t k, std::int64_t first, std::int64_t count, std::byte* out) {
  for (std::int64_t j = first; j < first + count; ++j, out += row_bytes_) {
    for (const UnneededRun& run : bricks_.unneeded(j, k)) fill_run(run, out);
  }
}

void IndexedSource::fill_run(const UnneededRun& run, std::byte* row) const {
  std::byte* to = row + static_cast<std::size_t>(run.begin) * sample_bytes_;
  std::byte* const end = row + static_cast<std::size_t>(run.end) * sample_bytes_;
  if (sample_bytes_ == 1) {
    std::fill(to, end, run.sample[0]);
    return;
  }
  for (; to < end; to += sample_bytes_) std::memcpy(to, run.sample.data(), sample_bytes_);
}

bool IndexedSource::is_unneeded(std::int64_t j, std::int64_t k) {
  const std::span<const UnneededRun> runs = bricks_.unneeded(j, k);
  return runs.size() == 1 && runs[0].begin == 0 && runs[0].end == info().dims[0];
}

// Reads runs of rows, and fills in long runs of rows without a needed sample.
void IndexedSource::read_needed_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::byte* out) {
  const std::int64_t end = first + count;
  std::int64_t pending = first;  // rows from here to `j` are to be read
  const auto place = [&](std::int64_t j) { return out + static_cast<std::size_t>(j - first) * row_bytes_; };
  const auto read_pending = [&](std::int64_t to) {
    if (to == pending) return;
    const std::span<std::byte> bytes(place(pending), static_cast<std::size_t>(to - pending) * row_bytes_);
    rows_->read_rows(k, pending, to - pending, bytes);
  };
  for (std::int64_t j = first; j < end;) {
    std::int64_t gap = j;
    while (gap < end && is_unneeded(gap, k)) ++gap;
    const bool is_long = static_cast<std::size_t>(gap - j) * row_bytes_ >= kLeastGap || gap - j == count;
    if (gap > j && is_long) {
      read_pending(j);
      for (std::int64_t n = j; n < gap; ++n) fill_run(bricks_.unneeded(n, k)[0], place(n));
      rows_left_out_ += static_cast<std::uint64_t>(gap - j);
      pending = gap;
    }
    j = std::max(gap, j + 1);
  }
  read_pending(end);
}

std::uint64_t IndexedSource::held_bytes() const { return held_by_rows(volume_); }

const SampleRange* IndexedSource::range(std::int64_t k) const {
  return &index_->slices()[static_cast<std::size_t>(k)].range;
}

std::optional<std::uint32_t> IndexedSource::crc(std::int64_t k) const {
  return index_->slices()[static_cast<std::size_t>(k)].crc;
}

LeftOut IndexedSource::left_out() const {
  if (gaps_ == nullptr) return {0, 0, rows_left_out_ * row_bytes_};
  return {gaps_->chunks, gaps_->chunks_left_out, gaps_->samples_left_out * sample_bytes_};
}

}  // namespace isoweave
