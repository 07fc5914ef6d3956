// Generated volumes.
#include <cmath>
#include <set>
#include <stdexcept>

#include "isoweave/generate.hpp"
#include "volume/noise.hpp"
#include "volume_helpers.hpp"

namespace isoweave::testing::volume_generate_test {
namespace {

GenerateOptions options_of(const std::string& kind, std::array<std::int64_t, 3> dims,
                           SampleType type = SampleType::kFloat32) {
  GenerateOptions options;
  options.kind = kind;
  options.dims = dims;
  options.type = type;
  return options;
}

std::vector<float> generated(const std::string& kind, std::array<std::int64_t, 3> dims) {
  return samples_of<float>(*generate_volume(options_of(kind, dims)));
}

std::uint64_t checksum(const std::vector<float>& samples) {
  std::uint64_t sum = 0;
  for (const float sample : samples) sum = scramble_bits(sum + std::bit_cast<std::uint32_t>(sample));
  return sum;
}

TEST(Generate, OffersTheKindsOfTheHeaderInOrder) {
  EXPECT_EQ(generator_kinds(), (std::vector<std::string>{"sphere", "torus", "gyroid", "box", "shells", "smooth",
                                                         "noise", "white", "specks"}));
}

TEST(Generate, RefusesBadArguments) {
  EXPECT_THROW(generate_volume(options_of("cube", {4, 4, 4})), std::invalid_argument);
  EXPECT_THROW(suggested_iso("cube", SampleType::kUint8), std::invalid_argument);
  EXPECT_THROW(generate_volume(options_of("box", {4, 0, 4})), std::invalid_argument);
  EXPECT_THROW(generate_volume(options_of("box", {4, 4, -1})), std::invalid_argument);
  EXPECT_THROW(generate_volume(options_of("box", {1 << 30, 1 << 30, 1 << 30})), std::invalid_argument);
  for (const double spacing : {0.0, -1.0, std::nan(""), static_cast<double>(INFINITY)}) {
    GenerateOptions options = options_of("box", {4, 4, 4});
    options.spacing[1] = spacing;
    EXPECT_THROW(generate_volume(options), std::invalid_argument);
  }
}

TEST(Generate, CrossesTheSuggestedIsoInEveryKindAndType) {
  for (const std::string& kind : generator_kinds()) {
    const auto samples = samples_of<float>(*generate_volume(options_of(kind, {40, 36, 32})));
    const auto [low, high] = std::minmax_element(samples.begin(), samples.end());
    EXPECT_LT(*low, suggested_iso(kind, SampleType::kFloat32)) << kind;
    EXPECT_GT(*high, suggested_iso(kind, SampleType::kFloat32)) << kind;
    const auto bytes = samples_of<std::uint8_t>(*generate_volume(options_of(kind, {40, 36, 32}, SampleType::kUint8)));
    for (std::size_t n = 0; n < samples.size(); ++n) {
      // Rounding may move samples that lie nearly at the iso-value, but none that are a step away from it.
      if (std::abs(static_cast<double>(samples[n]) - suggested_iso(kind, SampleType::kFloat32)) < 0.2) continue;
      EXPECT_EQ(samples[n] > suggested_iso(kind, SampleType::kFloat32),
                bytes[n] > suggested_iso(kind, SampleType::kUint8))
          << kind << " sample " << n;
    }
  }
}

TEST(Generate, MapsEveryIntegerTypeAlike) {
  const std::array<std::int64_t, 3> dims{20, 20, 20};
  const auto bytes = samples_of<std::uint8_t>(*generate_volume(options_of("gyroid", dims, SampleType::kUint8)));
  const auto chars = samples_of<std::int8_t>(*generate_volume(options_of("gyroid", dims, SampleType::kInt8)));
  const auto shorts = samples_of<std::int16_t>(*generate_volume(options_of("gyroid", dims, SampleType::kInt16)));
  const auto words = samples_of<std::uint16_t>(*generate_volume(options_of("gyroid", dims, SampleType::kUint16)));
  const auto ints = samples_of<std::int32_t>(*generate_volume(options_of("gyroid", dims, SampleType::kInt32)));
  const auto wide = samples_of<std::uint32_t>(*generate_volume(options_of("gyroid", dims, SampleType::kUint32)));
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    ASSERT_EQ(chars[n], bytes[n] - 128);
    ASSERT_EQ(shorts[n], bytes[n]);
    ASSERT_EQ(words[n], bytes[n]);
    ASSERT_EQ(ints[n], bytes[n]);
    ASSERT_EQ(wide[n], bytes[n]);
  }
  EXPECT_DOUBLE_EQ(suggested_iso("gyroid", SampleType::kUint8), 127.5);
  EXPECT_DOUBLE_EQ(suggested_iso("gyroid", SampleType::kInt8), -0.5);
}

TEST(Generate, DoubleRoundsToFloat) {
  const auto wide = samples_of<double>(*generate_volume(options_of("noise", {9, 8, 7}, SampleType::kFloat64)));
  const auto narrow = generated("noise", {9, 8, 7});
  for (std::size_t n = 0; n < wide.size(); ++n) EXPECT_EQ(static_cast<float>(wide[n]), narrow[n]);
}

TEST(Generate, DoesNotDependOnHowSlicesAreRead) {
  for (const std::string& kind : generator_kinds()) {
    const auto all = samples_of<float>(*generate_volume(options_of(kind, {13, 11, 17})), 17);
    EXPECT_EQ(samples_of<float>(*generate_volume(options_of(kind, {13, 11, 17})), 1), all) << kind;
    std::vector<float> slice(13 * 11);
    generate_volume(options_of(kind, {13, 11, 17}))->read(12, 1, std::as_writable_bytes(std::span(slice)));
    EXPECT_TRUE(std::equal(slice.begin(), slice.end(), all.begin() + 12 * 13 * 11)) << kind;
  }
}

TEST(Generate, TexturesAreTheSameInALargerVolume) {
  for (const char* kind : {"gyroid", "smooth", "noise", "white", "specks"}) {
    const auto small = generated(kind, {13, 11, 9});
    const auto large = generated(kind, {40, 25, 20});
    for (std::size_t k = 0; k < 9; ++k) {
      for (std::size_t j = 0; j < 11; ++j) {
        for (std::size_t i = 0; i < 13; ++i) {
          ASSERT_EQ(small[(k * 11 + j) * 13 + i], large[(k * 25 + j) * 40 + i]) << kind;
        }
      }
    }
  }
}

TEST(Generate, SeedsGiveDifferentTextures) {
  for (const char* kind : {"smooth", "noise", "white", "specks"}) {
    GenerateOptions options = options_of(kind, {24, 24, 24});
    const auto first = samples_of<float>(*generate_volume(options));
    options.seed = 2;
    EXPECT_NE(samples_of<float>(*generate_volume(options)), first) << kind;
  }
}

TEST(Generate, SphereIsASignedDistance) {
  const auto samples = generated("sphere", {21, 21, 31});
  EXPECT_FLOAT_EQ(samples[(15 * 21 + 10) * 21 + 10], 8.4f);
  EXPECT_FLOAT_EQ(samples[(15 * 21 + 10) * 21 + 20], -1.6f);
  EXPECT_FLOAT_EQ(samples[(18 * 21 + 14) * 21 + 10], 3.4f);
}

TEST(Generate, TorusLiesAroundTheSlowestAxis) {
  const auto samples = generated("torus", {101, 101, 51});
  const auto at = [&](std::size_t i, std::size_t j, std::size_t k) { return samples[(k * 101 + j) * 101 + i]; };
  EXPECT_LT(at(50, 50, 25), 0);
  EXPECT_NEAR(at(50 + 29, 50, 25), 12.12, 0.5);
  EXPECT_NEAR(at(50, 50 - 29, 25), 12.12, 0.5);
  EXPECT_LT(at(50, 50 - 29, 45), 0);
}

TEST(Generate, BoxFacesLieOffTheLattice) {
  for (const std::int64_t side : {10, 11, 12, 13, 14}) {
    for (const float sample : generated("box", {side, side, side})) EXPECT_NE(sample, 0.0f) << side;
  }
  const auto samples = generated("box", {10, 10, 10});
  EXPECT_FLOAT_EQ(samples[555], 2.59f);
  EXPECT_FLOAT_EQ(samples[550], -2.37f);
}

TEST(Generate, ShellsAreTwoSamplesApart) {
  const auto samples = generated("shells", {41, 41, 41});
  const auto on_axis = [&](std::size_t distance) { return samples[(20 * 41 + 20) * 41 + 20 + distance]; };
  const std::array<float, 4> wave{-1, 0, 1, 0};
  for (std::size_t distance = 0; distance <= 20; ++distance) EXPECT_EQ(on_axis(distance), wave[distance % 4]);
}

TEST(Generate, GyroidFollowsTheSines) {
  const auto samples = generated("gyroid", {40, 36, 34});
  const auto angle = [](std::size_t at, double phase) {
    return 2 * std::acos(-1.0) * (static_cast<double>(at) + phase) / 32;
  };
  for (std::size_t k = 0; k < 34; ++k) {
    for (std::size_t j = 0; j < 36; ++j) {
      for (std::size_t i = 0; i < 40; ++i) {
        const double x = angle(i, 0.37);
        const double y = angle(j, 0.61);
        const double z = angle(k, 0.23);
        const double expected = std::sin(x) * std::cos(y) + std::sin(y) * std::cos(z) + std::sin(z) * std::cos(x);
        ASSERT_NEAR(samples[(k * 36 + j) * 40 + i], expected, 1e-6);
      }
    }
  }
}

TEST(Generate, SmoothNoiseIsSmoothAndWhiteIsNot) {
  const auto largest_step = [](const std::vector<float>& samples) {
    float largest = 0;
    for (std::size_t n = 1; n < samples.size(); ++n) {
      if (n % 64 != 0) largest = std::max(largest, std::abs(samples[n] - samples[n - 1]));
    }
    return largest;
  };
  EXPECT_LT(largest_step(generated("smooth", {64, 64, 8})), 0.2f);
  EXPECT_GT(largest_step(generated("noise", {64, 64, 8})), 0.15f);
  EXPECT_GT(largest_step(generated("white", {64, 64, 8})), 0.9f);
}

TEST(Generate, WhiteIsUniform) {
  const auto samples = generated("white", {64, 64, 16});
  std::array<int, 8> histogram{};
  for (const float sample : samples) ++histogram.at(static_cast<std::size_t>(sample * 8));
  for (const int count : histogram) EXPECT_NEAR(count, 8192, 400);
}

TEST(Generate, SpecksAreIsolatedSingleSamples) {
  constexpr std::int64_t kSide = 40;
  const auto samples = generated("specks", {kSide, kSide, kSide});
  const auto is_speck = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    const bool inside = std::min({i, j, k}) >= 0 && std::max({i, j, k}) < kSide;
    return inside && samples[static_cast<std::size_t>((k * kSide + j) * kSide + i)] == 1.0f;
  };
  int specks = 0;
  for (std::int64_t n = 0; n < kSide * kSide * kSide; ++n) {
    const std::int64_t i = n % kSide;
    const std::int64_t j = n / kSide % kSide;
    const std::int64_t k = n / kSide / kSide;
    if (!is_speck(i, j, k)) continue;
    ++specks;
    int near = 0;
    for (int d = 0; d < 27; ++d) near += is_speck(i + d % 3 - 1, j + d / 3 % 3 - 1, k + d / 9 - 1) ? 1 : 0;
    EXPECT_EQ(near, 1);
  }
  EXPECT_NEAR(specks, 500, 60);
}

// The bits themselves are part of the contract: the same on every machine, and from version to version.
TEST(Generate, GivesTheSameBitsEverywhere) {
  const std::vector<std::pair<std::string, std::uint64_t>> expected{
      {"sphere", 7532246466077728365u}, {"torus", 2145335117912011394u},  {"gyroid", 1728814522215586820u},
      {"box", 10140851060819272883u},   {"shells", 6814381959964738588u}, {"smooth", 9633559306584603412u},
      {"noise", 17833131140069129118u}, {"white", 4177801007643710552u},  {"specks", 3331194859959661271u}};
  for (const auto& [kind, sum] : expected) {
    EXPECT_EQ(checksum(generated(kind, {33, 29, 27})), sum) << kind;
  }
}

// A part of a row has the samples that the row has there.
TEST(GeneratedVolumes, PartsAreThoseOfTheWhole) {
  for (const std::string& kind : generator_kinds()) {
    GenerateOptions options;
    options.kind = kind;
    options.dims = {61, 13, 15};
    options.seed = 5;
    const auto whole = generate_volume(options);
    std::vector<std::byte> samples(whole->info().slice_bytes() * 15);
    whole->read(0, 15, samples);
    for (const std::int64_t first : {0, 1, 6, 11, 12, 29, 40}) {
      const Region region{{first, 2, 3}, {first + 19, 11, 14}};
      const auto part = crop_volume(generate_volume(options), region);
      std::vector<std::byte> found(part->info().slice_bytes() * 11);
      part->read(0, 11, found);
      const std::size_t sample = sample_bytes(options.type), row = 19 * sample;
      for (std::int64_t k = 3; k < 14; ++k) {
        for (std::int64_t j = 2; j < 11; ++j) {
          const auto from = static_cast<std::size_t>((k * 13 + j) * 61 + first) * sample;
          const auto at = static_cast<std::size_t>((k - 3) * 9 + j - 2) * row;
          EXPECT_TRUE(std::equal(found.begin() + static_cast<std::ptrdiff_t>(at),
                                 found.begin() + static_cast<std::ptrdiff_t>(at + row),
                                 samples.begin() + static_cast<std::ptrdiff_t>(from)))
              << kind << " from " << first << " at " << j << ", " << k;
        }
      }
    }
  }
}

}  // namespace
}  // namespace isoweave::testing::volume_generate_test
