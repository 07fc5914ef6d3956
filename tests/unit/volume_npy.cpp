#include "header_helpers.hpp"

namespace isoweave::testing::volume_npy_test {
namespace {

const std::vector<std::int16_t> kSamples = ramp<std::int16_t>(3 * 2 * 5);  // f[k][j][i] of 5 x 2 x 3
constexpr const char* kShape = "(5, 2, 3)";

// The samples in the order in which the first axis is the fastest.
std::vector<std::int16_t> turned(const std::vector<std::int16_t>& samples) {
  std::vector<std::int16_t> result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      for (std::size_t k = 0; k < 5; ++k) result.push_back(samples[(k * 2 + j) * 3 + i]);
    }
  }
  return result;
}

TEST(Npy, ReadsAllVersionsInBothByteOrders) {
  const TempFolder folder;
  for (const int version : {1, 2, 3}) {
    for (const bool big : {false, true}) {
      const std::string header = npy_header(big ? ">i2" : "<i2", kShape, false, version);
      const auto source = open_volume(folder.put("a.npy", header + stored(kSamples, big)));
      EXPECT_EQ(source->info().format, "npy");
      EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{3, 2, 5}));
      EXPECT_EQ(source->info().type, SampleType::kInt16);
      EXPECT_TRUE(contains(source->info().notes.at(0), "spacing"));
      EXPECT_EQ(samples_of<std::int16_t>(*source), kSamples) << version << big;
    }
  }
}

// The same array is the same volume, however it is stored.
TEST(Npy, ReadsTheOrderOfFortranAsTheSameArray) {
  const TempFolder folder;
  for (const std::string name : {"a.npy", "a.npy.gz"}) {
    const std::string content = npy_header("<i2", kShape, true) + stored(turned(kSamples));
    const std::string path = folder.put(name, name == "a.npy" ? content : gzipped(content));
    EXPECT_EQ(open_volume(path)->info().dims, (std::array<std::int64_t, 3>{3, 2, 5}));
    EXPECT_EQ(read_file<std::int16_t>(path), kSamples);
    const auto source = open_volume(path);
    std::vector<std::int16_t> slice(6);
    source->read(3, 1, std::as_writable_bytes(std::span(slice)));
    EXPECT_TRUE(std::equal(slice.begin(), slice.end(), kSamples.begin() + 18));
  }
}

TEST(Npy, ReadsEveryTypeAndNamesTheOthers) {
  const TempFolder folder;
  const std::vector<std::pair<std::string, SampleType>> types{
      {"|u1", SampleType::kUint8},   {"|i1", SampleType::kInt8},   {"|b1", SampleType::kUint8},
      {"<u2", SampleType::kUint16},  {"<i2", SampleType::kInt16},  {">u4", SampleType::kUint32},
      {"=i4", SampleType::kInt32},   {"<i8", SampleType::kInt64},  {">u8", SampleType::kUint64},
      {"<f4", SampleType::kFloat32}, {">f8", SampleType::kFloat64}};
  for (const auto& [name, type] : types) {
    const std::string content = npy_header(name, kShape) + std::string(30 * sample_bytes(type), 'x');
    EXPECT_EQ(open_volume(folder.put("a.npy", content))->info().type, type) << name;
  }
  for (const std::string name : {"<f16", "<c8", "|O", "<U3", "<M8[ns]", "|S5", "<i9", ""}) {
    const std::string content = npy_header(name, kShape) + std::string(300, 'x');
    EXPECT_TRUE(contains(refusal(folder.put("a.npy", content)), "numbers of type '" + name + "'")) << name;
  }
}

TEST(Npy, TakesTheLastThreeAxes) {
  const TempFolder folder;
  const auto info = [&](const std::string& shape) {
    return open_volume(folder.put("a.npy", npy_header("<i2", shape) + stored(kSamples)))->info();
  };
  EXPECT_EQ(info("(10, 3)").dims, (std::array<std::int64_t, 3>{3, 10, 1}));
  EXPECT_EQ(info("(1, 5, 2, 3)").dims, (std::array<std::int64_t, 3>{3, 2, 5}));
  EXPECT_EQ(info("(5L, 2L, 3L)").dims, (std::array<std::int64_t, 3>{3, 2, 5}));
  EXPECT_EQ(info("( 5,2 ,3,)").dims, (std::array<std::int64_t, 3>{3, 2, 5}));
  const std::string path = folder.put("a.npy", npy_header("<i2", "(2, 5, 1, 3)") + stored(kSamples));
  EXPECT_EQ(open_volume(path)->info().dims, (std::array<std::int64_t, 3>{3, 5, 2}));
  const std::string four = folder.put("a.npy", npy_header("<i2", "(2, 5, 3, 2)") + stored(ramp<std::int16_t>(60)));
  EXPECT_TRUE(contains(refusal(four), "--channel"));
  OpenOptions second;
  second.channel = 1;
  const std::vector<std::int16_t> all = ramp<std::int16_t>(60);
  EXPECT_EQ(read_file<std::int16_t>(four, second), std::vector<std::int16_t>(all.begin() + 30, all.end()));
}

TEST(Npy, ArraysOfTooFewAxesAreCalledByTheirSizes) {
  const TempFolder folder;
  const std::string expected =
      "expected an array of 2 or 3 axes, or one that names its axes x, y, z, channel and time, found ";
  const auto found = [&](const std::string& shape, std::size_t bytes) {
    const std::string message = refusal(folder.put("a.npy", npy_header("|u1", shape) + std::string(bytes, 'x')));
    const std::size_t at = message.find(expected);
    return at == std::string::npos ? message : message.substr(at + expected.size());
  };
  EXPECT_EQ(found("()", 1), "a single value without axes");
  EXPECT_EQ(found("(7,)", 7), "one of 7");
  EXPECT_EQ(found("(2, 2, 2, 2)", 16), "one of 2 x 2 x 2 x 2 (--channel and --time choose along leading axes)");
  OpenOptions options;
  options.time = 0;
  folder.put("a.npy", npy_header("|u1", "()") + "x");
  EXPECT_TRUE(contains(refusal(folder / "a.npy", options), "an axis for --time, found a single value without axes"));
}

TEST(Npy, TakesAChannelOfTheOrderOfFortran) {
  const TempFolder folder;
  std::vector<std::int16_t> both;
  for (const std::int16_t sample : turned(kSamples)) both.insert(both.end(), {-1, sample});
  OpenOptions second;
  second.channel = 1;
  const std::string path = folder.put("a.npy", npy_header("<i2", "(2, 5, 2, 3)", true) + stored(both));
  EXPECT_EQ(read_file<std::int16_t>(path, second), kSamples);
}

TEST(Npy, RefusesHeadersThatLie) {
  const TempFolder folder;
  const std::string bytes = stored(kSamples);
  const auto refused = [&](const std::string& header, const std::string& why) {
    const std::string message = refusal(folder.put("a.npy", header + bytes));
    EXPECT_TRUE(contains(message, why)) << message;
  };
  refused(npy_header("<i2", "(5, 2, 4)"), "80 bytes of samples from byte 128 on, found a file of 188");
  refused(npy_header("<i2", "(5, 0, 3)"), "at least one sample");
  refused(npy_header("<i2", "(30,)"), "2 or 3 axes");
  refused(npy_header("<i2", "()"), "2 or 3 axes");
  refused(npy_header("<i2", "(-5, 2, 3)"), "dictionary");
  refused(npy_header("<i2", "(4294967296, 4294967296, 4294967296)"), "2^63");
  refused(npy_header("<i2", kShape, false, 4), "version 1, 2 or 3, found 4");
  refused("\x93NUMPY\1" + std::string(1, '\0') + "\xff\xff{}", "65535 bytes");
  const auto dictionary = [](const std::string& text) {
    return "\x93NUMPY\1" + std::string(1, '\0') + bytes_of(static_cast<std::uint16_t>(text.size())) + text;
  };
  refused(dictionary("{'descr': [('a', '<i2')], 'fortran_order': False, 'shape': (5, 2, 3)}"), "structured array");
  refused(dictionary("{'descr': '<i2', 'shape': (5, 2, 3)}"), "dictionary");
  refused(dictionary("{'descr': '<i2', 'fortran_order': Maybe, 'shape': (5, 2, 3)}"), "dictionary");
  refused(dictionary("{'descr': '<i2, 'fortran_order': False}"), "dictionary");
  refused(dictionary("{'descr': '<i2', 'fortran_order': False, 'shape': (5, 2, 3), 'more': 1}"), "dictionary");
  refused(dictionary("nothing"), "dictionary");
}

TEST(Npy, SurvivesTruncationAndRandomChanges) {
  const TempFolder folder;
  for (const bool fortran : {false, true}) {
    const std::string content = npy_header("<i2", kShape, fortran) + stored(kSamples);
    expect_prefixes_are_safe(folder, "a.npy", content);
    expect_flips_are_safe(folder, "a.npy", content, 80, 1000);
  }
}

}  // namespace
}  // namespace isoweave::testing::volume_npy_test
