// The field whose surface is extracted: the samples of a volume, or those of its mask made smooth.
#pragma once

#include <cstdint>
#include <optional>

#include "extract/cube_rules.hpp"
#include "isoweave/mesh_options.hpp"
#include "parallel/parallel.hpp"
#include "volume/smoothed_mask.hpp"

namespace isoweave {

class SurfaceField {
 public:
  // measure: find the range of the samples of a volume that is smoothed. The volume and the executor are used as long
  // as this is. Throws std::invalid_argument for an iso-value that is not finite and for passes out of range.
  SurfaceField(SliceSource& volume, const SurfaceOptions& options, const Executor& executor, bool measure);

  SliceSource& source() { return smoothed_ ? *smoothed_ : volume_; }
  const VolumeInfo& info() const { return smoothed_ ? smoothed_->info() : volume_.info(); }
  const IsoRule& rule() const { return rule_; }

  // Slices of it that there are once slices of the volume below `end` are.
  std::int64_t slices_from(std::int64_t end) const;

  // What is known of the samples of slice k of the volume, if it is smoothed and measured.
  const SampleRange* range(std::int64_t k) const { return smoothed_ ? smoothed_->range(k) : nullptr; }

  // What it holds, at most.
  static std::uint64_t memory(const VolumeInfo& volume, const SurfaceOptions& options);

  // What it says of itself, before there is one.
  static VolumeInfo info_of(const VolumeInfo& volume, const SurfaceOptions& options);

 private:
  SliceSource& volume_;
  IsoRule rule_;
  std::optional<SmoothedMask> smoothed_;
};

}  // namespace isoweave
