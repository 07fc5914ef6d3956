#include "header_helpers.hpp"

namespace isoweave::testing::volume_fits_test {
namespace {

const std::vector<std::int16_t> kSamples = ramp<std::int16_t>(3 * 2 * 5);

std::string card(std::string text) {
  text.resize(80, ' ');
  return text;
}

std::string fits(const std::vector<std::string>& cards, const std::string& samples) {
  std::string content = card("SIMPLE  =                    T / a standard file");
  for (const std::string& text : cards) content += card(text);
  content += card("END");
  content.resize((content.size() + 2879) / 2880 * 2880, ' ');
  content += samples;
  content.resize((content.size() + 2879) / 2880 * 2880, '\0');
  return content;
}

std::vector<std::string> cards(const std::string& bits = "16", const std::string& last = "5") {
  return {"BITPIX  =                   " + bits + " / bits",
          "NAXIS   =                    3",
          "NAXIS1  =                    3",
          "NAXIS2  =                    2",
          "NAXIS3  =                    " + last,
          "COMMENT = no value"};
}

TEST(Fits, ReadsCubesInEveryType) {
  const TempFolder folder;
  const auto source = open_volume(folder.put("a.fits", fits(cards(), stored(kSamples, true))));
  EXPECT_EQ(source->info().format, "fits");
  EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{3, 2, 5}));
  EXPECT_EQ(samples_of<std::int16_t>(*source), kSamples);
  for (const auto& [bits, type] : {std::pair{"8", SampleType::kUint8},
                                   {"16", SampleType::kInt16},
                                   {"32", SampleType::kInt32},
                                   {"-32", SampleType::kFloat32},
                                   {"64", SampleType::kInt64},
                                   {"-64", SampleType::kFloat64}}) {
    EXPECT_EQ(open_volume(folder.put("a.fits", fits(cards(bits), std::string(240, '\0'))))->info().type, type);
  }
  EXPECT_EQ(read_file<std::int16_t>(folder.put("a.fits.gz", gzipped(fits(cards(), stored(kSamples, true))))), kSamples);
}

TEST(Fits, ScalesAndLeavesOutAxesOfOneSample) {
  const TempFolder folder;
  std::vector<std::string> all = cards();
  all[1] = "NAXIS   =                    4";
  all.insert(all.end(), {"NAXIS4  =                    1", "BZERO   =                32768",
                         "BSCALE  =                  1.", "BLANK   =               -32768"});
  const VolumeInfo info = open_volume(folder.put("a.fits", fits(all, stored(kSamples, true))))->info();
  EXPECT_EQ(info.slope, 1);
  EXPECT_EQ(info.intercept, 32768);
  EXPECT_TRUE(contains(info.notes.at(0), "BLANK is not applied: samples of '-32768'"));
  all[6] = "NAXIS4  =                    2";
  const std::vector<std::int16_t> both = ramp<std::int16_t>(60);
  const std::string path = folder.put("a.fits", fits(all, stored(both, true)));
  OpenOptions options;
  options.time = 1;
  EXPECT_EQ(read_file<std::int16_t>(path, options), std::vector<std::int16_t>(both.begin() + 30, both.end()));
  options.time = 2;
  EXPECT_TRUE(contains(refusal(path, options), "expected --time below 2, found 2"));
}

TEST(Fits, ExponentsMayBeWrittenWithD) {
  const TempFolder folder;
  for (const std::string exponent : {"E", "D", "e", "d"}) {
    std::vector<std::string> all = cards();
    all.insert(all.end(),
               {"BZERO   =           3.2768" + exponent + "4 / D, or E", "BSCALE  = +25." + exponent + "-2"});
    const VolumeInfo info = open_volume(folder.put("a.fits", fits(all, stored(kSamples, true))))->info();
    EXPECT_EQ(info.intercept, 32768) << exponent;
    EXPECT_EQ(info.slope, 0.25) << exponent;
  }
  std::vector<std::string> all = cards();
  all.emplace_back("BZERO   =           3.2768D4D4");
  EXPECT_TRUE(contains(refusal(folder.put("a.fits", fits(all, stored(kSamples, true)))),
                       "expected a number as BZERO, found '3.2768D4D4'"));
}

TEST(Fits, RefusesHeadersThatLie) {
  const TempFolder folder;
  const auto refused = [&](const std::vector<std::string>& all, const std::string& why) {
    const std::string message = refusal(folder.put("a.fits", fits(all, stored(kSamples, true))));
    EXPECT_TRUE(contains(message, why)) << message;
  };
  refused(cards("24"), "found 24");
  refused(cards("16", "500"), "6000 bytes of samples from byte 2880 on");
  refused(cards("16", "0"), "at least 1");
  refused(cards("16", "x"), "NAXIS3, found 'x'");
  refused(cards("16", "99999999999999999999"), "NAXIS3");
  refused({"BITPIX  = 8", "NAXIS   = 0"}, "extensions are not read");
  refused({"BITPIX  = 8"}, "NAXIS, found none");
  std::vector<std::string> all = cards();
  all.emplace_back("BSCALE  = 0");
  refused(all, "BSCALE");
  EXPECT_TRUE(contains(refusal(folder.put("a.fits", card("SIMPLE  = T"))), "card END"));
}

TEST(Fits, SurvivesTruncationAndRandomChanges) {
  const TempFolder folder;
  const std::string content = fits(cards(), stored(kSamples, true)).substr(0, 2880 + 60);
  expect_prefixes_are_safe(folder, "a.fits", content);
  expect_flips_are_safe(folder, "a.fits", content, 560, 1000);
}

}  // namespace
}  // namespace isoweave::testing::volume_fits_test
