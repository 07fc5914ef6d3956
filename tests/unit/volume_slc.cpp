#include "header_helpers.hpp"

namespace isoweave::testing::volume_slc_test {
namespace {

const std::string kHeader = "11111\n4 3 2 8\n0.5 0.75 2\n1 0 0\n";
// A picture of 2 x 1 in three colours.
const std::string kPicture = "2 1 Xrrggbb";
const std::vector<std::uint8_t> kSamples = ramp<std::uint8_t>(4 * 3 * 2);

std::string plain() { return kHeader + "0\n" + kPicture + stored(kSamples); }

// Each slice: four times the value, then eight bytes as they are, then the end.
std::string packed() {
  const std::string first = std::string("\x04\x09\x88", 3) + "abcdefgh" + std::string(1, '\0');
  const std::string second = std::string("\x84", 1) + "ijkl" + std::string("\x08\x01\0", 3);
  return kHeader + "1\n" + kPicture + std::to_string(first.size()) + " X" + first + std::to_string(second.size()) +
         " X" + second;
}

TEST(Slc, ReadsPlainSlices) {
  const TempFolder folder;
  const auto source = open_volume(folder.put("a.slc", plain()));
  EXPECT_EQ(source->info().format, "slc");
  EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{4, 3, 2}));
  EXPECT_EQ(source->info().geometry.spacing, (std::array<double, 3>{0.5, 0.75, 2}));
  EXPECT_EQ(samples_of<std::uint8_t>(*source), kSamples);
}

TEST(Slc, ReadsSlicesPackedByRunLengths) {
  const TempFolder folder;
  const std::string expected = std::string(4, '\x09') + "abcdefghijkl" + std::string(8, '\1');
  EXPECT_EQ(stored(read_file<std::uint8_t>(folder.put("a.slc", packed()))), expected);
  EXPECT_EQ(stored(read_file<std::uint8_t>(folder.put("a.slc.gz", gzipped(packed())))), expected);
}

TEST(Slc, RefusesHeadersThatLie) {
  const TempFolder folder;
  const auto refused = [&](const std::string& from, const std::string& to, const std::string& why,
                           std::string content = plain()) {
    const std::string message = refusal(folder.put("a.slc", content.replace(content.find(from), from.size(), to)));
    EXPECT_TRUE(contains(message, why)) << message;
  };
  refused("4 3 2 8", "4 3 3 8", "36 bytes of samples");
  refused("4 3 2 8", "4 3 0 8", "at least 1");
  refused("4 3 2 8", "4 3 -2 8", "whole number as the size");
  refused("4 3 2 8", "4 3.5 2 8", "whole number as the size");
  refused("4 3 2 8", "4 3 x 8", "a number as the size");
  refused("4 3 2 8", "1000000000 1000000000 1000000000 8", "samples");
  refused("4 3 2 8", "4 3 2 16", "8 bits per sample, found 16");
  refused("0.5", "0", "spacing on axis 0");
  refused("1 0 0\n0", "1 0 0\n2", "compression 0 or 1");
  refused("2 1 X", "2 1 Y", "X behind");
  refused("2 1 X", "1000000000 1000000000 X", "bytes of samples");
  refused("12 X", "10 X", "runs of a whole slice", packed());
  refused("12 X", "x X", "size of a packed slice", packed());
  refused("abc", "ab", "size of a packed slice", packed());
}

TEST(Slc, SurvivesTruncationAndRandomChanges) {
  const TempFolder folder;
  expect_prefixes_are_safe(folder, "a.slc", plain());
  expect_flips_are_safe(folder, "a.slc", plain(), 50, 1000);
  expect_prefixes_are_safe(folder, "a.slc", packed());
  expect_flips_are_safe(folder, "a.slc", packed(), 70, 1000);
}

}  // namespace
}  // namespace isoweave::testing::volume_slc_test
