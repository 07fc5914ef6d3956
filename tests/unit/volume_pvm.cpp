#include "pvm_helpers.hpp"
#include "volume/formats/other/dds_stream.hpp"

namespace isoweave::testing::volume_pvm_test {
namespace {

using namespace pvm_files;

TEST(Pvm, ReadsAllVersionsOfEightBits) {
  const TempFolder folder;
  const auto samples = ramp<std::uint8_t>(4 * 3 * 5);
  const std::string data = stored(samples);
  for (const std::string& content :
       {"PVM\n4 3 5\n1\n" + data, "PVM\n# a comment\n4 3 5\n1\n" + data, "PVM2\n4 3 5\n1 2 0.5\n1\n" + data,
        "PVM3\n4 3 5\n1 2 0.5\n1\n" + data + kStrings}) {
    const auto source = open_volume(folder.put("a.pvm", content));
    EXPECT_EQ(source->info().format, "pvm");
    EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{4, 3, 5}));
    EXPECT_EQ(source->info().geometry.spacing[1], content[3] == '\n' ? 1 : 2);
    EXPECT_EQ(samples_of<std::uint8_t>(*source), samples);
  }
}

TEST(Pvm, ReadsSixteenBitsMostSignificantFirst) {
  const TempFolder folder;
  const std::vector<std::uint16_t> samples{1, 258, 65535, 256};
  EXPECT_EQ(read_file<std::uint16_t>(folder.put("a.pvm", "PVM\n2 2 1\n2\n" + stored(samples, true))), samples);
}

TEST(Pvm, ReadsDdsOfEverySkipAndManyStrips) {
  const TempFolder folder;
  std::mt19937 random(7);
  std::vector<std::uint16_t> samples(5 * 7 * 9);
  for (std::size_t n = 0; n < samples.size(); ++n) {
    samples[n] = static_cast<std::uint16_t>(n % 50 < 25 ? n * 3 : random());
  }
  const std::string content = "PVM3\n5 7 9\n1 1 2\n2\n" + stored(samples, true) + kStrings;
  for (const unsigned skip : {1u, 2u, 3u, 4u}) {
    for (const std::size_t strip : {1u, 2u, 5u, 64u, 700u, 65536u}) {
      const auto source = open_volume(folder.put("a.pvm", dds_v3d(content, skip, strip)));
      EXPECT_EQ(source->info().geometry.spacing[2], 2);
      EXPECT_EQ(samples_of<std::uint16_t>(*source), samples) << "skip " << skip << " strip " << strip;
    }
  }
}

TEST(Pvm, ReadsDdsOfOneBlockInBothVersions) {
  const TempFolder folder;
  const auto samples = ramp<std::uint8_t>(4 * 3 * 5);
  const std::string content = "PVM\n4 3 5\n1\n" + stored(samples);
  std::string packed = dds_v3d(content, 2, 4);
  EXPECT_EQ(read_file<std::uint8_t>(folder.put("a.pvm", packed)), samples);
  packed[6] = 'e';
  EXPECT_EQ(read_file<std::uint8_t>(folder.put("a.pvm", packed)), samples);
}

// Blocks of the real size would need volumes of 32 MiB.
TEST(Dds, UndoesTheOrderOfManyBlocks) {
  const TempFolder folder;
  std::string data;
  for (int n = 0; n < 1003; ++n) data += static_cast<char>(n * n / 7);
  for (const unsigned skip : {1u, 2u, 3u, 4u}) {
    for (const std::size_t block : {1u, 10u, 64u, 250u, 251u, 5000u}) {
      const auto file = open_file(folder.put("a", dds_encoded(data, skip, 9, block)));
      DdsStream stream(file, 0, block);
      EXPECT_EQ(stream.total_bytes(), data.size());
      std::string decoded(data.size() + 5, '\0');
      decoded.resize(stream.read(std::as_writable_bytes(std::span(decoded))));
      EXPECT_EQ(decoded, data) << "skip " << skip << " block " << block;
    }
  }
}

TEST(Dds, ReadsDataLongerThanItsBuffers) {
  const TempFolder folder;
  std::string data;
  for (std::uint32_t n = 0; n < 300001; ++n) data += static_cast<char>((n * 2654435761u) >> 24);
  const auto file = open_file(folder.put("a", dds_encoded(data, 3, 1000, data.size())));
  DdsStream stream(file, 0, 0);
  EXPECT_EQ(stream.skip(123456), 123456u);
  std::string decoded(data.size(), '\0');
  decoded.resize(stream.read(std::as_writable_bytes(std::span(decoded))));
  EXPECT_EQ(decoded, data.substr(123456));
}

TEST(Dds, MayEndWithoutItsClosingRun) {
  const TempFolder folder;
  const auto samples = ramp<std::uint8_t>(4 * 3 * 5);
  std::string packed = dds_v3d("PVM\n4 3 5\n1\n" + stored(samples), 1, 4);
  while (packed.back() == '\0') packed.pop_back();
  EXPECT_EQ(read_file<std::uint8_t>(folder.put("a.pvm", packed)), samples);
}

TEST(Pvm, RefusesHeadersThatLie) {
  const TempFolder folder;
  const std::string data(60, 'x');
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"PVM\n4 3 6\n1\n", "72 bytes of samples, found 60"},
      {"PVM\n4 3 5\n2\n", "120 bytes"},
      {"PVM\n4 3 5\n3\n", "RGB"},
      {"PVM\n4 3 5\n0\n", "'0'"},
      {"PVM\n0 3 5\n1\n", "at least 1"},
      {"PVM\n4 -3 5\n1\n", "at least 1"},
      {"PVM\n4 3\n1\n", "width height depth"},
      {"PVM\n4 3 x\n1\n", "'x'"},
      {"PVM\n4294967296 4294967296 4294967296\n1\n", "2^63"},
      {"PVM\n3000000 3000000 300000\n1\n", "found 60"},
      {"PVM2\n4 3 5\n1 0 1\n1\n", "positive spacings"},
      {"PVM2\n4 3 5\n1 nan 1\n1\n", "positive spacings"},
      {"PVM2\n4 3 5\n1 inf 1\n1\n", "finite sample spacing"},
      {"PVM2\n4 3 5\n1 1\n1\n", "3 spacings"},
      {"PVM\n#" + std::string(5000, 'x') + "\n4 3 5\n1\n", "short lines"}};
  for (const auto& [header, why] : wrong) {
    EXPECT_TRUE(contains(refusal(folder.put("a.pvm", header + data)), why)) << header.substr(0, 60);
    EXPECT_TRUE(contains(refusal(folder.put("a.pvm", dds_v3d(header + data, 1, 4))), why)) << header.substr(0, 60);
  }
  EXPECT_TRUE(contains(refusal(folder.put("a.pvm", dds_v3d("no volume\n", 2, 4))), "PVM, PVM2 or PVM3"));
  EXPECT_TRUE(contains(refusal(folder.put("a.pvm", "DDS v3d\n")), "its end missing"));
  EXPECT_TRUE(contains(refusal(folder.put("a.pvm", std::string("DDS v3d\n\0\0\0\0", 12))), "a complete PVM header"));
}

TEST(Pvm, SurvivesEveryTruncation) {
  const TempFolder folder;
  const std::string content = "PVM2\n4 3 5\n1 2 0.5\n2\n" + stored(ramp<std::uint16_t>(60));
  expect_prefixes_are_safe(folder, "a.pvm", content);
  expect_prefixes_are_safe(folder, "b.pvm", dds_v3d(content, 1, 4));
  expect_prefixes_are_safe(folder, "c.pvm", dds_v3d(content, 2, 4));
}

TEST(Pvm, SurvivesRandomChanges) {
  const TempFolder folder;
  const std::string content = "PVM2\n4 3 5\n1 2 0.5\n2\n" + stored(ramp<std::uint16_t>(60));
  expect_flips_are_safe(folder, "a.pvm", content, 24);
  expect_flips_are_safe(folder, "b.pvm", dds_v3d(content, 2, 4), 60);
}

}  // namespace
}  // namespace isoweave::testing::volume_pvm_test
