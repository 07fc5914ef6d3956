#include <cmath>
#include <numbers>

#include "header_helpers.hpp"

namespace isoweave::testing::volume_mrc_test {
namespace {

const std::vector<std::int16_t> kSamples = ramp<std::int16_t>(3 * 2 * 5);

std::string mrc_file(const MrcFields& fields) {
  return mrc_header(fields) + std::string(static_cast<std::size_t>(std::max(fields.extended, 0)), 'e') +
         stored(kSamples, fields.big);
}

VolumeInfo info_of(const TempFolder& folder, const MrcFields& fields, const std::string& name = "a.mrc") {
  return open_volume(folder.put(name, mrc_file(fields)))->info();
}

TEST(Mrc, ReadsBothByteOrdersBehindAnExtendedHeader) {
  const TempFolder folder;
  for (const bool big : {false, true}) {
    for (const int extended : {0, 160}) {
      MrcFields fields;
      fields.big = big;
      fields.extended = extended;
      const auto source = open_volume(folder.put("a", mrc_file(fields)));
      const VolumeInfo& info = source->info();
      EXPECT_EQ(info.format, "mrc");
      EXPECT_EQ(info.dims, (std::array<std::int64_t, 3>{3, 2, 5}));
      EXPECT_EQ(info.geometry.unit, "nm");
      for (std::size_t n = 0; n < 3; ++n) EXPECT_NEAR(info.geometry.spacing[n], 0.5 * (1 << n), 1e-12);
      EXPECT_EQ(samples_of<std::int16_t>(*source), kSamples);
    }
  }
}

TEST(Mrc, ReadsItsModesAndNamesTheOthers) {
  const TempFolder folder;
  MrcFields fields;
  const auto type = [&](int mode) {
    fields.mode = mode;
    return open_volume(folder.put("a.mrc", mrc_header(fields) + std::string(120, '\0')))->info().type;
  };
  EXPECT_EQ(type(0), SampleType::kInt8);
  EXPECT_EQ(type(1), SampleType::kInt16);
  EXPECT_EQ(type(2), SampleType::kFloat32);
  EXPECT_EQ(type(6), SampleType::kUint16);
  for (const auto& [mode, name] : {std::pair{3, "complex"}, {4, "complex"}, {16, "RGB"}, {101, "4 bits"}}) {
    fields.mode = mode;
    EXPECT_TRUE(contains(refusal(folder.put("a.mrc", mrc_file(fields))), name));
  }
}

TEST(Mrc, TakesBytesAsIMODOrTheRangeOfValuesSays) {
  const TempFolder folder;
  MrcFields fields;
  fields.mode = 0;
  fields.imod_flags = 0;
  EXPECT_EQ(info_of(folder, fields).type, SampleType::kUint8);
  fields.imod_flags = 1;
  EXPECT_EQ(info_of(folder, fields).type, SampleType::kInt8);
  fields.imod_flags = -1;
  fields.range = {0, 255};
  EXPECT_EQ(info_of(folder, fields).type, SampleType::kUint8);
  EXPECT_TRUE(contains(info_of(folder, fields).notes.at(0), "unsigned"));
  fields.range = {-128, 127};
  EXPECT_EQ(info_of(folder, fields).type, SampleType::kInt8);
}

// Columns along z and sections along x: positions are those of the cell, whatever the order of storage.
TEST(Mrc, AppliesTheOrderOfAxes) {
  const TempFolder folder;
  MrcFields fields;
  fields.axes = {3, 2, 1};
  fields.grid = {5, 2, 3};
  fields.cell = {50, 40, 90};  // 10, 20, 30 angstrom apart
  fields.start = {1, 2, 3};    // along z, y, x
  const Geometry geometry = info_of(folder, fields).geometry;
  const std::array<double, 3> spacing{3, 2, 1};
  const std::array<double, 3> origin{3, 4, 3};
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_NEAR(geometry.spacing[n], spacing[n], 1e-12);
    EXPECT_NEAR(geometry.origin[n], origin[n], 1e-12);
  }
  EXPECT_EQ(geometry.direction, (std::array<double, 9>{0, 0, 1, 0, 1, 0, 1, 0, 0}));
}

TEST(Mrc, AppliesTheAnglesOfTheCell) {
  const TempFolder folder;
  MrcFields fields;
  fields.angles = {90, 90, 120};
  const Geometry geometry = info_of(folder, fields).geometry;
  EXPECT_NEAR(geometry.spacing[1], 1, 1e-12);
  EXPECT_NEAR(geometry.direction[1], -0.5, 1e-6);
  EXPECT_NEAR(geometry.direction[4], std::sqrt(0.75), 1e-6);
  EXPECT_NEAR(geometry.direction[8], 1, 1e-12);
  fields.angles = {60, 60, 60};  // of a rhombohedron: the third axis leans to both
  const std::array<double, 9> leaning = info_of(folder, fields).geometry.direction;
  EXPECT_NEAR(leaning[2], 0.5, 1e-6);
  EXPECT_NEAR(leaning[5], std::sqrt(1.0 / 12), 1e-6);
  EXPECT_NEAR(leaning[8], std::sqrt(2.0 / 3), 1e-6);
  fields.angles = {0, 0, 0};
  EXPECT_EQ(info_of(folder, fields).geometry.direction, (std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
  fields.angles = {90, 90, 180};
  EXPECT_TRUE(contains(refusal(folder.put("a.mrc", mrc_file(fields))), "spacing"));
}

TEST(Mrc, TakesTheOriginBeforeTheFirstIndex) {
  const TempFolder folder;
  MrcFields fields;
  const auto expect_origin = [&](const std::array<double, 3>& expected) {
    const std::array<double, 3> origin = info_of(folder, fields).geometry.origin;
    for (std::size_t n = 0; n < 3; ++n) EXPECT_NEAR(origin[n], expected[n], 1e-6);
  };
  fields.start = {-2, 4, 10};
  expect_origin({-1, 4, 20});
  fields.origin = {10, -20, 30};
  expect_origin({1, -2, 3});
  EXPECT_TRUE(contains(info_of(folder, fields).notes.at(0), "first index"));
  fields.start = {0, 0, 0};
  fields.imod_flags = 4;
  expect_origin({1, -2, 3});
  fields.imod_flags = 0;
  expect_origin({-1, 2, -3});
  EXPECT_TRUE(contains(info_of(folder, fields).notes.at(0), "IMOD"));
}

TEST(Mrc, SaysWhichSpacingIsNotThere) {
  const TempFolder folder;
  MrcFields fields;
  fields.cell = {15, 20, 0};
  VolumeInfo info = info_of(folder, fields);
  EXPECT_NEAR(info.geometry.spacing[2], 0.5, 1e-6);
  EXPECT_TRUE(contains(info.notes.at(0), "along z"));
  fields.cell = {0, 0, 0};
  info = info_of(folder, fields);
  EXPECT_EQ(info.geometry.spacing, (std::array<double, 3>{1, 1, 1}));
  EXPECT_EQ(info.geometry.unit, "");
  EXPECT_EQ(info.notes.size(), 3u);
}

TEST(Mrc, ReadsTheFirstOfAStackOfVolumes) {
  const TempFolder folder;
  MrcFields fields;
  fields.dims = {3, 1, 10};
  fields.grid = {3, 1, 5};
  fields.group = 401;
  const VolumeInfo info = info_of(folder, fields);
  EXPECT_EQ(info.dims[2], 5);
  EXPECT_TRUE(contains(info.notes.at(0), "the first of 2 along time is read"));
  OpenOptions options;
  options.time = 1;
  const auto second = read_file<std::int16_t>(folder / "a.mrc", options);
  EXPECT_EQ(second, std::vector<std::int16_t>(kSamples.begin() + 15, kSamples.end()));
  fields.group = 1;
  EXPECT_EQ(info_of(folder, fields).dims[2], 10);
}

TEST(Mrc, ReadsFilesWithoutTheMagicByTheirName) {
  const TempFolder folder;
  for (const bool big : {false, true}) {
    MrcFields fields;
    fields.big = big;
    fields.magic = false;
    fields.axes = {0, 0, 0};
    for (const std::string name : {"a.rec", "b.MRC", "c.map"}) {
      EXPECT_EQ(read_file<std::int16_t>(folder.put(name, mrc_file(fields))), kSamples);
    }
    EXPECT_TRUE(contains(refusal(folder.put("a.xyz", mrc_file(fields))), "other content"));
    // Zeros do not tell the order of bytes: the sizes that make sense do.
    fields.mode = 0;
    EXPECT_EQ(info_of(folder, fields).dims, (std::array<std::int64_t, 3>{3, 2, 5}));
  }
}

TEST(Mrc, RefusesHeadersThatLie) {
  const TempFolder folder;
  const auto refused = [&](const MrcFields& fields, const std::string& why) {
    const std::string message = refusal(folder.put("a.mrc", mrc_file(fields)));
    EXPECT_TRUE(contains(message, why)) << message;
  };
  MrcFields fields;
  fields.dims[2] = 6;
  refused(fields, "72 bytes of samples from byte 1024 on, found a file of 1084");
  fields.dims[2] = 0;
  refused(fields, "an MRC header");
  fields = {};
  fields.dims = {2147483647, 2147483647, 2147483647};
  refused(fields, "2^63");
  fields = {};
  fields.extended = -1;
  refused(fields, "extended header");
  fields = {};
  fields.axes = {1, 1, 3};
  refused(fields, "an MRC header");
  fields = {};
  fields.origin[1] = std::nan("");
  refused(fields, "origin");
}

TEST(Mrc, SurvivesTruncationAndRandomChanges) {
  const TempFolder folder;
  MrcFields fields;
  fields.extended = 8;
  expect_prefixes_are_safe(folder, "a.mrc", mrc_file(fields));
  expect_flips_are_safe(folder, "a.mrc", mrc_file(fields), 230, 1000);
}

}  // namespace
}  // namespace isoweave::testing::volume_mrc_test
