// 16-bit floats: every one of them becomes the float32 that it is, in whatever format it comes.
#include <cmath>

#include "header_helpers.hpp"
#include "volume/half_floats.hpp"

namespace isoweave::testing::volume_half_floats_test {
namespace {

// By the definition of IEEE 754.
double defined(std::uint16_t half) {
  const double sign = half >> 15U == 0 ? 1 : -1;
  const int exponent = half >> 10U & 0x1f;
  const int mantissa = half & 0x3ff;
  if (exponent == 0) return sign * std::ldexp(mantissa, -24);
  if (exponent < 31) return sign * std::ldexp(1024 + mantissa, exponent - 25);
  return mantissa == 0 ? sign * std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::uint16_t> halves(std::size_t count) {
  std::vector<std::uint16_t> bits(count);
  for (std::size_t n = 0; n < count; ++n) bits[n] = static_cast<std::uint16_t>(n * 2003 % 0x7c00 | (n % 2) << 15U);
  return bits;
}

std::vector<float> floats(const std::vector<std::uint16_t>& bits) {
  std::vector<float> values;
  for (const std::uint16_t half : bits) values.push_back(static_cast<float>(defined(half)));
  return values;
}

TEST(HalfFloats, AllAreExact) {
  for (std::uint32_t bits = 0; bits <= 0xffff; ++bits) {
    const auto half = static_cast<std::uint16_t>(bits);
    const float value = float_of_half(half);
    if (std::isnan(defined(half))) {
      ASSERT_TRUE(std::isnan(value)) << bits;
      continue;
    }
    ASSERT_EQ(static_cast<double>(value), defined(half)) << bits;
    ASSERT_EQ(std::signbit(value), bits >> 15U != 0) << bits;
    ASSERT_EQ(half_of(value), half) << bits;
  }
}

TEST(HalfFloats, TheNearestIsTheEvenOneOfTwo) {
  EXPECT_EQ(half_of(1 + 0x1p-11F), 0x3c00);      // between 1 and 1 + 2^-10
  EXPECT_EQ(half_of(1 + 3 * 0x1p-11F), 0x3c02);  // between 1 + 2^-10 and 1 + 2^-9
  EXPECT_EQ(half_of(std::nextafter(1 + 0x1p-11F, 2.0F)), 0x3c01);
  EXPECT_EQ(half_of(-0.1F), 0xae66);
  EXPECT_EQ(half_of(0x1p-26F), 0);
  EXPECT_EQ(half_of(65504), 0x7bff);
  EXPECT_EQ(half_of(65505), std::nullopt);
  EXPECT_EQ(half_of(std::nanf("")), 0x7e00);
}

TEST(HalfFloats, AreReadFromNpyInBothOrders) {
  const TempFolder folder;
  const std::vector<std::uint16_t> bits = halves(30);
  for (const bool big : {false, true}) {
    const std::string header = npy_header(big ? ">f2" : "<f2", "(5, 2, 3)");
    const auto source = open_volume(folder.put("a.npy", header + stored(bits, big)));
    EXPECT_EQ(source->info().type, SampleType::kFloat32);
    EXPECT_EQ(samples_of<float>(*source), floats(bits));
    EXPECT_EQ(read_file<float>(folder.put("a.npy.gz", gzipped(header + stored(bits, big)))), floats(bits));
  }
  EXPECT_TRUE(
      contains(refusal(folder.put("a.npy", npy_header("<f2", "(5, 2, 3)") + std::string(59, 'x'))), "60 bytes"));
}

TEST(HalfFloats, SlicesAreSkippedAndTheEndIsChecked) {
  const TempFolder folder;
  const std::vector<std::uint16_t> bits = halves(30);
  const std::string content = npy_header("<f2", "(5, 2, 3)") + stored(bits);
  const auto source = open_volume(folder.put("a.npy", content));
  std::vector<float> slices(12);
  source->read(2, 2, std::as_writable_bytes(std::span(slices)));
  const std::vector<float> all = floats(bits);
  EXPECT_TRUE(std::equal(slices.begin(), slices.end(), all.begin() + 12));
  std::string packed = gzipped(content);
  packed[packed.size() - 6] ^= 1;  // its sum
  EXPECT_TRUE(contains(refusal(folder.put("a.npy.gz", packed)), "corrupt"));
}

// Parts of numbers, as nobody who reads slices asks for.
TEST(HalfFloats, ReadsAnyNumberOfBytes) {
  const std::vector<std::uint16_t> bits = halves(50);
  const std::string expected = stored(floats(bits));
  for (const std::size_t step : {1U, 2U, 3U, 5U, 7U, 64U}) {
    OpenedVolume volume;
    volume.info.dims = {50, 1, 1};
    volume.info.type = SampleType::kUint16;
    volume.samples = std::make_unique<DecodedStream>([&] {
      const std::string text = stored(bits);
      std::vector<std::byte> bytes(text.size());
      std::memcpy(bytes.data(), text.data(), text.size());
      return bytes;
    });
    read_halves(volume);
    std::string read;
    std::vector<std::byte> part(step);
    for (bool skip = false;; skip = !skip) {
      const std::size_t got = skip ? static_cast<std::size_t>(volume.samples->skip(step)) : volume.samples->read(part);
      read += skip ? expected.substr(read.size(), got) : std::string(reinterpret_cast<const char*>(part.data()), got);
      if (got < step) break;
    }
    EXPECT_EQ(read, expected) << step;
  }
}

TEST(HalfFloats, AreTheModeTwelveOfMrc) {
  const TempFolder folder;
  const std::vector<std::uint16_t> bits = halves(30);
  for (const bool big : {false, true}) {
    MrcFields fields;
    fields.mode = 12;
    fields.big = big;
    EXPECT_EQ(read_file<float>(folder.put("a.mrc", mrc_header(fields) + stored(bits, big))), floats(bits));
  }
}

}  // namespace
}  // namespace isoweave::testing::volume_half_floats_test
