// Surfaces of 64-bit integers: where differences are small the surface is exact, however large the numbers are.
#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <vector>

#include "surfaces.hpp"

namespace isoweave::testing::wide_integers_test {
namespace {

constexpr std::array<std::int64_t, 3> kDims{20, 18, 16};

std::vector<std::uint8_t> small_numbers() {
  GenerateOptions options;
  options.kind = "noise";
  options.dims = kDims;
  options.type = SampleType::kUint8;
  std::vector<std::uint8_t> samples(static_cast<std::size_t>(kDims[0] * kDims[1] * kDims[2]));
  generate_volume(options)->read(0, kDims[2], std::as_writable_bytes(std::span(samples)));
  return samples;
}

template <class T>
MeshReport mesh_of(const std::vector<T>& samples, SampleType type, MeshOptions options, double iso) {
  VolumeInfo info;
  info.path = "numbers";
  info.dims = kDims;
  info.type = type;
  options.iso = iso;
  MemorySink sink;
  return mesh_volume(*volume_in_memory(info, std::as_bytes(std::span(samples))), sink, options);
}

// Multiples of 512 are doubles up to 2^61, so the iso-value is the same one, and the numbers between are not.
template <class T>
void expect_same(SampleType type, T base, const MeshOptions& options) {
  constexpr double kIso = 127 * 512;
  std::vector<std::int32_t> low;
  std::vector<T> high;
  for (const std::uint8_t sample : small_numbers()) {
    low.push_back(sample * 512 + sample);
    high.push_back(base + static_cast<T>(low.back()));
  }
  const MeshReport expected = mesh_of(low, SampleType::kInt32, options, kIso);
  const MeshReport found = mesh_of(high, type, options, static_cast<double>(base) + kIso);
  EXPECT_GT(expected.triangles, 100U);
  EXPECT_EQ(digest_text(found.digest), digest_text(expected.digest));
}

TEST(WideIntegers, HaveTheSurfaceOfTheSmallNumbersTheyAreMadeOf) {
  for (const bool above : {true, false}) {
    MeshOptions options;
    options.inside_above = above;
    options.normals = Normals::kGradient;
    for (const int smooth : {0, 2}) {
      options.smooth = smooth;
      expect_same<std::int64_t>(SampleType::kInt64, 0, options);
      expect_same<std::int64_t>(SampleType::kInt64, std::int64_t{1} << 60, options);
      expect_same<std::int64_t>(SampleType::kInt64, -(std::int64_t{1} << 60), options);
      expect_same<std::uint64_t>(SampleType::kUint64, std::uint64_t{1} << 60, options);
    }
  }
}

// The ends of the types, where the iso-value has no neighbour that is a sample.
TEST(WideIntegers, IsoValuesBeyondTheTypeGiveNothingOrAll) {
  std::vector<std::uint64_t> samples(static_cast<std::size_t>(kDims[0] * kDims[1] * kDims[2]), ~std::uint64_t{0});
  EXPECT_EQ(mesh_of(samples, SampleType::kUint64, {}, 0x1p64).triangles, 0U);
  MeshOptions options;
  EXPECT_GT(mesh_of(samples, SampleType::kUint64, options, 0x1p63).triangles, 0U);
  options.inside_above = false;
  EXPECT_GT(mesh_of(samples, SampleType::kUint64, options, 0x1p64).triangles, 0U);
}

}  // namespace
}  // namespace isoweave::testing::wide_integers_test
