// The size of blocks for a cap on memory.
#include "isoweave/blocks.hpp"

namespace isoweave {

std::optional<std::int64_t> block_size_for(const VolumeInfo& volume, std::uint64_t triangles, std::uint64_t memory) {
  constexpr double kProgram = 64e6;     // bytes without any surface
  constexpr double kSlices = 48;        // of a block that are held
  constexpr double kLayers = 60;        // whose triangles are held undecided or on their way
  constexpr double kPerTriangle = 200;  // bytes in the zone and in a piece
  const double samples = static_cast<double>(volume.slice_samples()) * static_cast<double>(volume.dims[2]);
  const double per_cell = static_cast<double>(triangles) / samples;
  const double per_area = kSlices * static_cast<double>(sample_bytes(volume.type)) + kLayers * kPerTriangle * per_cell;
  // Smaller blocks hand most of their surface on, and later stages hold it.
  for (const std::int64_t size : {512, 256, 128}) {
    const auto side = static_cast<double>(size);
    if (kProgram + side * side * per_area <= static_cast<double>(memory)) return size;
  }
  return std::nullopt;
}

}  // namespace isoweave
