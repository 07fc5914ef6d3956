// Hosts whose processor rounds otherwise, or takes small numbers for 0.
// Threads: none, surfaces.cpp has the same runs
#include <gtest/gtest.h>

#include <cfenv>
#include <cstdint>
#include <vector>

#ifdef __SSE__
#include <xmmintrin.h>
#endif

#include "isoweave/error.hpp"
#include "isoweave/measure.hpp"
#include "isoweave/pipeline.hpp"

namespace isoweave::testing::host_floats_test {
namespace {

// Samples of both signs, some so small that they are not normal, which are 0 where those are flushed.
std::vector<float> samples_around_zero(std::int64_t side) {
  std::vector<float> samples;
  std::uint32_t state = 1;
  for (std::int64_t n = 0; n < side * side * side; ++n) {
    state = state * 1664525 + 1013904223;
    const float value = static_cast<float>(state >> 8U) - 8388608.0F;
    samples.push_back(state % 3 == 0 ? value * 1e-45F : value * 1e-3F);
  }
  return samples;
}

constexpr std::int64_t kSide = 12;

std::uint64_t digest_of_run(const std::vector<float>& samples, int threads) {
  VolumeInfo info;
  info.path = "samples";
  info.dims = {kSide, kSide, kSide};
  info.type = SampleType::kFloat32;
  info.geometry.spacing = {0.3, 0.7, 1.1};
  MeshOptions options;
  options.iso = 0;
  options.error = Length::voxels(0.5);
  RunControl control;
  control.slab = 3;
  control.threads = threads;
  MeshInMemory mesh;
  return mesh_volume(*volume_in_memory(info, std::as_bytes(std::span(samples))), mesh, options, control).digest;
}

void expect_same_under(const char* what) {
  std::fenv_t host;
  std::fegetenv(&host);
  const int rounding = std::fegetround();
  std::fesetenv(FE_DFL_ENV);
  const std::vector<float> samples = samples_around_zero(kSide);
  const std::uint64_t expected = digest_of_run(samples, 1);
  for (const int threads : {1, 3}) {
    std::fesetenv(&host);
    const std::uint64_t found = digest_of_run(samples, threads);
    const int rounding_after = std::fegetround();
    std::fesetenv(FE_DFL_ENV);
    EXPECT_EQ(found, expected) << what << ", " << threads << " threads";
    EXPECT_EQ(rounding_after, rounding) << what;
  }
}

TEST(HostFloats, AnotherRoundingChangesNothing) {
  for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    ASSERT_EQ(std::fesetround(rounding), 0);
    expect_same_under("another rounding");
  }
  std::fesetenv(FE_DFL_ENV);
}

TEST(HostFloats, SmallNumbersTakenForZeroChangeNothing) {
#ifdef __SSE__
  constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x40;
  const unsigned usual = _mm_getcsr();
  _mm_setcsr(usual | kFlushToZero | kDenormalsAreZero);
  expect_same_under("small numbers taken for 0");
  // No label has such a number.
  const std::vector<float> map{0, 1e-40F};
  VolumeInfo info;
  info.dims = {2, 1, 1};
  info.type = SampleType::kFloat32;
  const auto labels = volume_in_memory(info, std::as_bytes(std::span(map)));
  EXPECT_THROW(find_labels(*labels), BadInput);
  _mm_setcsr(usual);
#else
  GTEST_SKIP() << "only tried on x86";
#endif
}

}  // namespace
}  // namespace isoweave::testing::host_floats_test
