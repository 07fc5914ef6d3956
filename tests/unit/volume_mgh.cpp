#include <cmath>

#include "header_helpers.hpp"

namespace isoweave::testing::volume_mgh_test {
namespace {

const std::vector<std::int16_t> kSamples = ramp<std::int16_t>(3 * 2 * 5);

std::string mgh_file(const MghFields& fields) { return mgh_header(fields) + stored(kSamples, true); }

VolumeInfo info_of(const TempFolder& folder, const MghFields& fields) {
  return open_volume(folder.put("a.mgh", mgh_file(fields)))->info();
}

TEST(Mgh, ReadsPlainAndPackedFilesWithWhatFollowsTheSamples) {
  const TempFolder folder;
  const std::string content = mgh_file({}) + std::string(40, 't');
  for (const std::string& path : {folder.put("a.mgh", content), folder.put("a.mgz", gzipped(content))}) {
    const auto source = open_volume(path);
    EXPECT_EQ(source->info().format, "mgh");
    EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{3, 2, 5}));
    EXPECT_EQ(source->info().geometry.spacing, (std::array<double, 3>{0.5, 0.75, 2}));
    EXPECT_EQ(source->info().geometry.space, Space::kRas);
    EXPECT_EQ(source->info().geometry.unit, "mm");
    EXPECT_EQ(samples_of<std::int16_t>(*source), kSamples);
  }
}

// The centre is that of sample (nx/2, ny/2, nz/2), halves included.
TEST(Mgh, PutsTheVolumeAroundItsCentre) {
  const TempFolder folder;
  MghFields fields;
  fields.centre = {10, 20, 30};
  const Geometry geometry = info_of(folder, fields).geometry;
  EXPECT_EQ(geometry.direction, (std::array<double, 9>{-1, 0, 0, 0, 0, 1, 0, -1, 0}));
  // i: 1.5 samples of 0.5 to -x; j: 1 of 0.75 to -z; k: 2.5 of 2 to y.
  EXPECT_EQ(geometry.origin, (std::array<double, 3>{10.75, 15, 30.75}));
}

TEST(Mgh, WithoutAPlaceIsCoronalAroundTheOriginWithANote) {
  const TempFolder folder;
  MghFields fields;
  fields.placed = false;
  fields.spacing = {0, 0, 0};
  const VolumeInfo info = info_of(folder, fields);
  EXPECT_EQ(info.geometry.spacing, (std::array<double, 3>{1, 1, 1}));
  EXPECT_EQ(info.geometry.origin, (std::array<double, 3>{1.5, -2.5, 1}));
  EXPECT_TRUE(contains(info.notes.at(0), "does not say where"));
}

TEST(Mgh, ReadsItsTypesAndTheFirstFrame) {
  const TempFolder folder;
  const std::vector<std::pair<int, SampleType>> types{{0, SampleType::kUint8},   {1, SampleType::kInt32},
                                                      {3, SampleType::kFloat32}, {4, SampleType::kInt16},
                                                      {8, SampleType::kFloat64}, {10, SampleType::kUint16}};
  MghFields fields;
  for (const auto& [code, type] : types) {
    fields.numbers[5] = code;
    const std::string content = mgh_header(fields) + std::string(30 * sample_bytes(type), 'x');
    EXPECT_EQ(open_volume(folder.put("a.mgh", content))->info().type, type);
  }
  fields.numbers[5] = 7;
  EXPECT_TRUE(contains(refusal(folder.put("a.mgh", mgh_file(fields))), "found 7"));
  fields.numbers[5] = 4;
  fields.numbers[4] = 12;
  EXPECT_TRUE(contains(info_of(folder, fields).notes.at(0), "the first of 12 along time is read"));
}

TEST(Mgh, ReadsTheFrameThatIsAskedFor) {
  const TempFolder folder;
  MghFields fields;
  fields.numbers[4] = 2;
  const std::vector<std::int16_t> both = ramp<std::int16_t>(60);
  const std::string content = mgh_header(fields) + stored(both, true);
  OpenOptions options;
  for (const std::string& path : {folder.put("a.mgh", content), folder.put("a.mgz", gzipped(content))}) {
    for (const int frame : {0, 1}) {
      options.time = frame;
      const auto first = both.begin() + 30 * frame;
      EXPECT_EQ(read_file<std::int16_t>(path, options), std::vector<std::int16_t>(first, first + 30));
      EXPECT_EQ(open_volume(path, options)->info().part, "time " + std::to_string(frame));
    }
    options.time = 2;
    EXPECT_TRUE(contains(refusal(path, options), "expected --time below 2, found 2"));
  }
  options.time.reset();
  options.channel = 0;
  EXPECT_TRUE(contains(refusal(folder / "a.mgh", options), "an axis for --channel"));
}

TEST(Mgh, RefusesHeadersThatLie) {
  const TempFolder folder;
  const auto refused = [&](const MghFields& fields, const std::string& why) {
    const std::string message = refusal(folder.put("a.mgh", mgh_file(fields)));
    EXPECT_TRUE(contains(message, why)) << message;
  };
  MghFields fields;
  fields.numbers[3] = 6;
  refused(fields, "72 bytes of samples from byte 284 on, found a file of 344");
  fields.numbers[3] = 0;
  refused(fields, "an MGH header");
  fields = {};
  fields.numbers[0] = 2;
  refused(fields, "an MGH header");
  fields = {};
  fields.spacing[1] = std::nan("");
  refused(fields, "spacing");
  fields = {};
  fields.directions[0] = 0;
  refused(fields, "spacing on axis 0");
}

TEST(Mgh, SurvivesTruncationAndRandomChanges) {
  const TempFolder folder;
  const std::string content = mgh_file({});
  expect_prefixes_are_safe(folder, "a.mgh", content);
  expect_flips_are_safe(folder, "a.mgh", content, 90, 1000);
  expect_prefixes_are_safe(folder, "a.mgz", gzipped(content));
  expect_flips_are_safe(folder, "a.mgz", gzipped(content), 40, 1000);
}

}  // namespace
}  // namespace isoweave::testing::volume_mgh_test
