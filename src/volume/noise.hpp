// Pseudo-random fields on the sample lattice. Values depend on seed and position only, so that a larger volume holds
// the same texture, and are the same on every machine: integers are mixed, and doubles only added and multiplied.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace isoweave {

// Scrambles all 64 bits (the finalizer of SplitMix64).
constexpr std::uint64_t mix_bits(std::uint64_t bits) {
  bits += 0x9e3779b97f4a7c15u;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

// Random bits of a row of lattice points; mix_bits(row + i) are those of point i in it.
constexpr std::uint64_t row_bits(std::uint64_t seed, std::int64_t j, std::int64_t k) {
  return mix_bits(mix_bits(mix_bits(seed) + static_cast<std::uint64_t>(k)) + static_cast<std::uint64_t>(j));
}

// A double in [0, 1) from the upper 53 bits.
constexpr double unit_value(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

// Random values in [0, 1) at every pitch-th sample, joined by smooth steps.
class ValueNoise {
 public:
  ValueNoise(std::int64_t width, std::int64_t height, std::int64_t pitch, std::uint64_t seed);

  // Prepares the rows of slice k.
  void begin_slice(std::int64_t k);

  // Adds weight * noise of row j to `row`.
  void add_row(std::int64_t j, double weight, std::span<double> row);

 private:
  std::int64_t pitch_;
  std::uint64_t seed_;
  std::size_t columns_;  // random values along a row of them
  std::size_t rows_;
  std::vector<double> steps_;  // the smooth step at each sample between two random values
  std::vector<double> plane_;  // random values at the height of the slice
  std::vector<double> line_;   // random values at the height of the row
};

}  // namespace isoweave
