// Samples near the largest number, whose differences and sums are beyond it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "extract/cube_rules.hpp"
#include "isoweave/pipeline.hpp"
#include "lattice/value_rules.hpp"

namespace isoweave::testing::extract_huge_samples_test {
namespace {

constexpr double kMost = std::numeric_limits<double>::max();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(HugeSamples, TheCrossingIsWhereItBelongs) {
  EXPECT_EQ(crossing_parameter(-kMost, kMost, 0, false), 0.5);
  EXPECT_EQ(crossing_parameter(kMost, -kMost, 0, true), 0.5);
  EXPECT_EQ(crossing_parameter(-kMost, kMost, kMost / 2, false), 0.75);
  EXPECT_EQ(crossing_parameter(kMost, -kMost, -kMost / 2, true), 0.75);
  EXPECT_EQ(crossing_parameter(-kMost, kInfinity, 0, false), 1.0 / 256);
  EXPECT_EQ(crossing_parameter(-kInfinity, kInfinity, 0, false), 255.0 / 256);
}

TEST(HugeSamples, SoIsAValueBetween) {
  EXPECT_EQ(value_between(-kMost, kMost, 0.5), 0);
  EXPECT_DOUBLE_EQ(value_between(-kMost, kMost, 0.75), kMost / 2);
  EXPECT_TRUE(std::isnan(value_between(kInfinity, 1, 0.5)));
}

// Samples of double that are -size and size around a ball.
class HugeBall final : public SliceSource {
 public:
  explicit HugeBall(double size) {
    info_.path = "memory";
    info_.dims = {20, 20, 20};
    info_.type = SampleType::kFloat64;
    for (int k = 0; k < 20; ++k) {
      for (int j = 0; j < 20; ++j) {
        for (int i = 0; i < 20; ++i) {
          const double x = i - 9.5, y = j - 9.5, z = k - 9.5;
          samples_.push_back(x * x + y * y + z * z < 36 ? size : -size);
        }
      }
    }
  }
  const VolumeInfo& info() const override { return info_; }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    std::memcpy(out.data(), samples_.data() + first * 400, static_cast<std::size_t>(count) * 3200);
  }

 private:
  VolumeInfo info_;
  std::vector<double> samples_;
};

TEST(HugeSamples, AVolumeOfThemHasTheMeshAndTheNormalsOfSmallOnes) {
  MeshOptions options;
  options.error = Length::units(0);
  options.normals = Normals::kGradient;
  HugeBall small(1), huge(1.7e308);
  MeshInMemory expected, found;
  mesh_volume(small, expected, options);
  mesh_volume(huge, found, options);
  const TriangleMesh a = expected.copy(), b = found.copy();
  EXPECT_TRUE(a.vertices == b.vertices);
  ASSERT_EQ(a.normals.size(), b.normals.size());
  for (std::size_t v = 0; v < a.normals.size(); ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(a.normals[v][axis], b.normals[v][axis], 1e-6);
  }
}

TEST(HugeSamples, MeansOfThemAreFinite) {
  const auto smaller = downsample_volume(std::make_unique<HugeBall>(1.7e308), 2);
  std::vector<double> means(1000);
  smaller->read(0, 10, std::as_writable_bytes(std::span(means)));
  EXPECT_DOUBLE_EQ(means[0], -1.7e308);
  EXPECT_DOUBLE_EQ(means[555], 1.7e308);
}

}  // namespace
}  // namespace isoweave::testing::extract_huge_samples_test
