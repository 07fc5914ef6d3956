// A saved state is good for one task: every option that changes the result changes the identity, and nothing else does.
// Threads: none, a number of threads is an option here.
#include "pipeline/run_identity.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "files.hpp"
#include "volume/axes.hpp"

namespace isoweave::testing::run_identity_test {
namespace {

VolumeInfo some_volume() {
  VolumeInfo volume;
  volume.path = "a volume";
  volume.dims = {8, 9, 10};
  volume.geometry.spacing = {0.5, 0.5, 2};
  return volume;
}

RunIdentity identity(const MeshOptions& options, const RunControl& control = {},
                     const std::array<double, 3>& offset = {0, 0, 0}) {
  return identity_of(resolve(some_volume(), options, control, offset));
}

std::string text(const RunIdentity& identity) { return identity.volume + "; " + identity.options; }

using Change = std::function<void(MeshOptions&)>;

TEST(RunIdentity, EveryOptionOfTheResultChangesIt) {
  const auto choice = std::make_shared<ComponentChoice>();
  choice->rule = {7, false};
  const std::vector<Change> changes{
      [](MeshOptions&) {},
      [](MeshOptions& o) { o.iso = 1; },
      [](MeshOptions& o) { o.inside_above = false; },
      [](MeshOptions& o) { o.closed = false; },
      [](MeshOptions& o) { o.smooth = 2; },
      [&](MeshOptions& o) { o.components = choice; },
      [](MeshOptions& o) { o.error = Length::voxels(0.3); },
      [](MeshOptions& o) { o.error = Length::units(0.2); },
      [](MeshOptions& o) { o.max_distance = Length::voxels(0.3); },
      [](MeshOptions& o) { o.triangles = 5; },
      [](MeshOptions& o) { o.quality = Quality::kFine; },
      [](MeshOptions& o) { o.drop_specks = true; },
      [](MeshOptions& o) { o.levels = {Length::voxels(0.1)}; },
      [](MeshOptions& o) { o.normals = Normals::kGradient; },
      [](MeshOptions& o) { o.normals = Normals::kQuadric; },
      [](MeshOptions& o) { o.space = OutputSpace::kIndex; },
  };
  std::set<std::string> seen;
  for (const Change& change : changes) {
    MeshOptions options;
    change(options);
    EXPECT_TRUE(seen.insert(text(identity(options))).second) << text(identity(options));
  }
  EXPECT_TRUE(seen.insert(text(identity({}, {.measure = false}))).second);
  EXPECT_TRUE(seen.insert(text(identity({}, {}, {1, 0, 0}))).second);
}

TEST(RunIdentity, NothingElseChangesIt) {
  RunControl control;
  control.threads = 3;
  control.schedule = Schedule::kQueue;
  control.slab = 4;
  control.memory = 1'000'000'000;
  EXPECT_EQ(text(identity({}, control)), text(identity({})));
}

// A length is a length, in whatever it is given.
TEST(RunIdentity, OneLengthIsOneLength) {
  MeshOptions options;
  options.error = Length::units(0.2 * cube_root(0.5));
  EXPECT_EQ(text(identity(options)), text(identity({})));
}

// The samples beside a header, in one file or in a series of them.
TEST(RunIdentity, FilesOfSamplesCount) {
  const files::Folder folder;
  for (const std::string name : {"0", "1"}) files::write_bytes(folder / name, "ab");
  for (const std::vector<std::string>& names : {std::vector{folder / "1"}, std::vector{folder / "0", folder / "1"}}) {
    VolumeInfo volume = some_volume();
    volume.data_files = names;
    const std::string before = volume_text(volume);
    EXPECT_EQ(volume_text(volume), before);
    files::write_bytes(folder / "1", files::read_bytes(folder / "1") + "c");
    EXPECT_NE(volume_text(volume), before);
  }
}

}  // namespace
}  // namespace isoweave::testing::run_identity_test
