// The field whose surface is extracted: the samples of a volume, or the smoothed field of its mask.
#pragma once

#include <cstdint>
#include <optional>

#include "extract/cube_rules.hpp"
#include "isoweave/mesh_options.hpp"
#include "parallel/parallel.hpp"
#include "volume/row_source.hpp"
#include "volume/smoothed_mask.hpp"

namespace isoweave {

class SurfaceField {
 public:
  // measure: find the range of the samples of a volume that is smoothed. The volume and the executor must outlive the
  // field. Throws std::invalid_argument for an iso-value that is not finite and for passes out of range.
  SurfaceField(SliceSource& volume, const SurfaceOptions& options, const Executor& executor, bool measure);

  SliceSource& source() { return smoothed_ ? *smoothed_ : volume_; }
  const VolumeInfo& info() const { return smoothed_ ? smoothed_->info() : volume_.info(); }
  const IsoRule& rule() const { return rule_; }

  // The number of slices of the field that can be read once the slices of the volume below `end` can.
  std::int64_t slices_from(std::int64_t end) const;

  // The range of the samples of slice k of the volume, where an index tells it, or the volume is smoothed and measured.
  const SampleRange* range(std::int64_t k) const {
    const SampleRange* const known = known_range(volume_, k);
    return known == nullptr && smoothed_ ? smoothed_->range(k) : known;
  }

  // The CRC-32 of slice k of the field, where an index tells it: the samples that are read may stand for others.
  std::optional<std::uint32_t> crc(std::int64_t k) const { return smoothed_ ? std::nullopt : known_crc(volume_, k); }

  // The most bytes that a field holds.
  static std::uint64_t memory(const VolumeInfo& volume, const SurfaceOptions& options);

  // The description that a field will have.
  static VolumeInfo info_of(const VolumeInfo& volume, const SurfaceOptions& options);

 private:
  SliceSource& volume_;
  IsoRule rule_;
  std::optional<SmoothedMask> smoothed_;
};

}  // namespace isoweave
