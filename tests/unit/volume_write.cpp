// Writing volumes.
#include "isoweave/generate.hpp"
#include "volume_helpers.hpp"

namespace isoweave::testing::volume_write_test {
namespace {

// Slices from memory under any description.
class MemorySource final : public SliceSource {
 public:
  explicit MemorySource(VolumeInfo info) : info_(std::move(info)) {}
  const VolumeInfo& info() const override { return info_; }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    if (first + count > fails_from) throw BadInput("memory: ends early");
    std::fill_n(out.begin(), static_cast<std::size_t>(count) * info_.slice_bytes(), std::byte{7});
  }

  std::int64_t fails_from = 1000;

 private:
  VolumeInfo info_;
};

VolumeInfo oblique_info() {
  VolumeInfo info;
  info.path = "memory";
  info.dims = {3, 4, 5};
  info.type = SampleType::kInt16;
  info.geometry.spacing = {0.1, 0.25, 3};
  info.geometry.origin = {1.5, -2.25, 1e-7};
  info.geometry.direction = {0, -1, 0, 0.6, 0, -0.8, 0.8, 0, 0.6};
  info.geometry.space = Space::kRas;
  info.geometry.unit = "mm";
  return info;
}

std::string failure_of(SliceSource& source, const std::string& path) {
  try {
    write_volume(source, path);
  } catch (const CannotWrite& error) {
    return error.what();
  }
  return "(nothing was thrown)";
}

template <class Values>
void expect_near(const Values& found, const Values& expected, const std::string& what) {
  for (std::size_t n = 0; n < found.size(); ++n) EXPECT_NEAR(found[n], expected[n], 1e-15) << what << " " << n;
}

TEST(WriteVolume, WritesEveryTypeSoThatItIsReadBack) {
  const TempFolder folder;
  for (int type = 0; type < 10; ++type) {
    GenerateOptions options;
    options.kind = "noise";
    options.dims = {7, 5, 9};
    options.type = static_cast<SampleType>(type);
    options.spacing = {0.5, 2, 3};
    const auto expected = read_all(*generate_volume(options));
    for (const std::string name : {"a.nrrd", "a.mha"}) {
      write_volume(*generate_volume(options), folder / name);
      const auto source = open_volume(folder / name);
      EXPECT_EQ(source->info().type, options.type) << name;
      EXPECT_EQ(source->info().geometry.spacing, options.spacing) << name;
      EXPECT_EQ(read_all(*source), expected) << name;
    }
    const std::string raw = folder / ("a_7x5x9_" + std::string(sample_type_name(options.type)) + ".raw");
    write_volume(*generate_volume(options), raw);
    EXPECT_EQ(read_all(*open_volume(raw)), expected);
  }
  EXPECT_EQ(folder.entries(), 12u);
}

TEST(WriteVolume, NrrdKeepsTheGeometry) {
  const TempFolder folder;
  MemorySource source(oblique_info());
  write_volume(source, folder / "a.nrrd");
  const Geometry expected = oblique_info().geometry;
  const Geometry found = open_volume(folder / "a.nrrd")->info().geometry;
  expect_near(found.spacing, expected.spacing, "spacing");
  expect_near(found.direction, expected.direction, "direction");
  EXPECT_EQ(found.origin, expected.origin);
  EXPECT_EQ(found.space, Space::kRas);
  EXPECT_EQ(found.unit, "mm");
}

TEST(WriteVolume, MetaImageTurnsRasIntoLps) {
  const TempFolder folder;
  MemorySource source(oblique_info());
  write_volume(source, folder / "a.mha");
  const Geometry found = open_volume(folder / "a.mha")->info().geometry;
  expect_near(found.spacing, oblique_info().geometry.spacing, "spacing");
  expect_near(found.direction, {0, 1, 0, -0.6, 0, 0.8, 0.8, 0, 0.6}, "direction");
  EXPECT_EQ(found.origin, (std::array<double, 3>{-1.5, 2.25, 1e-7}));
  EXPECT_EQ(found.space, Space::kLps);
  EXPECT_EQ(found.unit, "mm");
}

TEST(WriteVolume, RefusesNamesAndScalingsItCannotWrite) {
  const TempFolder folder;
  VolumeInfo info = oblique_info();
  MemorySource plain(info);
  EXPECT_TRUE(contains(failure_of(plain, folder / "a.tif"), ".nrrd, .mha or .raw"));
  info.slope = 2;
  MemorySource scaled(info);
  EXPECT_TRUE(contains(failure_of(scaled, folder / "a.nrrd"), "slope 2"));
  EXPECT_TRUE(contains(failure_of(scaled, folder / "a.mha"), "slope 2"));
  EXPECT_EQ(folder.entries(), 0u);
  write_volume(scaled, folder / "a.raw");
  EXPECT_EQ(get(folder / "a.raw").size(), 120u);
}

TEST(WriteVolume, LeavesTheOldFileWhenTheSourceFails) {
  const TempFolder folder;
  const std::string path = folder.put("a.nrrd", "old");
  MemorySource source(oblique_info());
  source.fails_from = 4;
  EXPECT_THROW(write_volume(source, path), BadInput);
  EXPECT_EQ(get(path), "old");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(WriteVolume, NamesTheTargetThatCannotBeCreated) {
  const TempFolder folder;
  MemorySource source(oblique_info());
  const std::string message = failure_of(source, folder / "missing/a.nrrd");
  EXPECT_TRUE(contains(message, "missing/a.nrrd")) << message;
  EXPECT_TRUE(contains(message, "No such file or directory")) << message;
}

}  // namespace
}  // namespace isoweave::testing::volume_write_test
