// The scans of a JPEG frame of one component (ITU-T T.81, 1992): of DCT blocks, or of predicted samples.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "volume/formats/dicom/jpeg_entropy.hpp"

namespace isoweave {

struct JpegSize {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  int bits = 0;  // of a sample

  std::size_t samples() const { return static_cast<std::size_t>(columns * rows); }
};

// Step of each DCT coefficient, in zigzag order.
using JpegQuantization = std::array<std::uint16_t, 64>;

struct JpegBlockScan {
  const HuffmanCode& dc;
  const HuffmanCode& ac;
  const JpegQuantization& quantization;
  int used = 0;               // bits of a sample: larger numbers are cut off
  std::uint32_t restart = 0;  // blocks between two restart markers; 0: none
};

struct JpegLosslessScan {
  const HuffmanCode& code;
  int predictor = 1;          // 1 to 7
  int point_transform = 0;    // lower bits left out; fewer than a sample has
  std::uint32_t restart = 0;  // samples between two restart markers, whole rows; 0: none
};

// Samples row by row. False when the bits are damaged or too few.
bool decode_blocks(const JpegSize& size, const JpegBlockScan& scan, JpegBits bits, std::vector<std::uint16_t>& samples);
bool decode_lossless(const JpegSize& size, const JpegLosslessScan& scan, JpegBits bits,
                     std::vector<std::uint16_t>& samples);

}  // namespace isoweave
