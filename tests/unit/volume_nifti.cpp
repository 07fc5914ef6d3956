#include <cmath>

#include "volume_helpers.hpp"

namespace isoweave::testing::volume_nifti_test {
namespace {

const std::vector<std::int16_t> kSamples = ramp<std::int16_t>(3 * 2 * 5);

std::string nifti_file(const NiftiFields& fields) { return nifti_header(fields) + stored(kSamples, fields.big); }

VolumeInfo info_of(const TempFolder& folder, const NiftiFields& fields) {
  return open_volume(folder.put("a.nii", nifti_file(fields)))->info();
}

TEST(Nifti, ReadsBothVersionsBothByteOrdersPlainAndGzip) {
  const TempFolder folder;
  for (const int version : {1, 2}) {
    for (const bool big : {false, true}) {
      NiftiFields fields;
      fields.version = version;
      fields.big = big;
      const std::string content = nifti_file(fields);
      for (const std::string& path : {folder.put("a.nii", content), folder.put("a.nii.gz", gzipped(content))}) {
        const auto source = open_volume(path);
        EXPECT_EQ(source->info().format, "nifti");
        EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{3, 2, 5}));
        EXPECT_EQ(source->info().type, SampleType::kInt16);
        EXPECT_EQ(source->info().geometry.spacing, (std::array<double, 3>{0.5, 0.75, 2}));
        EXPECT_EQ(samples_of<std::int16_t>(*source), kSamples) << path << " version " << version << " big " << big;
      }
    }
  }
}

TEST(Nifti, ReadsGzipOfSeveralMembersWithPadding) {
  const TempFolder folder;
  const std::string content = nifti_file({});
  const std::string members = gzipped(content.substr(0, 100)) + gzipped(content.substr(100)) + std::string(16, '\0');
  EXPECT_EQ(read_file<std::int16_t>(folder.put("a.nii.gz", members)), kSamples);
}

TEST(Nifti, SkipsSlicesOfAGzipStream) {
  const TempFolder folder;
  const auto source = open_volume(folder.put("a.nii.gz", gzipped(nifti_file({}))));
  std::vector<std::int16_t> slice(6);
  source->read(3, 1, std::as_writable_bytes(std::span(slice)));
  EXPECT_TRUE(std::equal(slice.begin(), slice.end(), kSamples.begin() + 18));
}

TEST(Nifti, ReadsAllScalarTypesAndNamesTheOthers) {
  const TempFolder folder;
  const std::vector<std::pair<int, SampleType>> types{
      {2, SampleType::kUint8},    {4, SampleType::kInt16},    {8, SampleType::kInt32},    {16, SampleType::kFloat32},
      {64, SampleType::kFloat64}, {256, SampleType::kInt8},   {512, SampleType::kUint16}, {768, SampleType::kUint32},
      {1024, SampleType::kInt64}, {1280, SampleType::kUint64}};
  for (const auto& [code, type] : types) {
    NiftiFields fields;
    fields.type = static_cast<std::int16_t>(code);
    const auto path = folder.put("a.nii", nifti_header(fields) + std::string(30 * sample_bytes(type), 'x'));
    EXPECT_EQ(open_volume(path)->info().type, type);
  }
  const std::vector<std::pair<int, std::string>> refused{{1, "1 bit"},       {32, "complex64"}, {128, "RGB"},
                                                         {1536, "float128"}, {2304, "RGBA"},    {0, "code 0"},
                                                         {-7, "code -7"}};
  for (const auto& [code, name] : refused) {
    NiftiFields fields;
    fields.type = static_cast<std::int16_t>(code);
    const std::string message = refusal(folder.put("a.nii", nifti_file(fields)));
    EXPECT_TRUE(contains(message, name)) << message;
  }
}

TEST(Nifti, TakesAxesFromSformBeforeQform) {
  const TempFolder folder;
  NiftiFields fields;
  fields.qform = 1;
  fields.sform = 1;
  fields.rows = {0, -2, 0, 10, 3, 0, 0, 20, 0, 0, 4, 30};
  const Geometry geometry = info_of(folder, fields).geometry;
  EXPECT_EQ(geometry.spacing, (std::array<double, 3>{3, 2, 4}));
  EXPECT_EQ(geometry.origin, (std::array<double, 3>{10, 20, 30}));
  EXPECT_EQ(geometry.direction, (std::array<double, 9>{0, -1, 0, 1, 0, 0, 0, 0, 1}));
  EXPECT_EQ(geometry.space, Space::kRas);
  EXPECT_EQ(geometry.unit, "mm");
}

TEST(Nifti, TakesAxesFromQformWithItsMirror) {
  const TempFolder folder;
  NiftiFields fields;
  fields.qform = 1;
  fields.pixdim = {-1, 1, 2, 3, 0, 0, 0, 0};
  // A quarter turn about z: a = d = sqrt(1/2).
  fields.quaternion = {0, 0, std::sqrt(0.5), 5, 6, 7};
  const Geometry geometry = info_of(folder, fields).geometry;
  const std::array<double, 9> expected{0, -1, 0, 1, 0, 0, 0, 0, -1};
  for (std::size_t n = 0; n < 9; ++n) EXPECT_NEAR(geometry.direction[n], expected[n], 1e-6) << n;
  EXPECT_NEAR(geometry.spacing[1], 2, 1e-6);
  EXPECT_EQ(geometry.origin, (std::array<double, 3>{5, 6, 7}));
  EXPECT_EQ(geometry.space, Space::kRas);
}

TEST(Nifti, WithoutOrientationSaysSo) {
  const TempFolder folder;
  const VolumeInfo info = info_of(folder, {});
  EXPECT_EQ(info.geometry.space, Space::kUnknown);
  ASSERT_EQ(info.notes.size(), 1u);
  EXPECT_TRUE(contains(info.notes[0], "no orientation"));
}

TEST(Nifti, RepairsZeroAndNegativeSpacingButNotNan) {
  const TempFolder folder;
  NiftiFields fields;
  fields.pixdim = {1, 0, -2, 3, 0, 0, 0, 0};
  const VolumeInfo info = info_of(folder, fields);
  EXPECT_EQ(info.geometry.spacing, (std::array<double, 3>{1, 2, 3}));
  EXPECT_TRUE(contains(info.notes.at(0), "taken as 1"));
  fields.pixdim[1] = std::nan("");
  EXPECT_TRUE(contains(refusal(folder.put("a.nii", nifti_file(fields))), "spacing"));
  fields.pixdim[1] = INFINITY;
  EXPECT_TRUE(contains(refusal(folder.put("a.nii", nifti_file(fields))), "spacing"));
}

TEST(Nifti, RefusesAxesThatDoNotSpanSpace) {
  const TempFolder folder;
  NiftiFields fields;
  fields.sform = 1;
  fields.rows = {1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0};
  EXPECT_TRUE(contains(refusal(folder.put("a.nii", nifti_file(fields))), "span space"));
  fields.rows = {0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  EXPECT_TRUE(contains(refusal(folder.put("a.nii", nifti_file(fields))),
                       "expected a positive, finite sample spacing on axis 0 by the sform (code 1), found 0"));
  fields.rows = {1, 0, 0, std::nan(""), 0, 1, 0, 0, 0, 0, 1, 0};
  EXPECT_TRUE(contains(refusal(folder.put("a.nii", nifti_file(fields))), "origin"));
}

TEST(Nifti, CarriesScalingUnlessItIsVoid) {
  const TempFolder folder;
  NiftiFields fields;
  fields.slope = 2;
  fields.intercept = -1024;
  EXPECT_EQ(info_of(folder, fields).slope, 2);
  EXPECT_EQ(info_of(folder, fields).intercept, -1024);
  for (const double slope : {0.0, std::nan(""), static_cast<double>(INFINITY)}) {
    fields.slope = slope;
    EXPECT_EQ(info_of(folder, fields).slope, 1);
    EXPECT_EQ(info_of(folder, fields).intercept, 0);
  }
}

TEST(Nifti, ReadsTheFirstOfSeveralVolumesAndNotesIt) {
  const TempFolder folder;
  NiftiFields fields;
  fields.dim = {4, 3, 2, 5, 12, 1, 1, 1};
  const auto source = open_volume(folder.put("a.nii", nifti_file(fields) + std::string(11 * 60, 'x')));
  EXPECT_EQ(source->info().notes.at(0), "the first of 12 along time is read; --time chooses");
  EXPECT_EQ(samples_of<std::int16_t>(*source), kSamples);
}

TEST(Nifti, ChoosesATimeAndAChannel) {
  const TempFolder folder;
  NiftiFields fields;
  fields.dim = {6, 3, 2, 5, 2, 3, 2, 1};
  const auto samples = ramp<std::int16_t>(30 * 12);
  const std::string content = nifti_header(fields) + stored(samples);
  for (const std::string& path : {folder.put("a.nii", content), folder.put("a.nii.gz", gzipped(content))}) {
    for (std::int64_t volume = 0; volume < 12; ++volume) {
      OpenOptions options;
      options.time = volume % 2;
      options.channel = volume / 2;
      const auto read = read_file<std::int16_t>(path, options);
      const auto first = samples.begin() + 30 * volume;
      EXPECT_EQ(read, std::vector<std::int16_t>(first, first + 30)) << volume;
    }
    OpenOptions options;
    options.channel = 6;
    EXPECT_TRUE(contains(refusal(path, options), "expected --channel below 6, found 6"));
  }
  // The volumes that are there can be read; that others are not is told.
  const std::string cut = folder.put("b.nii", content.substr(0, content.size() - 60));
  EXPECT_TRUE(contains(open_volume(cut)->info().notes.back(), "the file ends before the last of the volumes"));
  OpenOptions last;
  last.time = 1;
  last.channel = 5;
  EXPECT_TRUE(contains(refusal(cut, last), "bytes of samples from byte 352"));
}

TEST(Nifti, SlicesThatWereWrittenAsTimes) {
  const TempFolder folder;
  NiftiFields fields;
  fields.dim = {5, 3, 2, 1, 5, 2, 1, 1};
  OpenOptions options;
  options.slices_from = SliceAxis::kTimes;
  options.channel = 1;
  const auto samples = ramp<std::int16_t>(60);
  const auto source = open_volume(folder.put("a.nii", nifti_header(fields) + stored(samples)), options);
  EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{3, 2, 5}));
  EXPECT_EQ(source->info().geometry.spacing[2], 2);
  EXPECT_EQ(samples_of<std::int16_t>(*source), std::vector<std::int16_t>(samples.begin() + 30, samples.end()));
  options.slices_from = SliceAxis::kChannels;
  options.channel.reset();
  options.time = 4;
  const auto channels = read_file<std::int16_t>(folder / "a.nii", options);
  EXPECT_EQ(channels.at(0), samples.at(24));
  EXPECT_EQ(channels.at(6), samples.at(54));
}

TEST(Nifti, OtherBitsAndVectorsAreTold) {
  const TempFolder folder;
  for (const int version : {1, 2}) {
    NiftiFields fields;
    fields.version = version;
    fields.sform = 1;
    fields.rows = {0.5, 0, 0, 10, 0, 0.75, 0, 20, 0, 0, 2, 30};
    fields.bits = 16;
    fields.intent = 1007;
    EXPECT_TRUE(info_of(folder, fields).notes.empty());
    fields.bits = 32;
    EXPECT_TRUE(
        contains(info_of(folder, fields).notes.at(0), "int16 by the code of their type, which is taken, and of 32"));
    fields.bits = 0;
    fields.dim = {5, 3, 2, 1, 1, 5, 1, 1};
    EXPECT_TRUE(contains(info_of(folder, fields).notes.back(), "vectors or matrices (intent code 1007)"));
  }
}

TEST(Nifti, BytesBehindTheSamplesAreTold) {
  const TempFolder folder;
  NiftiFields fields;
  fields.sform = 1;
  fields.rows = {0.5, 0, 0, 10, 0, 0.75, 0, 20, 0, 0, 2, 30};
  const VolumeInfo info = open_volume(folder.put("a.nii", nifti_file(fields) + "xyz"))->info();
  EXPECT_EQ(info.notes.at(0), "3 bytes behind the samples that the header describes are not read");
}

TEST(Nifti, FormsThatDifferAreTold) {
  const TempFolder folder;
  NiftiFields fields;
  fields.sform = 2;
  fields.qform = 1;
  fields.rows = {0.5, 0, 0, 10, 0, 0.75, 0, 20, 0, 0, 2, 30};
  fields.quaternion = {0, 0, 0, 10, 20, 30};
  EXPECT_TRUE(info_of(folder, fields).notes.empty());
  fields.quaternion[3] = 10.004;  // rounding
  EXPECT_TRUE(info_of(folder, fields).notes.empty());
  fields.quaternion[3] = 13;
  fields.quaternion[4] = 24;
  const VolumeInfo info = info_of(folder, fields);
  EXPECT_EQ(info.geometry.origin[0], 10);
  EXPECT_EQ(info.notes.at(0),
            "sform and qform differ: the sform (code 2) is taken, the qform (code 1) puts corners up to 5 away");
  fields.qform = 0;
  EXPECT_TRUE(info_of(folder, fields).notes.empty());
  fields.rows[10] = 3;
  EXPECT_EQ(info_of(folder, fields).notes.at(0),
            "the spacing of axis 2 is 3 by the sform, which is taken, and 2 by pixdim");
}

TEST(Nifti, ReadsPlaneImages) {
  const TempFolder folder;
  NiftiFields fields;
  fields.dim = {2, 6, 5, 0, 0, 0, 0, 0};
  EXPECT_EQ(info_of(folder, fields).dims, (std::array<std::int64_t, 3>{6, 5, 1}));
}

TEST(Nifti, ReadsPairsFromEitherName) {
  const TempFolder folder;
  NiftiFields fields;
  fields.pair = true;
  folder.put("a.img", stored(kSamples));
  const std::string header = folder.put("a.hdr", nifti_header(fields));
  EXPECT_EQ(read_file<std::int16_t>(header), kSamples);
  EXPECT_EQ(read_file<std::int16_t>(folder / "a.img"), kSamples);
  std::filesystem::remove(folder / "a.img");
  EXPECT_TRUE(contains(refusal(header), "a.hdr: expected its samples in " + folder / "a.img" + ", found no such file"));
  folder.put("a.img.gz", gzipped(stored(kSamples)));
  EXPECT_EQ(read_file<std::int16_t>(header), kSamples);
}

TEST(Nifti, AMagicThatIsNotThatOfItsNameIsTold) {
  const TempFolder folder;
  for (const int version : {1, 2}) {
    const std::string number = std::to_string(version);
    for (const bool big : {false, true}) {
      NiftiFields fields;
      fields.version = version;
      fields.big = big;
      std::string content = nifti_file(fields);
      const std::size_t at = version == 1 ? 344 : 4;
      for (const std::string& magic : {"ni" + number, std::string("n,1"), std::string("???")}) {
        content.replace(at, 3, magic);
        const std::string expected =
            "expected the magic 'n+" + number + "' of a NIfTI file with its samples, found '" + magic + "'";
        EXPECT_TRUE(contains(refusal(folder.put("a.nii", content)), expected)) << refusal(folder / "a.nii");
        EXPECT_TRUE(contains(refusal(folder.put("a.NII.gz", gzipped(content))), expected));
      }
    }
  }
}

TEST(Nifti, ReadsFromADistantOffset) {
  const TempFolder folder;
  NiftiFields fields;
  fields.offset = 1000;
  const std::string header = nifti_header(fields);
  const std::string content = header + std::string(1000 - header.size(), 'x') + stored(kSamples);
  EXPECT_EQ(read_file<std::int16_t>(folder.put("a.nii", content)), kSamples);
  for (const double offset : {-1.0, 12.0, 1e18, static_cast<double>(INFINITY), std::nan("")}) {
    fields.offset = offset;
    EXPECT_TRUE(contains(refusal(folder.put("a.nii", nifti_file(fields))), "expected")) << offset;
  }
}

TEST(Nifti, RefusesHeadersThatLie) {
  const TempFolder folder;
  const auto refused = [&](const NiftiFields& fields, const std::string& why) {
    const std::string content = nifti_file(fields);
    for (const auto& path : {folder.put("a.nii", content), folder.put("a.nii.gz", gzipped(content))}) {
      const std::string message = refusal(path);
      EXPECT_TRUE(contains(message, why)) << message;
    }
  };
  NiftiFields fields;
  fields.dim = {3, 32767, 32767, 32767, 1, 1, 1, 1};
  refused(fields, "70362301923326 bytes of samples from byte 352 on, found a file of 412");
  fields.version = 2;
  fields.dim = {3, 1 << 30, 1 << 30, 1 << 30, 1, 1, 1, 1};
  refused(fields, "2^63");
  fields.dim = {4, 3, 2, 5, std::int64_t{1} << 62, 1, 1, 1};
  fields.dim[5] = 16;
  fields.dim[0] = 5;
  refused(fields, "2^63");
  fields.dim = {7, 3, 2, 5, 1, std::int64_t{1} << 32, std::int64_t{1} << 32, 1};
  refused(fields, "2^63 volumes");
  for (const std::int64_t side : {0, -1, -32768}) {
    fields = {};
    fields.dim[2] = side;
    refused(fields, "at least 1");
  }
  for (const std::int64_t rank : {0, 8, -1}) {
    fields = {};
    fields.dim[0] = rank;
    refused(fields, "1 to 7 dimensions");
  }
}

TEST(Nifti, FindsACorruptedSumAtTheEnd) {
  const TempFolder folder;
  std::string content = gzipped(nifti_file({}));
  content[content.size() - 6] = static_cast<char>(content[content.size() - 6] ^ 1);
  EXPECT_TRUE(contains(refusal(folder.put("a.nii.gz", content)), "corrupt"));
}

// The sum lies in the reader's second buffer of 64 KiB, which no sample needs.
TEST(Nifti, FindsACorruptedSumBehindTheLastBuffer) {
  const TempFolder folder;
  std::mt19937 random(3);
  std::string noise(66000, '\0');
  for (char& byte : noise) byte = static_cast<char>(random() & 0xff);
  const auto packed = [&](std::size_t samples) {
    NiftiFields fields;
    fields.version = 2;
    fields.type = 2;
    fields.dim = {3, static_cast<std::int64_t>(samples), 1, 1, 1, 1, 1, 1};
    return gzipped(nifti_header(fields) + noise.substr(0, samples));
  };
  constexpr std::size_t kWanted = 65536 + 8;
  std::size_t samples = 65000;
  for (int round = 0; round < 10 && packed(samples).size() != kWanted; ++round) {
    samples = samples + kWanted - packed(samples).size();
  }
  std::string content = packed(samples);
  ASSERT_EQ(content.size(), kWanted);
  EXPECT_EQ(read_file<std::uint8_t>(folder.put("a.nii.gz", content)).size(), samples);
  content[kWanted - 6] = static_cast<char>(content[kWanted - 6] ^ 1);
  EXPECT_TRUE(contains(refusal(folder.put("a.nii.gz", content)), "corrupt"));
}

TEST(Nifti, SurvivesEveryTruncation) {
  const TempFolder folder;
  NiftiFields second;
  second.version = 2;
  expect_prefixes_are_safe(folder, "a.nii", nifti_file({}));
  expect_prefixes_are_safe(folder, "b.nii", nifti_file(second));
  expect_prefixes_are_safe(folder, "c.nii.gz", gzipped(nifti_file({})));
}

TEST(Nifti, SurvivesRandomChanges) {
  const TempFolder folder;
  NiftiFields second;
  second.version = 2;
  second.sform = 1;
  expect_flips_are_safe(folder, "a.nii", nifti_file({}), 348);
  expect_flips_are_safe(folder, "b.nii", nifti_file(second), 540);
  expect_flips_are_safe(folder, "c.nii.gz", gzipped(nifti_file({})), 100);
}

// Found by fuzzing: a vector shorter than the smallest normal number has no direction of unit length.
TEST(Nifti, RefusesSpacingThatCannotBeComputedWith) {
  const TempFolder folder;
  NiftiFields fields;
  fields.version = 2;
  for (const double step : {1e-310, 1e-31, 1e31}) {
    fields.pixdim[2] = step;
    const std::string path = folder.put("a.nii", nifti_header(fields) + stored(ramp<std::int16_t>(30)));
    EXPECT_TRUE(contains(refusal(path), "a sample spacing from 1e-30 to 1e30 on axis 1")) << refusal(path);
    OpenOptions options;
    options.spacing = {1, step, 1};
    EXPECT_THROW(open_volume(path, options), BadInput);
  }
}

}  // namespace
}  // namespace isoweave::testing::volume_nifti_test
