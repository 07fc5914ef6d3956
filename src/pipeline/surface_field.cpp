#include "pipeline/surface_field.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "pipeline/task.hpp"

namespace isoweave {

SurfaceField::SurfaceField(SliceSource& volume, const SurfaceOptions& options, const Executor& executor, bool measure)
    : volume_(volume), rule_(stored_rule(volume.info(), options)) {
  if (options.smooth == 0) return;
  smoothed_.emplace(volume, SmoothedMaskOptions{rule_.iso, rule_.above, options.smooth, measure}, executor);
  rule_.iso = 0;
  rule_.above = true;
}

std::int64_t SurfaceField::slices_from(std::int64_t end) const {
  if (!smoothed_ || end == volume_.info().dims[2]) return end;
  return std::max<std::int64_t>(end - smoothed_->reach(), 0);
}

std::uint64_t SurfaceField::memory(const VolumeInfo& volume, const SurfaceOptions& options) {
  return options.smooth > 0 ? SmoothedMask::memory(volume, options.smooth) : 0;
}

VolumeInfo SurfaceField::info_of(const VolumeInfo& volume, const SurfaceOptions& options) {
  return options.smooth > 0 ? SmoothedMask::info_of(volume) : volume;
}

}  // namespace isoweave
