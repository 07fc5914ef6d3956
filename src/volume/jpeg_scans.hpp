// The scans of a JPEG frame of one component (ITU-T T.81, 1992): of blocks of cosines, or of predicted samples.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "volume/jpeg_entropy.hpp"

namespace isoweave {

struct JpegSize {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  int bits = 0;  // of a sample

  std::size_t samples() const { return static_cast<std::size_t>(columns * rows); }
};

// Divisors of the coefficients of a block, in zigzag order.
using JpegDivisors = std::array<std::uint16_t, 64>;

struct JpegBlockScan {
  const HuffmanCode& first;  // of a block's mean
  const HuffmanCode& rest;
  const JpegDivisors& divisors;
  int used = 0;               // bits of a sample: larger numbers are cut off
  std::uint32_t restart = 0;  // blocks between two marks; 0: no marks
};

struct JpegLosslessScan {
  const HuffmanCode& code;
  int predictor = 1;          // 1 to 7
  int shift = 0;              // lower bits left out; fewer than a sample has
  std::uint32_t restart = 0;  // samples between two marks, whole rows; 0: no marks
};

// Samples row by row. False when the bits are damaged or too few.
bool decode_blocks(const JpegSize& size, const JpegBlockScan& scan, JpegBits bits, std::vector<std::uint16_t>& samples);
bool decode_lossless(const JpegSize& size, const JpegLosslessScan& scan, JpegBits bits,
                     std::vector<std::uint16_t>& samples);

}  // namespace isoweave
