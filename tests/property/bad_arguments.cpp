// What a calling program may get wrong is std::invalid_argument, and nothing is computed.
// Threads: none, what is refused starts none
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "isoweave/forecast.hpp"
#include "isoweave/measure.hpp"
#include "isoweave/pipeline.hpp"
#include "isoweave/possible_runs.hpp"

namespace isoweave::testing::bad_arguments_test {
namespace {

// A source of the caller's own, of zeros.
class OwnSource final : public SliceSource {
 public:
  explicit OwnSource(VolumeInfo info) : info_(std::move(info)) {}
  const VolumeInfo& info() const override { return info_; }
  void read(std::int64_t, std::int64_t, std::span<std::byte> out) override { std::ranges::fill(out, std::byte{0}); }

 private:
  VolumeInfo info_;
};

VolumeInfo small_volume() {
  VolumeInfo info;
  info.path = "own";
  info.dims = {4, 4, 4};
  info.type = SampleType::kUint8;
  return info;
}

MeshOptions usual_options() {
  MeshOptions options;
  options.iso = 0.5;
  options.error = Length::voxels(0.2);
  return options;
}

TEST(BadArguments, AVolumeThatLiesNowhereIsRefusedByEveryFunction) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::function<void(VolumeInfo&)>> changes{[](VolumeInfo& v) { v.geometry.spacing[1] = kNan; },
                                                              [](VolumeInfo& v) { v.geometry.spacing[0] = 0; },
                                                              [](VolumeInfo& v) { v.geometry.spacing[2] = -1; },
                                                              [](VolumeInfo& v) { v.geometry.spacing[0] = HUGE_VAL; },
                                                              [](VolumeInfo& v) { v.geometry.origin[1] = kNan; },
                                                              [](VolumeInfo& v) { v.geometry.direction[5] = HUGE_VAL; },
                                                              [](VolumeInfo& v) { v.slope = 0; },
                                                              [](VolumeInfo& v) { v.slope = kNan; },
                                                              [](VolumeInfo& v) { v.intercept = HUGE_VAL; },
                                                              [](VolumeInfo& v) { v.dims[2] = 0; },
                                                              [](VolumeInfo& v) { v.geometry.spacing[1] = 1e-200; },
                                                              [](VolumeInfo& v) { v.dims[0] = -4; }};
  for (std::size_t n = 0; n < changes.size(); ++n) {
    VolumeInfo info = small_volume();
    changes[n](info);
    OwnSource source(info);
    MeshInMemory mesh;
    const LabelSink label{Label(1), &mesh};
    EXPECT_THROW(mesh_volume(source, mesh, usual_options()), std::invalid_argument) << n;
    EXPECT_THROW(mesh_labels(source, {&label, 1}, usual_options()), std::invalid_argument) << n;
    EXPECT_THROW(choose_components(source, usual_options(), {2, false}), std::invalid_argument) << n;
    EXPECT_THROW(count_triangles(source, usual_options()), std::invalid_argument) << n;
    EXPECT_THROW(forecast_mesh(source, usual_options()), std::invalid_argument) << n;
  }
}

TEST(BadArguments, NumbersOfThreadsThatWorkersCannotHave) {
  OwnSource source(small_volume());
  for (const int threads : {-1, 4097, 65536, 65537}) {
    RunControl control;
    control.threads = threads;
    MeshInMemory mesh;
    EXPECT_THROW(mesh_volume(source, mesh, usual_options(), control), std::invalid_argument) << threads;
    EXPECT_THROW(simplify_mesh({}, mesh, {}, control), std::invalid_argument) << threads;
  }
}

TEST(BadArguments, OneSinkForTwoMeshes) {
  OwnSource source(small_volume());
  MeshInMemory mesh;
  MeshOptions options = usual_options();
  options.levels = {{0.1, true}};
  SimplifyOptions simplify;
  simplify.levels = {{0.1, false}};
  simplify.error = Length::units(0.2);
  for (MeshSink* second : {static_cast<MeshSink*>(&mesh), static_cast<MeshSink*>(nullptr)}) {
    MeshSink* const sinks[] = {&mesh, second};
    const LabelSink labels[] = {{Label(1), &mesh}, {Label(2), second}};
    EXPECT_THROW(mesh_volume(source, sinks, options), std::invalid_argument);
    EXPECT_THROW(simplify_mesh({}, sinks, simplify), std::invalid_argument);
    EXPECT_THROW(mesh_labels(source, labels, usual_options()), std::invalid_argument);
  }
}

TEST(BadArguments, ARefusalNamesTheFeatureAndWhoRefusesIt) {
  MeshOptions options = usual_options();
  options.levels = {Length::voxels(0.1)};
  RunControl control;
  EXPECT_NO_THROW(require_possible(RunKind::kMesh, options, control));
  try {
    require_possible(RunKind::kLabels, options, control);
    FAIL() << "expected a refusal";
  } catch (const ImpossibleRun& refused) {
    EXPECT_EQ(refused.feature(), RunFeature::kLevels);
    EXPECT_FALSE(refused.is_by_device());
    EXPECT_STREQ(refused.what(), "labels: expected a run without levels, which takes one surface");
    EXPECT_EQ(refused.with_names("A", "B"), "A: expected a run without B, which takes one surface");
  }
  control.device = Device::kCuda;
  try {
    require_possible(RunKind::kMesh, options, control);
    FAIL() << "expected a refusal";
  } catch (const ImpossibleRun& refused) {
    EXPECT_EQ(refused.feature(), RunFeature::kLevels);
    EXPECT_TRUE(refused.is_by_device());
  }
}

}  // namespace
}  // namespace isoweave::testing::bad_arguments_test
