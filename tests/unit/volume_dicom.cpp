#include <cmath>

#include "dicom_helpers.hpp"

namespace isoweave::testing::volume_dicom_test {
namespace {

using namespace dicom_files;

std::vector<std::uint16_t> in_order(const std::vector<std::size_t>& slices) {
  std::vector<std::uint16_t> samples;
  for (const std::size_t n : slices) {
    const auto first = kSamples.begin() + static_cast<std::ptrdiff_t>(n * kSlice);
    samples.insert(samples.end(), first, first + kSlice);
  }
  return samples;
}

TEST(Dicom, OrdersSlicesByPosition) {
  const TempFolder folder;
  put_series(folder);
  const auto source = open_volume(folder / "");
  const VolumeInfo& info = source->info();
  EXPECT_EQ(info.format, "dicom");
  EXPECT_EQ(info.dims, (std::array<std::int64_t, 3>{kColumns, kRows, 5}));
  EXPECT_EQ(info.type, SampleType::kUint16);
  EXPECT_EQ(info.geometry.space, Space::kLps);
  EXPECT_EQ(info.geometry.unit, "mm");
  EXPECT_EQ(info.geometry.spacing, (std::array<double, 3>{0.25, 0.5, 2.5}));
  EXPECT_EQ(info.geometry.origin, (std::array<double, 3>{10, 20, 30}));
  EXPECT_EQ(info.geometry.direction, (std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
  EXPECT_TRUE(info.notes.empty());
  EXPECT_EQ(samples_of<std::uint16_t>(*source), kSamples);
}

TEST(Dicom, ReadsASeriesByAFolderAPatternOrOneFile) {
  const TempFolder folder;
  put_series(folder);
  DicomFields other;
  other.series = "1.2.4";
  folder.put("other", dicom(other, slice(0)));
  folder.put("readme.txt", "hello");
  folder.put("empty", "");
  EXPECT_EQ(read_file<std::uint16_t>(folder / "s*"), kSamples);
  const auto source = open_volume(folder / "s7");
  EXPECT_EQ(samples_of<std::uint16_t>(*source), kSamples);
  EXPECT_EQ(source->info().remarks.at(0), "the series of this file: 5 files of its folder");
  EXPECT_EQ(open_volume(folder / "other")->info().dims[2], 1);
}

TEST(Dicom, ReadsAHiddenFileThatIsNamed) {
  const TempFolder folder;
  put_series(folder);
  folder.put(".a", dicom({}, slice(0)));
  std::filesystem::remove(folder / "s9");
  EXPECT_EQ(open_volume(folder / ".a")->info().dims[2], 5);
  EXPECT_EQ(open_volume(folder / "s8")->info().dims[2], 4);
}

TEST(Dicom, ListsSeveralSeriesAndReadsTheChosenOne) {
  const TempFolder folder;
  put_series(folder);
  DicomFields other;
  other.series = "1.2.4";
  other.description = "scout";
  folder.put("other", dicom(other, slice(3)));
  const std::string message = refusal(folder / "");
  EXPECT_TRUE(contains(message, "expected one series, or --series UID for one of them")) << message;
  EXPECT_TRUE(contains(message, "found 2 series: 1.2.3 ('thin', 5 slices); 1.2.4 ('scout', 1 slice)")) << message;
  OpenOptions options;
  options.series = "1.2.3";
  EXPECT_EQ(read_file<std::uint16_t>(folder / "", options), kSamples);
  options.series = "1.2.4";
  EXPECT_EQ(read_file<std::uint16_t>(folder / "", options), in_order({3}));
  EXPECT_TRUE(contains(refusal(folder / "s7", options), "expected the series '1.2.4', found '1.2.3'"));
  options.series = "1.2.5";
  EXPECT_TRUE(contains(refusal(folder / "", options), "expected the series '1.2.5', found 2 series"));
  EXPECT_TRUE(contains(refusal(folder.put("a_1x1x1_uint8.raw", "x"), options), "found no DICOM"));
}

TEST(Dicom, TakesObliqueAndShearedAxes) {
  const TempFolder folder;
  // Rows along y, columns along a slanting -z: the normal is (-0.8, 0, -0.6), and x falls from slice to slice.
  DicomFields fields;
  fields.orientation = "0\\1\\0\\0.6\\0\\-0.8";
  for (std::size_t n = 0; n < 3; ++n) {
    const std::string x = std::to_string(5 - 2 * static_cast<int>(n));
    fields.position = x + "\\0\\0";
    folder.put("s" + std::to_string(n), dicom(fields, slice(n)));
  }
  const auto source = open_volume(folder / "");
  const Geometry& geometry = source->info().geometry;
  EXPECT_EQ(samples_of<std::uint16_t>(*source), in_order({0, 1, 2}));
  EXPECT_EQ(geometry.origin, (std::array<double, 3>{5, 0, 0}));
  EXPECT_EQ(geometry.spacing, (std::array<double, 3>{0.25, 0.5, 2}));
  const std::array<double, 9> expected{0, 0.6, -1, 1, 0, 0, 0, -0.8, 0};
  for (std::size_t n = 0; n < 9; ++n) EXPECT_NEAR(geometry.direction[n], expected[n], 1e-12) << n;
}

TEST(Dicom, RefusesSlicesInOnePlace) {
  const TempFolder folder;
  put_series(folder);
  DicomFields fields;
  fields.position = at(32.5);
  folder.put("t", dicom(fields, slice(3)));
  const std::string message = refusal(folder / "");
  EXPECT_TRUE(contains(message, "expected a position of its own for every slice, found that of '")) << message;
}

TEST(Dicom, LeavesCopiesOut) {
  const TempFolder folder;
  put_series(folder);
  for (const char* name : {"s7 (copy)", "s8 (copy)", "s8 (another copy)"}) {
    folder.put(name, get(folder / std::string(name).substr(0, 2)));
  }
  const auto source = open_volume(folder / "");
  EXPECT_EQ(samples_of<std::uint16_t>(*source), kSamples);
  EXPECT_TRUE(contains(source->info().notes.at(0), "3 images are copies of others and are left out, as '"));
  // The same image by its UID, and other samples.
  DicomFields fields;
  fields.position = at(35);
  folder.put("s7 (copy)", dicom(fields, slice(0)));
  EXPECT_TRUE(contains(refusal(folder / ""), "expected a position of its own for every slice"));
}

TEST(Dicom, ReadsSignedSamplesScalingAndBothPhotometricInterpretations) {
  const TempFolder folder;
  DicomFields fields;
  fields.is_signed = 1;
  fields.slope = "0.5";
  fields.intercept = "-1024";
  fields.photometric = "MONOCHROME1";
  fields.thickness = "3";
  const auto samples = ramp<std::int16_t>(kSlice);
  const auto source = open_volume(folder.put("a", dicom(fields, stored(samples))));
  EXPECT_EQ(source->info().type, SampleType::kInt16);
  EXPECT_EQ(source->info().slope, 0.5);
  EXPECT_EQ(source->info().intercept, -1024);
  EXPECT_EQ(source->info().geometry.spacing[2], 3);
  EXPECT_TRUE(contains(source->info().notes.at(0), "shown bright"));
  EXPECT_EQ(samples_of<std::int16_t>(*source), samples);
  DicomFields bytes;
  bytes.bits = 8;
  const auto eight = ramp<std::uint8_t>(kSlice);
  EXPECT_EQ(read_file<std::uint8_t>(folder.put("a", dicom(bytes, stored(eight)))), eight);
}

TEST(Dicom, ReadsEveryTransferSyntax) {
  // GDCM cannot write smaller JPEG 2000 images.
  DicomFields fields;
  fields.columns = 64;
  fields.rows = 48;
  const auto signed_samples = ramp<std::int16_t>(64 * 48);
  for (const auto syntax : {gdcm::TransferSyntax::ImplicitVRLittleEndian, gdcm::TransferSyntax::ExplicitVRBigEndian,
                            gdcm::TransferSyntax::JPEGLosslessProcess14, gdcm::TransferSyntax::JPEGLosslessProcess14_1,
                            gdcm::TransferSyntax::JPEGLSLossless, gdcm::TransferSyntax::JPEG2000Lossless,
                            gdcm::TransferSyntax::RLELossless}) {
    SCOPED_TRACE(gdcm::TransferSyntax::GetTSString(syntax));
    for (const int is_signed : {0, 1}) {
      const TempFolder folder;
      fields.is_signed = is_signed;
      folder.put("a", dicom(fields, stored(signed_samples)));
      ASSERT_TRUE(transcode(folder / "a", folder / "b", syntax));
      std::filesystem::remove(folder / "a");
      EXPECT_EQ(read_file<std::int16_t>(folder / "b"), signed_samples) << is_signed;
    }
  }
}

TEST(Dicom, SurvivesDamagedRunLengths) {
  const TempFolder folder;
  folder.put("w", dicom({}, slice(0)));
  ASSERT_TRUE(transcode(folder / "w", folder / "a", gdcm::TransferSyntax::RLELossless));
  std::filesystem::remove(folder / "w");
  const std::string content = get(folder / "a");
  expect_prefixes_are_safe(folder, "a", content);
  expect_flips_are_safe(folder, "a", content, content.size());
}

TEST(Dicom, RefusesPackedFramesOfAnotherSize) {
  DicomFields fields;
  fields.columns = 64;
  fields.rows = 48;
  for (const auto syntax : {gdcm::TransferSyntax::JPEGLosslessProcess14_1, gdcm::TransferSyntax::JPEGLSLossless,
                            gdcm::TransferSyntax::JPEG2000Lossless}) {
    const TempFolder folder;
    folder.put("w", dicom(fields, stored(ramp<std::uint16_t>(64 * 48))));
    ASSERT_TRUE(transcode(folder / "w", folder / "a", syntax));
    std::filesystem::remove(folder / "w");
    std::string content = get(folder / "a");
    const std::size_t columns = content.find(us(0x11, 64));
    ASSERT_NE(columns, std::string::npos);
    content.replace(columns, us(0x11, 32).size(), us(0x11, 32));
    const std::string message = refusal(folder.put("a", content));
    EXPECT_TRUE(contains(message, "expected a packed frame of 32 x 48 samples of 16 bits, found 64 x 48")) << message;
  }
}

// Found by fuzzing: GDCM's decoders kept memory for good when a stream was damaged.
TEST(Dicom, RefusesDamagedJpegLs) {
  const TempFolder folder;
  folder.put("w", dicom({}, slice(0)));
  ASSERT_TRUE(transcode(folder / "w", folder / "a", gdcm::TransferSyntax::JPEGLSLossless));
  std::filesystem::remove(folder / "w");
  std::string content = get(folder / "a");
  // The scan's header: another number of components.
  content[content.find("\xff\xda") + 4] = 9;
  const std::string message = refusal(folder.put("a", content));
  EXPECT_TRUE(contains(message, "expected decodable JPEG-LS samples, found damaged data")) << message;
}

TEST(Dicom, RefusesJpegThatEndsInTheMiddle) {
  const TempFolder folder;
  DicomFields fields;
  fields.columns = 64;
  fields.rows = 48;
  folder.put("w", dicom(fields, stored(ramp<std::uint16_t>(64 * 48))));
  ASSERT_TRUE(transcode(folder / "w", folder / "a", gdcm::TransferSyntax::JPEGLosslessProcess14_1));
  std::filesystem::remove(folder / "w");
  std::string content = get(folder / "a");
  const std::size_t end = content.rfind("\xff\xd9");
  ASSERT_NE(end, std::string::npos);
  content.replace(end - 20, 2, "\xff\xd9");
  const std::string message = refusal(folder.put("a", content));
  EXPECT_TRUE(contains(message, "expected decodable JPEG samples, found damaged data")) << message;
}

TEST(Dicom, RefusesDamagedJpeg2000) {
  const TempFolder folder;
  DicomFields fields;
  fields.columns = 64;
  fields.rows = 48;
  folder.put("w", dicom(fields, stored(ramp<std::uint16_t>(64 * 48))));
  ASSERT_TRUE(transcode(folder / "w", folder / "a", gdcm::TransferSyntax::JPEG2000Lossless));
  std::filesystem::remove(folder / "w");
  std::string content = get(folder / "a");
  const std::size_t samples = content.find("\xff\x93") + 2;
  content.replace(samples, 60, 60, '\xfe');
  ::testing::internal::CaptureStderr();
  const std::string message = refusal(folder.put("a", content));
  EXPECT_TRUE(contains(message, "expected decodable JPEG 2000 samples, found damaged data")) << message;
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Dicom, RefusesSlicesThatDiffer) {
  const TempFolder folder;
  const auto with = [&](const DicomFields& fields) {
    put_series(folder);
    folder.put("s7", dicom(fields, slice(2)));
    return refusal(folder / "");
  };
  DicomFields fields;
  fields.is_signed = 1;
  const std::string message = with(fields);
  EXPECT_TRUE(contains(message, "s7: expected 7 x 5 uint16 MONOCHROME2 as in '")) << message;
  EXPECT_TRUE(contains(message, "found 7 x 5 int16 MONOCHROME2")) << message;
  fields = {};
  fields.photometric = "MONOCHROME1";
  EXPECT_TRUE(contains(with(fields), "found 7 x 5 uint16 MONOCHROME1"));
}

TEST(Dicom, RefusesWhatIsNoGreySliceInAPlace) {
  const TempFolder folder;
  const auto with = [&](const DicomFields& fields) { return refusal(folder.put("a", dicom(fields, slice(0)))); };
  DicomFields fields;
  fields.frames = "5";
  EXPECT_TRUE(contains(with(fields), "expected 350 bytes of samples, found 70"));
  fields.frames = "99999999";
  EXPECT_TRUE(contains(with(fields), "expected no more than 131072 frames, found 99999999"));
  fields.frames = "many";
  EXPECT_TRUE(contains(with(fields), "expected a number of frames, found 'many'"));
  fields = {};
  fields.photometric = "RGB";
  fields.samples = 3;
  EXPECT_TRUE(contains(with(fields), "found 'RGB' of 3 samples"));
  fields.photometric = "PALETTE COLOR";
  fields.samples = 1;
  EXPECT_TRUE(contains(with(fields), "expected grey samples (MONOCHROME1 or 2), found 'PALETTE COLOR' of 1 samples"));
  fields = {};
  fields.bits = 12;
  EXPECT_TRUE(contains(with(fields), "1, 8, 16 or 32 bits allocated, found 12"));
  fields = {};
  fields.position.clear();
  EXPECT_TRUE(contains(with(fields), "expected 3 numbers as Image Position (Patient), found none"));
  fields = {};
  fields.orientation = "1\\0\\0\\1\\0\\0";
  EXPECT_TRUE(contains(with(fields), "orthogonal unit vectors"));
  fields = {};
  fields.pixel_spacing = "0.5";
  EXPECT_TRUE(contains(with(fields), "expected 2 numbers as Pixel Spacing, found '0.5'"));
  fields.pixel_spacing = "0.5\\0";
  EXPECT_TRUE(contains(with(fields), "positive, finite sample spacing"));
  fields = {};
  fields.slope = "0";
  EXPECT_TRUE(contains(with(fields), "a Rescale Slope other than 0"));
  fields = {};
  fields.rows = 0;
  EXPECT_TRUE(contains(with(fields), "a DICOM file without one"));
  EXPECT_TRUE(contains(refusal(folder / ""), "expected DICOM images, found 1 file without one"));
  std::string deflated = dicom({}, slice(0));
  deflated.replace(deflated.find("1.2.840.10008.1.2.1") + 16, 3, "9.9");
  EXPECT_TRUE(contains(refusal(folder.put("a", deflated)), "expected a transfer syntax of plain, deflated, JPEG"));
  EXPECT_TRUE(contains(refusal(folder.put("a.dcm", "hello")), "DICM behind a preamble"));
}

TEST(Dicom, TakesTheBitsThatAreUsed) {
  const TempFolder folder;
  DicomFields fields;
  fields.is_signed = 1;
  // 12 bits from bit 11 down; the four above hold an overlay.
  fields.more = us(0x101, 12) + us(0x102, 11);
  const std::vector<std::uint16_t> kept{0xf001, 0x0fff, 0x7800};
  std::string samples = stored(kept);
  samples.resize(2 * kSlice);
  const auto read = read_file<std::int16_t>(folder.put("a", dicom(fields, samples)));
  EXPECT_EQ(read[0], 1);
  EXPECT_EQ(read[1], -1);
  EXPECT_EQ(read[2], -2048);
  fields.is_signed = 0;
  fields.more = us(0x101, 12) + us(0x102, 15);
  EXPECT_EQ(read_file<std::uint16_t>(folder.put("a", dicom(fields, samples)))[1], 0x0ff);
  fields.more = us(0x101, 17);
  EXPECT_TRUE(contains(refusal(folder.put("a", dicom(fields, samples))), "bits stored within those allocated"));
}

TEST(Dicom, ReadsDeflatedFiles) {
  const TempFolder folder;
  put_series(folder);
  for (const char* name : {"s5", "s6", "s7", "s8", "s9"}) folder.put(name, deflated_file(get(folder / name)));
  EXPECT_EQ(read_file<std::uint16_t>(folder / ""), kSamples);
  const TempFolder one;
  const std::string content = deflated_file(dicom({}, slice(0)));
  expect_prefixes_are_safe(one, "a", content);
  expect_flips_are_safe(one, "a", content, content.size(), 1000);
}

TEST(Dicom, ReadsDeflatedSlicesLargerThanWhatIsHeld) {
  const TempFolder folder;
  DicomFields fields;
  fields.columns = fields.rows = 400;
  const auto samples = ramp<std::uint16_t>(400 * 400);
  const std::string content = deflated_file(dicom(fields, stored(samples)));
  EXPECT_EQ(read_file<std::uint16_t>(folder.put("a", content)), samples);
}

TEST(Dicom, ReadsTheFramesOfEnhancedImages) {
  const TempFolder folder;
  // The frames lie in another order than they are stored in.
  const std::string samples = slice(2) + slice(0) + slice(1);
  const std::string content = enhanced({frame_at(35), frame_at(30), frame_at(32.5)}, samples);
  for (const std::string& form : {content, deflated_file(content)}) {
    const auto source = open_volume(folder.put("a", form));
    EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{kColumns, kRows, 3}));
    EXPECT_EQ(source->info().geometry.spacing, (std::array<double, 3>{0.25, 0.5, 2.5}));
    EXPECT_EQ(source->info().geometry.origin, (std::array<double, 3>{10, 20, 30}));
    EXPECT_EQ(source->info().slope, 2);
    EXPECT_EQ(source->info().intercept, -7);
    EXPECT_TRUE(source->info().notes.empty());
    EXPECT_EQ(samples_of<std::uint16_t>(*source), in_order({0, 1, 2}));
  }
  expect_flips_are_safe(folder, "a", content, content.size(), 1000);
  // What a frame says comes before what all share.
  const std::string own = group(0x28, 0x9110, element(0x28, 0x30, "DS", "3\\4"));
  const auto source =
      open_volume(folder.put("a", enhanced({frame_at(1) + own, own + frame_at(2)}, slice(0) + slice(1))));
  EXPECT_EQ(source->info().geometry.spacing, (std::array<double, 3>{4, 3, 1}));
}

TEST(Dicom, RefusesFramesThatAreNotOneVolume) {
  const TempFolder folder;
  const auto refused = [&](const std::vector<std::string>& frames, const std::string& samples,
                           const DicomFields& fields = {}) {
    return refusal(folder.put("a", enhanced(frames, samples, fields)));
  };
  const std::string two = slice(0) + slice(1);
  EXPECT_TRUE(contains(refused({frame_at(1), frame_at(1)}, two), "a (frame 2): expected a position of its own"));
  EXPECT_TRUE(contains(refused({frame_at(1), ""}, two), "a (frame 2): expected 3 numbers as Image Position"));
  EXPECT_TRUE(contains(refused({frame_at(1), frame_at(2)}, slice(0)), "expected 140 bytes of samples, found 70"));
  DicomFields fields;
  fields.frames = "3";
  EXPECT_TRUE(contains(refused({frame_at(1), frame_at(2)}, two, fields), "groups for each of 3 frames, found 2"));
}

TEST(Dicom, ReadsPackedFramesByTheirNumberOrTheirOffsets) {
  const TempFolder folder;
  const std::vector<std::string> frames{frame_at(1), frame_at(2)};
  const std::string a = run_lengths(slice(0));
  const std::string b = run_lengths(slice(1));
  EXPECT_EQ(read_file<std::uint16_t>(folder.put("a", packed_frames(frames, item("") + item(a) + item(b)))),
            in_order({0, 1}));
  // The first frame in two fragments.
  const std::string halves = item(a.substr(0, 100)) + item(a.substr(100)) + item(b);
  const std::string table = item(bytes_of(0U) + bytes_of(static_cast<std::uint32_t>(a.size() + 16)));
  EXPECT_EQ(read_file<std::uint16_t>(folder.put("a", packed_frames(frames, table + halves))), in_order({0, 1}));
  EXPECT_TRUE(contains(refusal(folder.put("a", packed_frames(frames, item("") + halves))), "found 3 fragments"));
  const std::string wrong = item(bytes_of(0U) + bytes_of(5000U));
  EXPECT_TRUE(contains(refusal(folder.put("a", packed_frames(frames, wrong + halves))), "for frame 2, found none"));
}

TEST(Dicom, PassesOverSequencesWithImagesOfTheirOwn) {
  const TempFolder folder;
  const std::string item("\xfe\xff\x00\xe0", 4);
  const std::string end("\xfe\xff\xdd\xe0\0\0\0\0", 8);
  const std::string open = bytes_of(std::uint32_t{0xffffffff});
  const std::string inside = us(0x10, 99) + element(0x7fe0, 0x10, "OW", "icon");
  const std::string packed = us(0x10, 99) + bytes_of(std::uint16_t{0x7fe0}) + bytes_of(std::uint16_t{0x10}) +
                             std::string("OB\0\0", 4) + open + item + bytes_of(std::uint32_t{0}) + item +
                             bytes_of(std::uint32_t{4}) + "\xff\xff\xff\xff" + end;
  const std::string closed = item + bytes_of(static_cast<std::uint32_t>(inside.size())) + inside;
  const std::string unknown = bytes_of(std::uint16_t{0x88}) + bytes_of(std::uint16_t{0x200}) + std::string("SQ\0\0", 4);
  const std::string item_end("\xfe\xff\x0d\xe0\0\0\0\0", 8);
  for (const std::string& sequence : {element(0x88, 0x200, "SQ", closed), unknown + open + closed + end,
                                      unknown + open + item + open + inside + item_end + end,
                                      unknown + open + item + open + packed + item_end + end}) {
    DicomFields fields;
    fields.more = sequence;
    const std::string content = dicom(fields, slice(0));
    EXPECT_EQ(read_file<std::uint16_t>(folder.put("a", content)), in_order({0}));
    expect_flips_are_safe(folder, "a", content, content.size(), 300);
  }
}

TEST(Dicom, ReadsASeriesWithoutUid) {
  const TempFolder folder;
  DicomFields fields;
  fields.series.clear();
  put_series(folder, fields);
  EXPECT_EQ(read_file<std::uint16_t>(folder / ""), kSamples);
}

TEST(Dicom, LeavesFilesWithoutImagesOut) {
  const TempFolder folder;
  put_series(folder);
  DicomFields fields;
  fields.rows = 0;
  folder.put("report", dicom(fields, ""));
  const auto source = open_volume(folder / "");
  EXPECT_EQ(source->info().remarks.at(0), "1 DICOM file holds no image and is left out");
  EXPECT_EQ(samples_of<std::uint16_t>(*source), kSamples);
}

TEST(Dicom, RefusesSizesThatLie) {
  const TempFolder folder;
  DicomFields fields;
  fields.rows = 50000;
  EXPECT_TRUE(contains(refusal(folder.put("a", dicom(fields, slice(0)))), "expected 700000 bytes"));
  fields = {};
  EXPECT_TRUE(contains(refusal(folder.put("a", dicom(fields, slice(0).substr(0, 60)))), "expected 70 bytes"));
  std::string content = dicom(fields, slice(0));
  content.replace(content.size() - 74, 4, bytes_of(std::uint32_t{0xfffffff0}));
  EXPECT_TRUE(contains(refusal(folder.put("a", content)), "4294967280 bytes of a DICOM element"));
}

TEST(Dicom, SurvivesCutsAndFlips) {
  const TempFolder folder;
  DicomFields fields;
  fields.thickness = "3";
  const std::string content = dicom(fields, slice(0));
  expect_prefixes_are_safe(folder, "a", content);
  expect_flips_are_safe(folder, "a", content, content.size(), 2000);
}

}  // namespace
}  // namespace isoweave::testing::volume_dicom_test
