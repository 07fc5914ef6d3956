// Pseudo-random fields on the sample lattice. Values depend on seed and position only, so that a larger volume holds
// the same texture, and are the same on every machine: integers are mixed, and doubles only added and multiplied.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace isoweave {

// Scrambles all 64 bits (the finalizer of SplitMix64).
constexpr std::uint64_t scramble_bits(std::uint64_t bits) {
  bits += 0x9e3779b97f4a7c15u;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

// Random bits of a row of lattice points; scramble_bits(row + i) are those of point i in it.
constexpr std::uint64_t row_bits(std::uint64_t seed, std::int64_t j, std::int64_t k) {
  return scramble_bits(scramble_bits(scramble_bits(seed) + static_cast<std::uint64_t>(k)) +
                       static_cast<std::uint64_t>(j));
}

// A double in [0, 1) from the upper 53 bits.
constexpr double unit_value(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

// Random values in [0, 1) at every pitch-th sample, joined by smooth steps.
class ValueNoise {
 public:
  ValueNoise(std::int64_t pitch, std::uint64_t seed);

  // Says of which slice rows come next.
  void begin_slice(std::int64_t k);

  // Adds weight * noise of samples of row j to `row`, from sample `first` on.
  void add_row(std::int64_t j, std::int64_t first, double weight, std::span<double> row);

 private:
  // Random values at the height of the slice, from one of them on along a row.
  struct Line {
    std::int64_t row = -1, begin = 0;
    std::vector<double> values;
  };

  const Line& line(std::size_t place, std::int64_t row, std::int64_t begin, std::size_t count);

  std::int64_t pitch_;
  std::uint64_t seed_;
  std::int64_t slice_ = 0;
  std::vector<double> steps_;    // the smooth step at each sample between two random values
  std::array<Line, 2> lines_;    // below and above the last row
  std::vector<double> heights_;  // random values at the height of the row
};

}  // namespace isoweave
