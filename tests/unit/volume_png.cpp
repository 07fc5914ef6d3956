#include "png_helpers.hpp"

namespace isoweave::testing::volume_png_test {
namespace {

using namespace png_files;

TEST(Png, ReadsEightAndSixteenBitsPlainAndInterlaced) {
  const TempFolder folder;
  const auto bytes = ramp<std::uint8_t>(kWidth * kHeight);
  const auto words = ramp<std::uint16_t>(kWidth * kHeight);
  for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
    PngKind kind{8, PNG_COLOR_TYPE_GRAY, interlace};
    const auto source = open_volume(write_png(folder / "a.png", kind, stored(bytes)));
    EXPECT_EQ(source->info().format, "png");
    EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{kWidth, kHeight, 1}));
    EXPECT_EQ(samples_of<std::uint8_t>(*source), bytes);
    kind.bits = 16;
    EXPECT_EQ(read_file<std::uint16_t>(write_png(folder / "a", kind, stored(words, true))), words);
  }
}

TEST(Png, ReadsASeries) {
  const TempFolder folder;
  const auto words = ramp<std::uint16_t>(kWidth * kHeight * 3);
  const std::string all = stored(words, true);
  const std::size_t each = all.size() / 3;
  write_png(folder / "z8.png", {}, all.substr(0, each));
  write_png(folder / "z9.png", {}, all.substr(each, each));
  write_png(folder / "z10.png", {}, all.substr(2 * each));
  EXPECT_EQ(read_file<std::uint16_t>(folder / ""), words);
  write_png(folder / "z9.png", {8}, all);
  EXPECT_TRUE(contains(refusal(folder / ""), "z9.png: expected 11 x 9 uint16 as in"));
}

TEST(Png, RefusesWhatIsNotGreyOfWholeBytes) {
  const TempFolder folder;
  EXPECT_TRUE(contains(refusal(write_png(folder / "a.png", {8, PNG_COLOR_TYPE_RGB}, "")),
                       "expected grey samples of 8 or 16 bits, found RGB"));
  EXPECT_TRUE(contains(refusal(write_png(folder / "a.png", {8, PNG_COLOR_TYPE_GRAY_ALPHA}, "")),
                       "found grey with transparency of 8 bits"));
  EXPECT_TRUE(contains(refusal(write_png(folder / "a.png", {4}, "")), "of 4 bits"));
  EXPECT_TRUE(contains(refusal(folder.put("a.png", "hello")), "the magic of PNG"));
}

TEST(Png, RefusesSizesThatLie) {
  const TempFolder folder;
  std::string content = get(write_png(folder / "a.png", {}, stored(ramp<std::uint16_t>(kWidth * kHeight), true)));
  content.replace(16, 8, bytes_of(std::uint32_t{1} << 30, true) + bytes_of(std::uint32_t{1} << 30, true));
  const std::string header = content.substr(12, 17);
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(header.data()), 17);
  content.replace(29, 4, bytes_of(static_cast<std::uint32_t>(sum), true));
  EXPECT_TRUE(contains(refusal(folder.put("a.png", content)), "which cannot hold them"));
}

TEST(Png, SurvivesCutsAndFlips) {
  const TempFolder folder;
  const std::string words = stored(ramp<std::uint16_t>(kWidth * kHeight), true);
  const std::string content = get(write_png(folder / "w.png", {}, words));
  expect_prefixes_are_safe(folder, "a.png", content);
  expect_flips_are_safe(folder, "a.png", content, content.size(), 1000);
}

}  // namespace
}  // namespace isoweave::testing::volume_png_test
