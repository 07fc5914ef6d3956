// Segmentations in DICOM: frames of segments, of fractions and of numbers, as label maps.
#include <algorithm>

#include "dicom_segment_helpers.hpp"
#include "volume/formats/dicom/dicom_segments.hpp"

namespace isoweave::testing::volume_dicom_segments_test {
namespace {

using namespace dicom_files;

OpenOptions with_channel(std::int64_t channel) {
  OpenOptions options;
  options.channel = channel;
  return options;
}

// The samples that are not 0, as "plane/sample=value" in order.
std::string listed(const std::vector<std::uint8_t>& samples) {
  std::string text;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    if (samples[n] == 0) continue;
    text += (text.empty() ? "" : " ") + std::to_string(n / kSlice) + "/" + std::to_string(n % kSlice) + "=" +
            std::to_string(samples[n]);
  }
  return text;
}

std::string refusal_of(const std::vector<SegmentFrame>& frames, const SaidOfSegments& said) {
  const TempFolder folder;
  return refusal(folder.put("a", segmentation(frames, said)));
}

TEST(DicomSegments, AreLabelsAtTheirPlaces) {
  const TempFolder folder;
  const std::string path =
      folder.put("a", segmentation({{1, 32.5, {0, 34}}, {1, 30, {3}}, {5, 32.5, {1}}, {5, 40, {7, 33}}},
                                   {.segments = {{1, "Liver"}, {5, "Left kidney"}, {6, "Spleen"}}}));
  const auto source = open_volume(path);
  const VolumeInfo& info = source->info();
  EXPECT_EQ(info.format, "dicom-seg");
  EXPECT_EQ(info.dims, (std::array<std::int64_t, 3>{kColumns, kRows, 7}));
  EXPECT_EQ(info.type, SampleType::kUint8);
  EXPECT_EQ(info.geometry.spacing, (std::array<double, 3>{0.25, 0.5, 2.5}));
  EXPECT_EQ(info.geometry.origin, (std::array<double, 3>{10, 20, 27.5}));
  EXPECT_EQ(info.geometry.unit, "mm");
  EXPECT_EQ(listed(read_file<std::uint8_t>(path)), "1/3=1 2/0=1 2/1=5 2/34=1 5/7=5 5/33=5");
  ASSERT_EQ(info.labels.size(), 3U);
  EXPECT_EQ(info.labels[1].label, Label(5));
  EXPECT_EQ(info.labels[1].name, "Left kidney");
  EXPECT_EQ(info.labels[1].layer, 0);
  for (const double part : info.labels[1].color.value()) EXPECT_NEAR(part, 1, 1e-3);
}

TEST(DicomSegments, ThatOverlapAreLayers) {
  const TempFolder folder;
  const std::vector<SegmentFrame> frames{{2, 30, {3, 4}}, {7, 30, {4, 5}}, {7, 32, {6}}};
  for (const std::string said : {"", "UNDEFINED", "YES"}) {
    const std::string path = folder.put("a", segmentation(frames, {.segments = {{2, "a"}, {7, "b"}}, .overlap = said}));
    const auto source = open_volume(path);
    EXPECT_EQ(source->info().labels[1].layer, 1) << said;
    EXPECT_TRUE(contains(source->info().notes.at(0), "the first of 2 along channel is read; --channel chooses"));
    EXPECT_EQ(listed(read_file<std::uint8_t>(path)), "1/3=2 1/4=2");
    EXPECT_EQ(listed(read_file<std::uint8_t>(path, with_channel(1))), "1/4=7 1/5=7 2/6=7");
    EXPECT_TRUE(contains(refusal(path, with_channel(2)), "expected --channel below 2, found 2"));
  }
  const auto unnamed = open_volume(folder.put("c", segmentation(frames, {})));
  ASSERT_EQ(unnamed->info().labels.size(), 2U) << "a layer without a label would not be found";
  EXPECT_EQ(unnamed->info().labels[1].label, Label(7));
  EXPECT_EQ(unnamed->info().labels[1].layer, 1);
  const std::string wrong = folder.put("b", segmentation(frames, {.overlap = "NO"}));
  const auto source = open_volume(wrong);
  std::vector<std::byte> samples(source->info().slice_bytes());
  source->read(0, 1, samples);
  try {
    source->read(1, 1, samples);
    FAIL() << "segments that overlap were read";
  } catch (const BadInput& error) {
    EXPECT_TRUE(contains(error.what(), "b (frame 2): expected segments that do not overlap")) << error.what();
  }
}

TEST(DicomSegments, OfManyNumbersTakeTwoBytes) {
  const TempFolder folder;
  const std::string path = folder.put("a", segmentation({{1, 30, {0}}, {300, 30, {1}}}, {}));
  EXPECT_EQ(open_volume(path)->info().type, SampleType::kUint16);
  const std::vector<std::uint16_t> samples = read_file<std::uint16_t>(path);
  EXPECT_EQ(samples.at(kSlice + 1), 300);
}

TEST(DicomSegments, AsFractionsArePartsOfOne) {
  const TempFolder folder;
  const std::string most = segment_number(0xe, 200);
  const std::string path =
      folder.put("a", segmentation({{1, 30, {4}, 200}, {1, 33, {5}, 50}}, {.type = "FRACTIONAL", .more = most}));
  const auto source = open_volume(path);
  EXPECT_EQ(source->info().slope, 1.0 / 200);
  EXPECT_EQ(source->info().intercept, 0);
  EXPECT_EQ(listed(read_file<std::uint8_t>(path)), "1/4=200 2/5=50");
  const std::string two =
      folder.put("b", segmentation({{1, 30, {4}, 200}, {2, 30, {5}, 50}}, {.type = "FRACTIONAL", .more = most}));
  EXPECT_EQ(listed(read_file<std::uint8_t>(two, with_channel(1))), "1/5=50");
  EXPECT_TRUE(contains(refusal_of({{1, 30, {4}}}, {.type = "FRACTIONAL"}), "expected a Maximum Fractional Value"));
}

TEST(DicomSegments, AsNumbersAreReadWithTheirColours) {
  const TempFolder folder;
  DicomFields fields;
  fields.photometric = "PALETTE COLOR";
  const std::string path =
      folder.put("a", segmentation({{0, 30, {4, 5}, 9}, {0, 31, {5}, 3}},
                                   {.type = "LABELMAP", .segments = {{0, "background"}, {9, "skin"}}}, fields));
  EXPECT_EQ(listed(read_file<std::uint8_t>(path)), "1/4=9 1/5=9 2/5=3");
  const auto source = open_volume(path);
  ASSERT_EQ(source->info().labels.size(), 1U);
  EXPECT_EQ(source->info().labels[0].name, "skin");
  EXPECT_TRUE(contains(refusal_of({{0, 30, {4}}, {0, 30, {6}}, {0, 31, {5}}}, {.type = "LABELMAP"}),
                       "(frame 2): expected one frame of a segment in a place"));
}

// Frames that are left out do not hide how far planes are apart, where the header says it.
TEST(DicomSegments, LieAtTheDistanceThatIsSaid) {
  const TempFolder folder;
  DicomFields fields;
  const auto planes = [&](const std::string& said) {
    const std::string distance = element(0x18, 0x88, "DS", said);
    std::string file = segmentation({{1, 30, {1}}, {1, 36, {2}}, {1, 39, {3}}}, {.more = ""}, fields);
    const std::string spacing = element(0x28, 0x30, "DS", "0.5\\0.25");
    const std::string macro = group(0x28, 0x9110, spacing);
    const std::string longer = group(0x28, 0x9110, distance + spacing);
    const std::size_t at = file.find(macro);
    file.replace(at, macro.size(), longer);
    // The two lengths around the macro: its group's and that of the shared groups.
    const auto grow = [&](std::size_t place) {
      std::uint32_t length = 0;
      std::memcpy(&length, file.data() + place, 4);
      length += static_cast<std::uint32_t>(longer.size() - macro.size());
      std::memcpy(file.data() + place, &length, 4);
    };
    const std::size_t shared = file.find(std::string("\x00\x52\x29\x92SQ\0\0", 8));
    grow(shared + 8);
    grow(shared + 16);
    return open_volume(folder.put("a", file))->info().dims[2] - 2;
  };
  EXPECT_EQ(planes("3"), 4);
  EXPECT_EQ(planes("1.5"), 7);
  EXPECT_EQ(planes("2"), 4) << "frames do not lie so far apart, and the smallest distance counts";
}

TEST(DicomSegments, BetweenPlanesAreRefused) {
  const TempFolder folder;
  const std::string path = folder.put("a", segmentation({{1, 30, {1}}, {1, 32, {2}}, {1, 35, {3}}}, {}));
  EXPECT_TRUE(contains(refusal(path),
                       "expected frames at multiples of one distance, as a segmentation may leave empty "
                       "ones out, found distances of 2 to 3 mm"));
  OpenOptions options;
  options.uneven_slices = UnevenSlices::kMean;
  EXPECT_EQ(listed(read_file<std::uint8_t>(path, options)), "1/1=1 2/2=1 3/3=1");
  EXPECT_EQ(open_volume(path, options)->info().geometry.spacing[2], 2.5);
}

TEST(DicomSegments, ThatAreNoneAreRefused) {
  EXPECT_TRUE(contains(refusal_of({{1, 30, {4}}}, {.type = ""}),
                       "expected BINARY, FRACTIONAL or LABELMAP as Segmentation Type, found none"));
  EXPECT_TRUE(contains(refusal_of({{1, 30, {4}}, {0, 32, {4}}}, {}), "expected frames of segments from 1 on"));
  EXPECT_TRUE(contains(refusal_of({{1, 30, {4}}, {1, 30, {5}}}, {}), "expected one frame of a segment in a place"));
  const TempFolder folder;
  const std::string whole = segmentation({{1, 30, {4}}, {1, 32, {4}}, {1, 34, {4}}}, {});
  std::string fewer = whole.substr(0, whole.size() - 2);
  fewer[fewer.size() - 16] = 12;  // bytes of samples, of 14
  EXPECT_TRUE(contains(refusal(folder.put("a", fewer)), "expected 14 bytes of samples, found 12"));
  std::filesystem::create_directory(folder / "two");
  folder.put("two/a", segmentation({{1, 30, {4}}}, {}));
  folder.put("two/b", segmentation({{1, 30, {5}}}, {}));
  EXPECT_TRUE(contains(refusal(folder / "two"), "expected one segmentation, or one file of them"));
  EXPECT_EQ(open_volume(folder / "two/a")->info().dims[2], 3);
  folder.put("two/b", segmentation({{1, 30, {4}}}, {}));
  EXPECT_EQ(open_volume(folder / "two")->info().dims[2], 3) << "a copy of the file";
  OpenOptions options;
  options.slices_from = SliceAxis::kChannels;
  EXPECT_TRUE(contains(refusal(folder / "two/a", options), "for --slices-from, found DICOM, which does"));
}

TEST(DicomSegments, HaveColoursOfTheirHeaders) {
  const auto lab = [](double luminance, double a, double b) {
    const auto word = [](double part) { return static_cast<std::uint32_t>(part * 65535 + 0.5); };
    return color_of_lab({word(luminance / 100), word((a + 128) / 255), word((b + 128) / 255)});
  };
  // sRGB (1, 0, 0) and (0.2, 0.4, 0.6) by scikit-image's rgb2lab, whose white is D65.
  const std::array<double, 3> red = lab(53.2406, 80.0923, 67.2028), blue = lab(42.0077, -0.1513, -32.8500);
  constexpr double kSlack = 2e-3;
  EXPECT_NEAR(red[0], 1, kSlack);
  EXPECT_NEAR(red[1], 0, kSlack);
  EXPECT_NEAR(red[2], 0, kSlack);
  EXPECT_NEAR(blue[0], 0.2, kSlack);
  EXPECT_NEAR(blue[1], 0.4, kSlack);
  EXPECT_NEAR(blue[2], 0.6, kSlack);
}

// An image of bits that is no segmentation, such as a screenshot.
TEST(DicomBitmaps, AreReadAsZeroAndOne) {
  const TempFolder folder;
  DicomFields fields;
  fields.bits = 1;
  const std::string path =
      folder.put("a", enhanced({frame_at(0), frame_at(1)}, bits_of({{1, 0, {2}}, {1, 1, {0, 34}}}), fields));
  EXPECT_EQ(listed(read_file<std::uint8_t>(path)), "0/2=1 1/0=1 1/34=1");
}

}  // namespace
}  // namespace isoweave::testing::volume_dicom_segments_test
