// The size of blocks for a cap on memory.
#include <algorithm>
#include <utility>

#include "isoweave/blocks.hpp"
#include "pipeline/parts/blocks_to_number.hpp"
#include "volume/row_source.hpp"

namespace isoweave {
namespace {

// The bytes that a source holds while a block of that size is read.
std::uint64_t held_of_block(std::unique_ptr<SliceSource> volume, std::int64_t size) {
  Region block;
  for (std::size_t axis = 0; axis < 3; ++axis) block.end[axis] = std::min(size, volume->info().dims[axis]);
  return held_by_slices(*crop_volume(std::move(volume), block));
}

}  // namespace

std::optional<std::int64_t> block_size_for(const VolumeOpener& open, std::uint64_t triangles, std::uint64_t memory,
                                           std::uint64_t wanted) {
  constexpr double kProgram = 64e6;     // bytes without any surface
  constexpr double kSlices = 48;        // of a block that are held
  constexpr double kLayers = 60;        // whose triangles are held undecided or on their way
  constexpr double kPerTriangle = 200;  // bytes in the zone and in a piece
  constexpr double kPerLast = 350;      // bytes where parts become the zone that ends at a number of triangles
  const VolumeInfo volume = open()->info();
  const double samples = static_cast<double>(volume.slice_samples()) * static_cast<double>(volume.dims[2]);
  const double per_cell = static_cast<double>(triangles) / samples;
  const double per_area = kSlices * static_cast<double>(sample_bytes(volume.type)) + kLayers * kPerTriangle * per_cell;
  // Smaller blocks hand most of their surface on, and later stages hold it.
  for (const std::int64_t size : {512, 256, 128}) {
    const auto side = static_cast<double>(size);
    const auto held = static_cast<double>(held_of_block(open(), size));
    const double blocks = held + side * side * per_area;
    const double together =
        wanted == 0 ? 0 : kPerLast * static_cast<double>(std::min(most_together(wanted), triangles));
    if (kProgram + std::max(blocks, together) <= static_cast<double>(memory)) return size;
  }
  return std::nullopt;
}

}  // namespace isoweave
