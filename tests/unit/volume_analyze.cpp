#include <cmath>

#include "header_helpers.hpp"

namespace isoweave::testing::volume_analyze_test {
namespace {

const std::vector<std::int16_t> kSamples = ramp<std::int16_t>(3 * 2 * 5);

std::string put_pair(const TempFolder& folder, const AnalyzeFields& fields) {
  folder.put("a.img", stored(kSamples, fields.big));
  return folder.put("a.hdr", analyze_header(fields));
}

TEST(Analyze, ReadsBothByteOrdersByTheNameOfEitherFile) {
  const TempFolder folder;
  for (const bool big : {false, true}) {
    AnalyzeFields fields;
    fields.big = big;
    for (const std::string& path : {put_pair(folder, fields), folder / "a.img"}) {
      const auto source = open_volume(path);
      EXPECT_EQ(source->info().path, path);
      EXPECT_EQ(source->info().format, "analyze");
      EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{3, 2, 5}));
      EXPECT_EQ(source->info().geometry.spacing, (std::array<double, 3>{0.5, 0.75, 2}));
      EXPECT_EQ(source->info().geometry.space, Space::kUnknown);
      EXPECT_TRUE(contains(source->info().notes.at(0), "which side is left"));
      EXPECT_EQ(samples_of<std::int16_t>(*source), kSamples);
    }
  }
}

TEST(Analyze, ReadsPackedFilesAndNamesInCapitals) {
  const TempFolder folder;
  folder.put("p.img.gz", gzipped(stored(kSamples)));
  EXPECT_EQ(read_file<std::int16_t>(folder.put("p.hdr.gz", gzipped(analyze_header({})))), kSamples);
  EXPECT_EQ(read_file<std::int16_t>(folder.put("p.hdr", analyze_header({}))), kSamples);
  EXPECT_EQ(read_file<std::int16_t>(folder / "p.img.gz"), kSamples);
  folder.put("C.IMG", stored(kSamples));
  EXPECT_EQ(read_file<std::int16_t>(folder.put("C.HDR", analyze_header({}))), kSamples);
  EXPECT_EQ(read_file<std::int16_t>(folder / "C.IMG"), kSamples);
  EXPECT_EQ(refusal(folder.put("lost.img", "x")),
            folder / "lost.img" + ": expected its header in " + folder / "lost.hdr" + ", found no such file");
  EXPECT_TRUE(contains(refusal(folder.put("alone.hdr", analyze_header({}))),
                       "alone.hdr: expected its samples in " + folder / "alone.img" + ", found no such file"));
}

TEST(Analyze, AppliesAndNotesWhatSpmKeepsInFreeFields) {
  const TempFolder folder;
  AnalyzeFields fields;
  fields.scale = 0.5;
  fields.orientation = 2;
  fields.origin = {46, 64, 37};
  const VolumeInfo info = open_volume(put_pair(folder, fields))->info();
  EXPECT_EQ(info.slope, 0.5);
  EXPECT_TRUE(contains(info.notes.at(0), "orient 2"));
  EXPECT_TRUE(contains(info.notes.at(0), "46 64 37"));
  EXPECT_TRUE(contains(info.notes.at(1), "scaled by 0.5"));
  for (const double scale : {0.0, 1.0, std::nan("")}) {
    fields.scale = scale;
    EXPECT_EQ(open_volume(put_pair(folder, fields))->info().slope, 1);
  }
}

TEST(Analyze, ReadsItsTypesBehindAnOffset) {
  const TempFolder folder;
  const std::vector<std::pair<int, SampleType>> types{
      {2, SampleType::kUint8},    {4, SampleType::kInt16},  {8, SampleType::kInt32},    {16, SampleType::kFloat32},
      {64, SampleType::kFloat64}, {130, SampleType::kInt8}, {132, SampleType::kUint16}, {136, SampleType::kUint32}};
  AnalyzeFields fields;
  fields.offset = 16;
  for (const auto& [code, type] : types) {
    fields.type = code;
    const std::string path = put_pair(folder, fields);
    folder.put("a.img", std::string(16, 'o') + std::string(30 * sample_bytes(type), 'x'));
    const auto source = open_volume(path);
    EXPECT_EQ(source->info().type, type);
    EXPECT_EQ(read_all(*source), std::vector<std::byte>(30 * sample_bytes(type), std::byte{'x'}));
  }
  for (const auto& [code, name] : {std::pair{1, "1 bit"}, {32, "complex64"}, {128, "RGB"}, {77, "code 77"}}) {
    fields.type = code;
    EXPECT_TRUE(contains(refusal(put_pair(folder, fields)), name));
  }
}

TEST(Analyze, ReadsTheFirstVolumeAndSingleSlices) {
  const TempFolder folder;
  AnalyzeFields fields;
  fields.dim = {4, 3, 2, 1, 5, 0, 0, 0};
  EXPECT_TRUE(contains(open_volume(put_pair(folder, fields))->info().notes.at(0), "the first of 5 along time is read"));
  OpenOptions options;
  options.time = 4;
  const auto last = read_file<std::int16_t>(folder / "a.hdr", options);
  EXPECT_EQ(last, std::vector<std::int16_t>(kSamples.end() - 6, kSamples.end()));
  options.time.reset();
  options.slices_from = SliceAxis::kTimes;
  EXPECT_EQ(read_file<std::int16_t>(folder / "a.hdr", options), kSamples);
  fields.dim = {2, 3, 10, 0, 0, 0, 0, 0};
  EXPECT_EQ(open_volume(put_pair(folder, fields))->info().dims, (std::array<std::int64_t, 3>{3, 10, 1}));
}

TEST(Analyze, RefusesHeadersThatLie) {
  const TempFolder folder;
  const auto refused = [&](const AnalyzeFields& fields, const std::string& why) {
    const std::string message = refusal(put_pair(folder, fields));
    EXPECT_TRUE(contains(message, why)) << message;
  };
  AnalyzeFields fields;
  fields.dim[3] = 6;
  refused(fields, "72 bytes of samples from byte 0 on, found a file of 60");
  fields.dim[2] = 0;
  refused(fields, "at least 1");
  fields.dim[2] = -2;
  refused(fields, "at least 1");
  fields = {};
  fields.dim[0] = 1;
  refused(fields, "2 to 7 dimensions");
  fields = {};
  fields.offset = -1;
  refused(fields, "an offset of -1");
  fields.offset = std::nan("");
  refused(fields, "an offset of nan");
  fields = {};
  fields.pixdim[2] = INFINITY;
  refused(fields, "spacing");
}

TEST(Analyze, SurvivesTruncationAndRandomChanges) {
  const TempFolder folder;
  const std::string header = analyze_header({});
  folder.put("a.img", stored(kSamples));
  expect_prefixes_are_safe(folder, "a.hdr", header);
  expect_flips_are_safe(folder, "a.hdr", header, 116, 1000);
}

}  // namespace
}  // namespace isoweave::testing::volume_analyze_test
