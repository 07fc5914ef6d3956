// Segmentations of 3D Slicer: what the header of a .seg.nrrd tells of its segments, and the layers they lie in.
#include <gtest/gtest.h>

#include "volume_helpers.hpp"

namespace isoweave::testing::volume_segmentation_test {
namespace {

// Two layers of 3 x 2 x 2 samples, interleaved, as Slicer keeps segments that overlap.
std::string segmentation(const std::string& pairs, const std::string& kind = "list") {
  std::string samples;
  for (char n = 0; n < 12; ++n) samples += {static_cast<char>(n < 6 ? 1 : 2), static_cast<char>(n < 9 ? 0 : 1)};
  return "NRRD0004\ntype: unsigned char\ndimension: 4\nspace: left-posterior-superior\nsizes: 2 3 2 2\n"
         "space directions: none (1,0,0) (0,1,0) (0,0,2)\nkinds: " +
         kind +
         " domain domain domain\nencoding: raw\n"
         "space origin: (0,0,0)\n" +
         pairs + "\n" + samples;
}

constexpr const char* kSegments =
    "Segment0_Color:=0.5 1 0\nSegment0_Extent:=0 2 0 1 0 1\nSegment0_ID:=Segment_1\nSegment0_LabelValue:=1\n"
    "Segment0_Layer:=0\nSegment0_Name:=Left lung\nSegment1_LabelValue:=2\nSegment1_Layer:=0\nSegment1_Name:=a\\\\b\n"
    "Segment10_LabelValue:=1\nSegment10_Layer:=1\nSegment10_Name:=Tumor\nSegmentation_ContainedRepresentationNames:="
    "x\n";

std::string text_of(const std::vector<LabelName>& labels) {
  std::string text;
  for (const LabelName& label : labels) {
    text += label.label.text() + "@" + std::to_string(label.layer) + "=" + label.name + "|";
  }
  return text;
}

TEST(Segmentation, NamesLayersAndColours) {
  const TempFolder folder;
  const auto path = folder.put("a.seg.nrrd", segmentation(kSegments));
  OpenOptions options;
  const auto source = open_volume(path);
  EXPECT_EQ(text_of(source->info().labels), "1@0=Left lung|2@0=a\\b|1@1=Tumor|");
  EXPECT_EQ(source->info().labels[0].color, (std::array<double, 3>{0.5, 1, 0}));
  EXPECT_FALSE(source->info().labels[1].color);
  EXPECT_EQ(samples_of<std::uint8_t>(*source), (std::vector<std::uint8_t>{1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2}));
  options.channel = 1;
  EXPECT_EQ(samples_of<std::uint8_t>(*open_volume(path, options)),
            (std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1}));
}

// Before there were layers every segment was a component of its own, of value 1.
TEST(Segmentation, WithoutLayersEverySegmentIsOne) {
  const TempFolder folder;
  const auto path = folder.put("a.nrrd", segmentation("Segment0_Name:=x\nSegment1_Name:=y\n", "vector"));
  EXPECT_EQ(text_of(open_volume(path)->info().labels), "1@0=x|1@1=y|");
  EXPECT_EQ(text_of(open_volume(folder.put("b.nrrd", segmentation("key:=value\nSegment:=no\nSegmentX_Name:=no\n")))
                        ->info()
                        .labels),
            "");
}

TEST(Segmentation, WhatDoesNotFitIsRefused) {
  const TempFolder folder;
  const auto says = [&](const std::string& pairs) { return refusal(folder.put("a.nrrd", segmentation(pairs))); };
  EXPECT_TRUE(
      contains(says("Segment0_LabelValue:=one\n"), "expected a whole number as Segment0_LabelValue, found 'one'"));
  EXPECT_TRUE(contains(says("Segment3_Layer:=2\n"), "expected Segment3_Layer from 0 to 1, found '2'"));
  EXPECT_TRUE(contains(says("Segment3_Layer:=-1\n"), "expected Segment3_Layer from 0 to 1"));
  EXPECT_TRUE(contains(says("Segment2_Name:=z\n"), "expected Segment2_Layer from 0 to 1, found segment 2"));
  const std::string whole = segmentation(kSegments);
  for (std::size_t length = 1; length < whole.size(); ++length) {
    EXPECT_FALSE(reads_or_refuses(folder.put("a.nrrd", whole.substr(0, length)))) << length;
  }
}

}  // namespace
}  // namespace isoweave::testing::volume_segmentation_test
