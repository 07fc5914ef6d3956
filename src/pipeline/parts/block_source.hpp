// The samples of a block, out of a volume that is opened for it.
#pragma once

#include <memory>
#include <vector>

#include "lattice/lattice.hpp"
#include "volume/row_source.hpp"

namespace isoweave {

class BlockSource final : public RowSource {
 public:
  // own: the samples that count for the range, as indices of the volume; empty: none do.
  BlockSource(std::unique_ptr<SliceSource> volume, const Region& samples, const Region& own);

  const VolumeInfo& info() const override { return part_->info(); }
  bool skips() const override { return part_->skips(); }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override;
  void read_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) override;
  std::uint64_t held_bytes() const override { return held_by_slices(*part_); }
  Region in_file(const Region& samples) const override { return samples_in_file(*part_, samples); }
  const SampleRange* range(std::int64_t k) const override { return &ranges_[static_cast<std::size_t>(k)]; }

 private:
  void measure_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::span<const std::byte> rows);

  std::unique_ptr<SliceSource> part_;
  RowReader rows_;
  Region own_;  // of the part
  std::vector<SampleRange> ranges_;
};

}  // namespace isoweave
