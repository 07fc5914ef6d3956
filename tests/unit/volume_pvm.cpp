#include "volume/dds_stream.hpp"
#include "volume_helpers.hpp"

namespace isoweave::testing {
namespace {

class BitWriter {
 public:
  void put(unsigned value, unsigned count) {
    for (unsigned n = count; n-- > 0;) {
      if (used_ % 8 == 0) bytes_ += '\0';
      const unsigned bit = (value >> n) & 1;
      bytes_.back() = static_cast<char>(static_cast<unsigned char>(bytes_.back()) | (bit << (7 - used_ % 8)));
      ++used_;
    }
  }
  // Padded with zeros to whole words.
  std::string padded() const { return bytes_ + std::string((4 - bytes_.size() % 4) % 4, '\0'); }

 private:
  std::string bytes_;
  std::size_t used_ = 0;
};

// Sorts the bytes of each block of `block` samples of `skip` bytes by their place in the sample.
std::string sorted(const std::string& data, std::size_t skip, std::size_t block) {
  std::string result;
  for (std::size_t begin = 0; begin < data.size(); begin += skip * block) {
    const std::size_t end = std::min(data.size(), begin + skip * block);
    for (std::size_t place = 0; place < skip; ++place) {
      for (std::size_t at = begin + place; at < end; at += skip) result += data[at];
    }
  }
  return result;
}

// The differences of the sorted bytes to their predictions, in runs of up to `longest` of equal width.
std::string dds_encoded(const std::string& data, unsigned skip, std::size_t strip, std::size_t block,
                        std::size_t longest = 127) {
  const std::string bytes = sorted(data, skip, block);
  const auto at = [&](std::size_t n) { return static_cast<unsigned char>(bytes[n]); };
  std::vector<int> differences;
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    int predicted = n == 0 ? 0 : at(n - 1);
    if (strip > 1 && n > strip) predicted += at(n - strip) - at(n - strip - 1);
    differences.push_back(((at(n) - predicted + 128) & 255) - 128);
  }
  const auto width_of = [](int difference) {
    unsigned width = 2;
    while (difference < -(1 << (width - 1)) || difference >= (1 << (width - 1))) ++width;
    return difference == 0 ? 0u : width;
  };
  BitWriter bits;
  bits.put(skip - 1, 2);
  bits.put(static_cast<unsigned>(strip - 1), 16);
  for (std::size_t n = 0; n < differences.size();) {
    const unsigned width = width_of(differences[n]);
    std::size_t count = 1;
    while (n + count < differences.size() && count < longest && width_of(differences[n + count]) == width) ++count;
    bits.put(static_cast<unsigned>(count), 7);
    bits.put(width == 0 ? 0 : width - 1, 3);
    for (; count > 0; --count, ++n) bits.put(static_cast<unsigned>(differences[n] + (1 << width) / 2), width);
  }
  bits.put(0, 7);
  return bits.padded();
}

std::string dds_v3d(const std::string& data, unsigned skip, std::size_t strip) {
  return "DDS v3d\n" + dds_encoded(data, skip, strip, data.size());
}

const std::string kStrings("a\0b\0c\0d\0", 8);

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
}  // namespace isoweave::testing
