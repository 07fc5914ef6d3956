// Raw files, and what all formats share: ranges, byte order, errors about the file itself.
#include <sys/stat.h>

#include <stdexcept>

#include "volume_helpers.hpp"

namespace isoweave::testing::volume_raw_test {
namespace {

TEST(SampleTypes, NamesAndSizesBelongTogether) {
  const std::vector<std::pair<std::string, std::size_t>> expected{
      {"uint8", 1}, {"int8", 1},   {"uint16", 2}, {"int16", 2},   {"uint32", 4},
      {"int32", 4}, {"uint64", 8}, {"int64", 8},  {"float32", 4}, {"float64", 8}};
  for (const auto& [name, bytes] : expected) {
    const auto type = parse_sample_type(name);
    ASSERT_TRUE(type) << name;
    EXPECT_EQ(sample_type_name(*type), name);
    EXPECT_EQ(sample_bytes(*type), bytes) << name;
  }
  EXPECT_FALSE(parse_sample_type("int128"));
}

TEST(RawLayout, ParsesEveryPart) {
  const RawLayout layout = parse_raw_layout("512x256x300:int16:big:skip=1024");
  EXPECT_EQ(layout.dims, (std::array<std::int64_t, 3>{512, 256, 300}));
  EXPECT_EQ(layout.type, SampleType::kInt16);
  EXPECT_TRUE(layout.big_endian);
  EXPECT_EQ(layout.skip_bytes, 1024);
  EXPECT_FALSE(parse_raw_layout("1x2x3:uint8").big_endian);
}

TEST(RawLayout, NamesThePartThatIsWrong) {
  const std::vector<std::pair<std::string, std::string>> wrong{{"512x256:uint8", "'512x256'"},
                                                               {"0x2x3:uint8", "'0x2x3'"},
                                                               {"1x-2x3:uint8", "'1x-2x3'"},
                                                               {"1x2x3:int128", "'int128'"},
                                                               {"1x2x3:uint8:huge", "'huge'"},
                                                               {"1x2x3:uint8:skip=-1", "'skip=-1'"},
                                                               {"1x2x3", "'1x2x3'"},
                                                               {"", "''"},
                                                               {"1x2x99999999999999999999:uint8", "9999'"},
                                                               {"1x2x3:uint8:skip=", "'skip='"},
                                                               {"1x2x3x4:uint8", "'1x2x3x4'"}};
  for (const auto& [text, part] : wrong) {
    try {
      parse_raw_layout(text);
      ADD_FAILURE() << text;
    } catch (const std::invalid_argument& error) {
      EXPECT_TRUE(contains(error.what(), part)) << error.what();
    }
  }
}

TEST(RawLayout, IsReadFromNames) {
  const auto layout = raw_layout_from_name("/data/dir_1x1x1_int8.raw/foot_new_256x128x64_uint16.raw");
  ASSERT_TRUE(layout);
  EXPECT_EQ(layout->dims, (std::array<std::int64_t, 3>{256, 128, 64}));
  EXPECT_EQ(layout->type, SampleType::kUint16);
  EXPECT_FALSE(layout->big_endian);
  for (const char* name : {"foot.raw", "foot_256x128x64.raw", "foot_256x128_uint8.raw", "foot_256x128x64_uint8.bin",
                           "foot_256x128x0_uint8.raw", "foot_256x128x64_uint128.raw", ""}) {
    EXPECT_FALSE(raw_layout_from_name(name)) << name;
  }
}

template <class Sample>
class RawTypes : public ::testing::Test {};

using AllSamples = ::testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t, std::int32_t,
                                    float, double>;
TYPED_TEST_SUITE(RawTypes, AllSamples);

template <class Sample>
std::string name_of_type() {
  const std::string kind = std::is_floating_point_v<Sample> ? "float" : std::is_signed_v<Sample> ? "int" : "uint";
  return kind + std::to_string(8 * sizeof(Sample));
}

TYPED_TEST(RawTypes, AreReadInBothByteOrdersBehindASkip) {
  const TempFolder folder;
  const auto samples = ramp<TypeParam>(3 * 4 * 7);
  for (const bool big : {false, true}) {
    OpenOptions options;
    options.raw = parse_raw_layout("3x4x7:" + name_of_type<TypeParam>() + (big ? ":big" : "") + ":skip=5");
    const std::string path = folder.put("any.bin", "HEAD!" + stored(samples, big));
    EXPECT_EQ(read_file<TypeParam>(path, options), samples);
  }
}

TEST(RawFiles, AreOpenedByName) {
  const TempFolder folder;
  const auto samples = ramp<std::uint8_t>(24);
  const auto source = open_volume(folder.put("a_4x3x2_uint8.raw", stored(samples)));
  EXPECT_EQ(source->info().format, "raw");
  EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{4, 3, 2}));
  EXPECT_EQ(samples_of<std::uint8_t>(*source), samples);
}

TEST(RawFiles, MustHaveExactlyTheDeclaredSize) {
  const TempFolder folder;
  for (const std::size_t size : {23u, 25u}) {
    const std::string message = refusal(folder.put("a_4x3x2_uint8.raw", std::string(size, 'x')));
    EXPECT_TRUE(contains(message, "expected 24 bytes")) << message;
    EXPECT_TRUE(contains(message, "found " + std::to_string(size))) << message;
    EXPECT_TRUE(contains(message, "a_4x3x2_uint8.raw")) << message;
  }
}

TEST(RawFiles, ProposeTheLayoutThatWouldFit) {
  const TempFolder folder;
  const auto found = [&](const char* layout, std::size_t bytes) {
    OpenOptions options;
    options.raw = parse_raw_layout(layout);
    const std::string message = refusal(folder.put("a", std::string(bytes, 'x')), options);
    return message.substr(message.find("found ") + 6);
  };
  EXPECT_EQ(found("10x10x10:uint8", 2000), "2000: perhaps uint16 or int16?");
  EXPECT_EQ(found("10x10x10:uint16", 1000), "1000: perhaps uint8 or int8?");
  EXPECT_EQ(found("10x10x10:int16", 4000), "4000: perhaps float32 or int32?");
  EXPECT_EQ(found("10x10x10:float32", 8000), "8000: perhaps float64 or int64?");
  EXPECT_EQ(found("10x10x10:uint8:skip=352", 2352), "2352: perhaps uint16 or int16?");
  EXPECT_EQ(found("10x10x10:int16", 2352), "2352: perhaps skip=352?");
  EXPECT_EQ(found("10x10x10:int16:skip=352", 2000), "2000");
  EXPECT_EQ(found("10x10x10:uint8", 999), "999");
  EXPECT_EQ(found("10x10x10:uint8:skip=5000", 1000), "1000");
}

TEST(RawFiles, NameTheHeaderBesideThem) {
  const TempFolder folder;
  const std::string samples = folder.put("a.raw", "xx");
  EXPECT_FALSE(contains(refusal(samples), "header"));
  folder.put("a.mhd", "x");
  EXPECT_TRUE(contains(refusal(samples), "; open its header instead, " + folder / "a.mhd"));
}

TEST(RawFiles, RefuseSizesBeyond63Bits) {
  const TempFolder folder;
  OpenOptions options;
  options.raw = RawLayout{{4294967296, 4294967296, 4}, SampleType::kUint8, false, 0};
  EXPECT_TRUE(contains(refusal(folder.put("a", "x"), options), "2^63"));
  options.raw = RawLayout{{2147483648, 2147483648, 2}, SampleType::kUint8, false, 0};
  EXPECT_TRUE(contains(refusal(folder.put("a", "x"), options), "2^63"));
  options.raw = RawLayout{{2147483648, 2147483647, 2}, SampleType::kUint8, false, 9223372036854775807};
  EXPECT_TRUE(contains(refusal(folder.put("a", "x"), options), "found 1"));
}

TEST(Slices, AreReadForwardWithGaps) {
  const TempFolder folder;
  const auto samples = ramp<std::int16_t>(2 * 3 * 11);
  const auto source = open_volume(folder.put("a_2x3x11_int16.raw", stored(samples)));
  std::vector<std::int16_t> out(18);
  source->read(1, 3, std::as_writable_bytes(std::span(out)));
  EXPECT_TRUE(std::equal(out.begin(), out.end(), samples.begin() + 6));
  source->read(4, 0, {});
  source->read(10, 1, std::as_writable_bytes(std::span(out)));
  EXPECT_TRUE(std::equal(out.begin(), out.begin() + 6, samples.begin() + 60));
}

TEST(Slices, OutsideTheVolumeOrBehindAreInvalidArguments) {
  const TempFolder folder;
  const auto source = open_volume(folder.put("a_2x3x4_uint8.raw", std::string(24, 'x')));
  std::vector<std::byte> out(24);
  EXPECT_THROW(source->read(-1, 1, out), std::invalid_argument);
  EXPECT_THROW(source->read(4, 1, out), std::invalid_argument);
  EXPECT_THROW(source->read(3, 2, out), std::invalid_argument);
  EXPECT_THROW(source->read(0, -1, out), std::invalid_argument);
  EXPECT_THROW(source->read(0, 4, std::span(out).first(23)), std::invalid_argument);
  source->read(1, 2, out);
  EXPECT_THROW(source->read(2, 1, out), std::invalid_argument);
  EXPECT_NO_THROW(source->read(3, 1, out));
}

TEST(Slices, ReportAFileThatShrank) {
  const TempFolder folder;
  const std::string path = folder.put("a_2x3x4_uint8.raw", std::string(24, 'x'));
  const auto source = open_volume(path);
  std::filesystem::resize_file(path, 15);
  std::vector<std::byte> out(24);
  try {
    source->read(1, 3, out);
    FAIL();
  } catch (const BadInput& error) {
    EXPECT_TRUE(contains(error.what(), "expected 24 bytes of samples, found 15")) << error.what();
  }
}

// Offsets beyond 32 bits, in a file that takes no room on the disk.
TEST(Slices, LieBeyondFourGigabytes) {
  const TempFolder folder;
  const std::string path = folder.put("a_65536x32768x3_uint8.raw", "x");
  std::filesystem::resize_file(path, (std::uint64_t{3} << 31) - 1);
  std::ofstream(path, std::ios::binary | std::ios::app) << "y";
  OpenOptions options;
  options.raw = parse_raw_layout("65536x1x98304:uint8");
  const auto source = open_volume(path, options);
  std::vector<std::byte> row(65536);
  source->read(98303, 1, row);
  EXPECT_EQ(row.front(), std::byte{0});
  EXPECT_EQ(row.back(), std::byte{'y'});
  EXPECT_EQ(open_volume(path)->info().slice_samples(), std::int64_t{1} << 31);
}

TEST(OpenVolume, RefusesWhatIsNoReadableFile) {
  const TempFolder folder;
  EXPECT_TRUE(contains(refusal(folder / "missing.nrrd"), "No such file"));
  EXPECT_TRUE(contains(refusal(folder / ""), "a directory"));
  EXPECT_TRUE(contains(refusal(folder.put("empty.nii", "")), "an empty file"));
  EXPECT_TRUE(contains(refusal(""), "No such file"));
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  // Opening a pipe that nobody writes to would wait.
  const std::string header = "NDims = 3\nDimSize = 1 1 1\nElementType = MET_CHAR\nElementDataFile = pipe\n";
  EXPECT_TRUE(contains(refusal(folder.put("a.mhd", header)), "expected a regular file"));
}

TEST(RawSlices, AreReadInTheOrderOfTheirNumbers) {
  const TempFolder folder;
  const std::vector<std::int16_t> samples = ramp<std::int16_t>(2 * 3 * 11);
  std::filesystem::create_directory(folder / "s");
  for (int n = 0; n < 11; ++n) {
    const std::vector<std::int16_t> slice(samples.begin() + 6 * n, samples.begin() + 6 * (n + 1));
    folder.put("s/CT." + std::to_string(n + 1), "head" + stored(slice, true));
  }
  OpenOptions options;
  options.raw = parse_raw_layout("2x3x11:int16:big:skip=4");
  for (const char* name : {"s/CT.*", "s"}) {
    const auto source = open_volume(folder / name, options);
    EXPECT_EQ(source->info().path, folder / name);
    EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{2, 3, 11}));
    EXPECT_EQ(samples_of<std::int16_t>(*source), samples) << name;
  }
}

TEST(RawSlices, NoteNumbersThatAreNotThere) {
  const TempFolder folder;
  for (const char* name : {"z1", "z2", "z3", "z5", "z6", "z7"}) folder.put(name, std::string(6, 'x'));
  OpenOptions options;
  options.raw = parse_raw_layout("2x3x6:uint8");
  const std::vector<std::string> notes = open_volume(folder / "z*", options)->info().notes;
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(contains(notes[0], "between 'z3' and 'z5'")) << notes[0];
}

TEST(RawSlices, AreAsManyAndAsLongAsTheLayoutSays) {
  const TempFolder folder;
  for (const char* name : {"z9", "z10"}) folder.put(name, std::string(6, 'x'));
  OpenOptions options;
  const auto refused = [&](const char* layout, const char* why) {
    options.raw = parse_raw_layout(layout);
    const std::string message = refusal(folder / "z*", options);
    EXPECT_TRUE(contains(message, why)) << message;
  };
  refused("2x3x3:uint8", "expected 3 files by the layout, one for each slice, found 2");
  refused("2x3x1:uint8", "expected 1 file by the layout, one for each slice, found 2");
  refused("2x2x2:uint8", "z9: expected 4 bytes by its layout, found 6");
  refused("2x3x2:uint8:skip=1", "z9: expected 7 bytes by its layout, found 6");
  folder.put("z10", std::string(5, 'x'));
  refused("2x3x2:uint8", "z10: expected 6 bytes by its layout, found 5");
  options.raw = parse_raw_layout("2x3x2:uint8");
  EXPECT_TRUE(contains(refusal(folder / "y*", options), "none"));
}

TEST(OpenVolume, RefusesAFileItMayNotRead) {
  const TempFolder folder;
  const std::string path = folder.put("a_1x1x1_uint8.raw", "x");
  ::chmod(path.c_str(), 0);
  if (::access(path.c_str(), R_OK) == 0) GTEST_SKIP() << "this user may read anything";
  EXPECT_TRUE(contains(refusal(path), "Permission denied"));
}

TEST(OpenVolume, SaysWhatItExpectedOfANameOrContent) {
  const TempFolder folder;
  EXPECT_TRUE(contains(refusal(folder.put("a.txt", "hello")), "expected NRRD, MetaImage, NIfTI, Analyze, MGH, MRC"));
  EXPECT_TRUE(contains(refusal(folder.put("a.raw", "hello")), "a layout in the name"));
  EXPECT_TRUE(contains(refusal(folder.put("a.nrrd", "hello")), "NRRD0001"));
  EXPECT_TRUE(contains(refusal(folder.put("a.nii.gz", gzipped("hello"))), "a NIfTI header"));
  EXPECT_FALSE(contains(refusal(folder.put("a\nb", "hello")), "\n"));
}

TEST(OpenVolume, AppliesOverrides) {
  const TempFolder folder;
  const std::string path = folder.put("a_2x1x1_uint8.raw", "xy");
  OpenOptions options;
  options.spacing = {0.5, 0.25, 2};
  options.origin = {1, -2, 3};
  const auto source = open_volume(path, options);
  EXPECT_EQ(source->info().geometry.spacing, *options.spacing);
  EXPECT_EQ(source->info().geometry.origin, *options.origin);
  options.spacing = {0.5, 0, 2};
  EXPECT_THROW(open_volume(path, options), std::invalid_argument);
  options.spacing = {0.5, std::nan(""), 2};
  EXPECT_THROW(open_volume(path, options), std::invalid_argument);
  options.spacing.reset();
  options.origin = {0, 0, std::nan("")};
  EXPECT_THROW(open_volume(path, options), std::invalid_argument);
}

}  // namespace
}  // namespace isoweave::testing::volume_raw_test
