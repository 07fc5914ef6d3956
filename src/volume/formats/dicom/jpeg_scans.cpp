#include "volume/formats/dicom/jpeg_scans.hpp"

#include <algorithm>
#include <cmath>

namespace isoweave {
namespace {

constexpr std::size_t kSide = 8;
constexpr std::int64_t kLength = kSide;  // the same, beside sizes of frames

// Row * 8 + column of the n-th coefficient in zigzag order: along the diagonals, up and down in turn.
constexpr std::array<std::uint8_t, 64> kZigzag = [] {
  std::array<std::uint8_t, 64> places{};
  std::size_t n = 0;
  for (std::size_t sum = 0; sum <= 2 * (kSide - 1); ++sum) {
    const std::size_t low = sum < kSide ? 0 : sum - kSide + 1;
    for (std::size_t m = low; m <= sum - low; ++m) {
      const std::size_t row = sum % 2 == 0 ? sum - m : m;
      places[n++] = static_cast<std::uint8_t>(row * kSide + sum - row);
    }
  }
  return places;
}();

// cos(n pi / 16) / 2 for n = 0 ... 8, with the factor sqrt(1/2) where n = 0 (T.81, A.3.3).
constexpr std::array<double, 9> kCosines{0.35355339059327379, 0.49039264020161522,  0.46193976625564337,
                                         0.41573480615127262, 0.35355339059327379,  0.27778511650980109,
                                         0.19134171618254489, 0.097545161008064124, 0};

// Weight of the n-th cosine at place x of 8: cos((2x + 1) n pi / 16) / 2.
constexpr std::array<std::array<double, kSide>, kSide> kWeights = [] {
  std::array<std::array<double, kSide>, kSide> weights{};
  for (std::size_t x = 0; x < kSide; ++x) {
    for (std::size_t n = 0; n < kSide; ++n) {
      const std::size_t angle = (2 * x + 1) * n % 32;  // of 32 around the circle
      const std::size_t mirrored = angle > 16 ? 32 - angle : angle;
      weights[x][n] = n == 0 ? kCosines[0] : mirrored > 8 ? -kCosines[16 - mirrored] : kCosines[mirrored];
    }
  }
  return weights;
}();

using Block = std::array<double, kSide * kSide>;

// Inverse DCT by its definition: along rows, and again along what were columns.
void inverse_dct(Block& block) {
  for (int pass = 0; pass < 2; ++pass) {
    Block turned;
    for (std::size_t row = 0; row < kSide; ++row) {
      for (std::size_t x = 0; x < kSide; ++x) {
        double sum = 0;
        for (std::size_t n = 0; n < kSide; ++n) sum += kWeights[x][n] * block[row * kSide + n];
        turned[x * kSide + row] = sum;
      }
    }
    block = turned;
  }
}

// The coefficients of the next block (T.81, F.2.2). dc: of the block before, then of this one, not yet scaled.
bool read_block(const JpegBlockScan& scan, JpegBits& bits, std::int32_t& dc, Block& block) {
  constexpr int kMostBits = 15;
  constexpr std::int32_t kMostDc = 1 << (kMostBits + 1);
  block = {};
  const int size = bits.symbol(scan.dc);
  if (size > kMostBits) return false;
  dc += bits.number(size);
  if (std::abs(dc) > kMostDc) return false;
  block[0] = static_cast<double>(dc) * scan.quantization[0];
  for (std::size_t n = 1; n < block.size(); ++n) {
    constexpr int kSixteenZeros = 0xf0;
    const int code = bits.symbol(scan.ac);
    if (code == kSixteenZeros) {
      n += 15;
      continue;
    }
    if (code % 16 == 0) break;
    n += static_cast<std::size_t>(code / 16);
    if (n >= block.size()) return false;
    block[kZigzag[n]] = static_cast<double>(bits.number(code % 16)) * scan.quantization[n];
  }
  return !bits.failed();
}

// The part of a block that lies inside the frame.
void put_block(const JpegSize& size, int used, const Block& block, std::int64_t row, std::int64_t column,
               std::vector<std::uint16_t>& samples) {
  const double middle = std::ldexp(1.0, size.bits - 1);
  const double most = std::ldexp(1.0, std::min(used, size.bits)) - 1;
  for (std::int64_t y = 0; y < std::min(kLength, size.rows - row); ++y) {
    for (std::int64_t x = 0; x < std::min(kLength, size.columns - column); ++x) {
      const double value = std::floor(block[static_cast<std::size_t>(y * kLength + x)] + middle + 0.5);
      samples[static_cast<std::size_t>((row + y) * size.columns + column + x)] =
          static_cast<std::uint16_t>(std::clamp(value, 0.0, most));
    }
  }
}

// The prediction of a sample from three before it (T.81, H.1.2.1).
int predicted(int predictor, int left, int above, int corner) {
  switch (predictor) {
    case 1:
      return left;
    case 2:
      return above;
    case 3:
      return corner;
    case 4:
      return left + above - corner;
    case 5:
      return left + ((above - corner) >> 1);
    case 6:
      return above + ((left - corner) >> 1);
    default:
      return (left + above) >> 1;
  }
}

// One row of differences. above: the row before it; nullptr where prediction begins anew.
bool read_row(const JpegSize& size, const JpegLosslessScan& scan, JpegBits& bits, const std::uint16_t* above,
              std::uint16_t* row) {
  constexpr int kHalfCircle = 16;  // stands for 32768, without bits of its own
  for (std::int64_t n = 0; n < size.columns; ++n) {
    const int length = bits.symbol(scan.code);
    if (length > kHalfCircle) return false;
    const int difference = length == kHalfCircle ? 1 << 15 : bits.number(length);
    int expected = 0;
    if (n == 0) {
      expected = above == nullptr ? 1 << (size.bits - scan.point_transform - 1) : above[0];
    } else {
      expected = above == nullptr ? row[n - 1] : predicted(scan.predictor, row[n - 1], above[n], above[n - 1]);
    }
    row[n] = static_cast<std::uint16_t>(expected + difference);
  }
  return !bits.failed();
}

}  // namespace

bool decode_blocks(const JpegSize& size, const JpegBlockScan& scan, JpegBits bits,
                   std::vector<std::uint16_t>& samples) {
  samples.resize(size.samples());
  std::int32_t dc = 0;
  std::uint32_t count = 0;
  Block block;
  for (std::int64_t row = 0; row < size.rows; row += kLength) {
    for (std::int64_t column = 0; column < size.columns; column += kLength, ++count) {
      if (scan.restart > 0 && count > 0 && count % scan.restart == 0) {
        bits.restart(count / scan.restart - 1);
        dc = 0;
      }
      if (!read_block(scan, bits, dc, block)) return false;
      inverse_dct(block);
      put_block(size, scan.used, block, row, column, samples);
    }
  }
  return true;
}

bool decode_lossless(const JpegSize& size, const JpegLosslessScan& scan, JpegBits bits,
                     std::vector<std::uint16_t>& samples) {
  const auto columns = static_cast<std::uint32_t>(size.columns);
  if (scan.restart % columns != 0) return false;
  const std::uint32_t rows_between = scan.restart / columns;
  samples.resize(size.samples());
  const std::uint16_t* above = nullptr;
  for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(size.rows); ++row) {
    if (rows_between > 0 && row > 0 && row % rows_between == 0) {
      bits.restart(row / rows_between - 1);
      above = nullptr;
    }
    std::uint16_t* const own = samples.data() + std::size_t{row} * columns;
    if (!read_row(size, scan, bits, above, own)) return false;
    above = own;
  }
  if (scan.point_transform > 0) {
    for (std::uint16_t& sample : samples) sample = static_cast<std::uint16_t>(sample << scan.point_transform);
  }
  return true;
}

}  // namespace isoweave
