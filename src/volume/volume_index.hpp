// The index of a volume in memory: the range of each brick, a pyramid of them, and the facts of each slice.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "isoweave/index.hpp"
#include "volume/samples.hpp"

namespace isoweave {

inline constexpr std::int64_t kBrick = 16;  // cells along a side: 17 samples, of which neighbours share one

// The bricks along an axis of so many samples.
constexpr std::int64_t bricks_along(std::int64_t samples) { return samples < 3 ? 1 : (samples - 2) / kBrick + 1; }

// The facts of a slice.
struct SliceFacts {
  SampleRange range;
  std::uint32_t crc = 0;  // CRC-32 of its samples in the machine's byte order
};

// The bricks of one level of the pyramid, i fastest. A brick of level n covers 2 x 2 x 2 of level n - 1.
struct BrickLevel {
  std::array<std::int64_t, 3> size{0, 0, 0};
  std::vector<std::byte> low, high;  // samples of the volume's type; low > high where no sample is a number
  std::vector<std::uint8_t> nan;     // whether a sample is NaN; empty for integers

  std::size_t count() const { return static_cast<std::size_t>(size[0] * size[1] * size[2]); }
  std::size_t at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return static_cast<std::size_t>((k * size[1] + j) * size[0] + i);
  }
};

class VolumeIndex {
 public:
  // `finest`: the bricks of the volume, from which the levels above are made.
  VolumeIndex(const std::array<std::int64_t, 3>& dims, SampleType type, std::string identity,
              std::vector<SliceFacts> slices, BrickLevel finest);

  const std::array<std::int64_t, 3>& dims() const { return dims_; }
  SampleType type() const { return type_; }

  // The volume that the index is of, as text (volume_identity).
  const std::string& identity() const { return identity_; }

  const std::vector<SliceFacts>& slices() const { return slices_; }

  // From the finest level to the one brick that covers all.
  const std::vector<BrickLevel>& levels() const { return levels_; }

  std::uint64_t bytes() const;

 private:
  std::array<std::int64_t, 3> dims_;
  SampleType type_;
  std::string identity_;
  std::vector<SliceFacts> slices_;
  std::vector<BrickLevel> levels_;
};

// The bricks of a volume without samples yet.
BrickLevel empty_bricks(const std::array<std::int64_t, 3>& dims, SampleType type);

// Throws std::invalid_argument unless the index is that of a volume of this size and type.
void require_index_of(const VolumeIndex& index, const VolumeInfo& volume);

}  // namespace isoweave
