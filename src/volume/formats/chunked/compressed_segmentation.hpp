// The encoding of label maps in neuroglancer's precomputed volumes: blocks of samples as indices into tables of labels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace isoweave {

struct SegmentationShape {
  std::array<std::int64_t, 3> size{};   // samples of the chunk along x, y, z
  std::array<std::int64_t, 3> block{};  // of a block, 1 to 4096 in all
  std::size_t channels = 1;
  std::size_t sample_bytes = 4;  // or 8
};

// The samples, x fastest and channels slowest, least significant byte first. Throws BadInput naming `path`.
std::vector<std::byte> decode_segmentation(std::span<const std::byte> stored, const SegmentationShape& shape,
                                           const std::string& path);

}  // namespace isoweave
