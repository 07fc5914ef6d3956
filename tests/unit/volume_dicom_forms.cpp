// DICOM as it is found: stacks of frames without groups, data sets without magic, exports with folders in folders.
#include "dicom_helpers.hpp"

namespace isoweave::testing::volume_dicom_forms_test {
namespace {

using namespace dicom_files;

std::string all_notes(const VolumeInfo& info) {
  std::string text;
  for (const std::string& note : info.notes) text += note + "\n";
  for (const std::string& remark : info.remarks) text += remark + "\n";
  return text;
}

// Three frames in one file without groups, of the samples' slices 0 to 2.
std::string stack(DicomFields fields, const std::string& samples = slice(0) + slice(1) + slice(2)) {
  fields.frames = "3";
  return dicom(fields, samples);
}

std::vector<std::uint16_t> in_order(const std::vector<std::size_t>& slices) {
  std::vector<std::uint16_t> samples;
  for (const std::size_t n : slices) {
    const auto first = kSamples.begin() + static_cast<std::ptrdiff_t>(n * kSlice);
    samples.insert(samples.end(), first, first + kSlice);
  }
  return samples;
}

std::string tag_list(const std::vector<std::uint16_t>& words) { return element(0x28, 9, "AT", stored(words)); }

TEST(DicomStack, TakesOnePositionAndADistance) {
  const TempFolder folder;
  DicomFields fields;
  fields.more = element(0x18, 0x88, "DS", "1.5");
  const auto source = open_volume(folder.put("a", stack(fields)));
  EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{kColumns, kRows, 3}));
  EXPECT_EQ(source->info().geometry.spacing, (std::array<double, 3>{0.25, 0.5, 1.5}));
  EXPECT_EQ(source->info().geometry.origin, (std::array<double, 3>{10, 20, 30}));
  EXPECT_EQ(samples_of<std::uint16_t>(*source), in_order({0, 1, 2}));
  EXPECT_TRUE(contains(all_notes(source->info()),
                       "the frames have no places of their own (functional groups): the distance is Spacing Between "
                       "Slices, 1.5 mm"))
      << all_notes(source->info());
  // Frames go down the normal where the distance says so.
  fields.more = element(0x18, 0x88, "DS", "-1.5");
  const auto down = open_volume(folder.put("a", stack(fields)));
  EXPECT_EQ(down->info().geometry.origin, (std::array<double, 3>{10, 20, 27}));
  EXPECT_EQ(samples_of<std::uint16_t>(*down), in_order({2, 1, 0}));
}

TEST(DicomStack, GuessesADistanceAndSaysSo) {
  const TempFolder folder;
  DicomFields fields;
  fields.thickness = "2";
  const VolumeInfo thick = open_volume(folder.put("a", stack(fields)))->info();
  EXPECT_EQ(thick.geometry.spacing[2], 2);
  EXPECT_TRUE(contains(all_notes(thick), "taken from Slice Thickness, 2 mm"));
  const VolumeInfo unknown = open_volume(folder.put("a", stack({})))->info();
  EXPECT_EQ(unknown.geometry.spacing[2], 1);
  EXPECT_TRUE(contains(all_notes(unknown), "the distance is not given and taken as 1 (--spacing says another)"));
  EXPECT_EQ(unknown.geometry.unit, "mm");
  fields = {};
  fields.position.clear();
  fields.orientation.clear();
  fields.pixel_spacing.clear();
  const VolumeInfo nothing = open_volume(folder.put("a", stack(fields)))->info();
  EXPECT_EQ(nothing.geometry.spacing, (std::array<double, 3>{1, 1, 1}));
  EXPECT_EQ(nothing.geometry.unit, "");
  EXPECT_TRUE(contains(all_notes(nothing),
                       "the position is not given and taken as '0\\0\\0'; the orientation is not "
                       "given and taken as '1\\0\\0\\0\\1\\0'; the pixel spacing is not given"))
      << all_notes(nothing);
  fields.more = element(0x18, 0x1164, "DS", "0.3\\0.2");
  const VolumeInfo imager = open_volume(folder.put("a", stack(fields)))->info();
  EXPECT_EQ(imager.geometry.spacing, (std::array<double, 3>{0.2, 0.3, 1}));
  EXPECT_EQ(imager.geometry.unit, "mm");
}

TEST(DicomStack, TakesTheOffsetsAndTheScalingOfADose) {
  const TempFolder folder;
  DicomFields fields;
  fields.more = element(0x3004, 0xc, "DS", "0\\-2\\-4") + element(0x3004, 0xe, "DS", "0.001");
  const auto down = open_volume(folder.put("a", stack(fields)));
  EXPECT_EQ(down->info().geometry.origin[2], 26);
  EXPECT_EQ(down->info().geometry.spacing[2], 2);
  EXPECT_EQ(down->info().slope, 0.001);
  EXPECT_EQ(samples_of<std::uint16_t>(*down), in_order({2, 1, 0}));
  // Planes by their z, where the first of them is that of the position; the normal of these slices points down.
  fields.orientation = "1\\0\\0\\0\\-1\\0";
  fields.more = element(0x3004, 0xc, "DS", "30\\33\\36");
  const auto planes = open_volume(folder.put("a", stack(fields)));
  EXPECT_EQ(planes->info().geometry.origin[2], 36);
  EXPECT_EQ(planes->info().geometry.direction[8], -1);
  EXPECT_EQ(samples_of<std::uint16_t>(*planes), in_order({2, 1, 0}));
  fields.more = element(0x3004, 0xc, "DS", "0\\1");
  EXPECT_TRUE(
      contains(refusal(folder.put("a", stack(fields))), "expected 3 numbers as Grid Frame Offset Vector, found 2"));
}

TEST(DicomStack, TakesDetectorsAndSliceNumbersOfNuclearMedicine) {
  const TempFolder folder;
  DicomFields fields;
  fields.position.clear();
  fields.orientation.clear();
  const std::string place = element(0x20, 0x32, "DS", "1\\2\\3") + element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0");
  fields.more = element(0x18, 0x88, "DS", "4") + tag_list({0x54, 0x80}) + group(0x54, 0x22, place) +
                element(0x54, 0x80, "US", stored<std::uint16_t>({1, 3, 2}));
  const std::string content = stack(fields);
  const auto source = open_volume(folder.put("a", content));
  EXPECT_EQ(source->info().geometry.origin, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(source->info().geometry.spacing[2], 4);
  EXPECT_EQ(samples_of<std::uint16_t>(*source), in_order({0, 2, 1}));
  expect_flips_are_safe(folder, "a", content, content.size(), 1000);
}

TEST(DicomStack, RefusesFramesThatAreMoments) {
  const TempFolder folder;
  DicomFields fields;
  fields.more = tag_list({0x18, 0x1063}) + element(0x18, 0x1063, "DS", "33");
  EXPECT_TRUE(contains(refusal(folder.put("a", stack(fields))),
                       "expected frames that are slices, found frames that differ by Frame Time"));
  fields.more += element(0x18, 0x88, "DS", "1");
  EXPECT_EQ(open_volume(folder.put("a", stack(fields)))->info().dims[2], 3);
  fields.more = tag_list({0x54, 0x50, 0x54, 0x90}) + element(0x18, 0x88, "DS", "1");
  EXPECT_TRUE(contains(refusal(folder.put("a", stack(fields))), "found frames that differ by Rotation Vector"));
}

// Several doses in one series: a file that is named is one of them.
TEST(DicomStack, IsReadWithoutOthersInItsPlace) {
  const TempFolder folder;
  DicomFields fields;
  fields.thickness = "2";
  folder.put("a", stack(fields));
  folder.put("b", stack(fields, slice(2) + slice(3) + slice(4)));
  const auto source = open_volume(folder / "b");
  EXPECT_EQ(samples_of<std::uint16_t>(*source), in_order({2, 3, 4}));
  EXPECT_TRUE(
      contains(all_notes(source->info()), "1 file of the same series in the same place is left out: another volume"));
  EXPECT_TRUE(contains(refusal(folder / ""), "expected a position of its own for every slice"));
  // Where it lies elsewhere it is another part of the volume.
  fields.position = at(36);
  folder.put("a", stack(fields));
  EXPECT_EQ(open_volume(folder / "b")->info().dims[2], 6);
}

TEST(DicomStack, TakesGroupsThatAllFramesShare) {
  const TempFolder folder;
  DicomFields fields;
  fields.pixel_spacing.clear();
  const std::string measures = element(0x18, 0x88, "DS", "3") + element(0x28, 0x30, "DS", "0.5\\0.25");
  fields.more = element(0x5200, 0x9229, "SQ", item(group(0x28, 0x9110, measures)));
  const VolumeInfo info = open_volume(folder.put("a", stack(fields)))->info();
  EXPECT_EQ(info.geometry.spacing, (std::array<double, 3>{0.25, 0.5, 3}));
  EXPECT_EQ(info.dims[2], 3);
}

// The data set of a file without what is in front of it, and in implicit form.
std::string bare(const std::string& file) {
  return file.substr(file.find(element(8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.2")));
}

TEST(DicomBare, IsReadWithoutPreamble) {
  const TempFolder folder;
  put_series(folder);
  for (const char* name : {"s5", "s6", "s7"}) folder.put(name, bare(get(folder / name)));
  // The group of the file's form is there, and only the preamble is not.
  folder.put("s8", get(folder / "s8").substr(132));
  EXPECT_EQ(read_file<std::uint16_t>(folder / ""), kSamples);
  EXPECT_EQ(read_file<std::uint16_t>(folder / "s5"), kSamples);
  for (const auto syntax : {gdcm::TransferSyntax::ImplicitVRLittleEndian, gdcm::TransferSyntax::ExplicitVRBigEndian}) {
    const TempFolder one;
    one.put("w", dicom({}, slice(0)));
    ASSERT_TRUE(transcode(one / "w", one / "x", syntax));
    const std::string whole = get(one / "x");
    const std::string first = syntax == gdcm::TransferSyntax::ExplicitVRBigEndian ? std::string("\0\10\0\x16", 4)
                                                                                  : std::string("\10\0\x16\0", 4);
    const std::string content = whole.substr(whole.find(first));
    std::filesystem::remove(one / "w");
    std::filesystem::remove(one / "x");
    EXPECT_EQ(read_file<std::uint16_t>(one.put("a", content)), in_order({0}));
    expect_prefixes_are_safe(one, "a", content);
    expect_flips_are_safe(one, "a", content, content.size(), 1000);
  }
}

TEST(DicomBare, TellsItsFormWhereOnlyTheMagicIsThere) {
  const TempFolder folder;
  const std::string content = std::string(128, '\0') + "DICM" + bare(dicom({}, slice(0)));
  EXPECT_EQ(read_file<std::uint16_t>(folder.put("a", content)), in_order({0}));
}

TEST(DicomBare, IsNotSeenInOtherFiles) {
  const TempFolder folder;
  const std::string content = bare(dicom({}, slice(0)));
  EXPECT_TRUE(contains(refusal(folder.put("a", content.substr(0, 11))), "found other content"));
  // The same elements the other way round.
  const std::string second = element(8, 0x18, "UI", "1.9");
  std::string swapped = content;
  swapped.erase(swapped.find(second), second.size());
  EXPECT_TRUE(contains(refusal(folder.put("a", second + swapped)), "found other content"));
  EXPECT_TRUE(contains(refusal(folder.put("a", std::string("\10\0\5\0\4\0\0\0\1\2\3\4", 12) + std::string(500, '\1'))),
                       "found other content"));
  // Elements of group 8 in order, whose values are no texts.
  std::string binary;
  for (const char number : {'\5', '\10', '\26'})
    binary += std::string("\10\0", 2) + number + std::string("\0\4\0\0\0\1\2\3\4", 9);
  EXPECT_TRUE(contains(refusal(folder.put("a", binary + std::string(500, 'x'))), "found other content"));
}

TEST(DicomBare, IsNotPackedByGuess) {
  const TempFolder folder;
  const std::string packed = packed_image({}, "1.2.840.10008.1.2.5", run_lengths(slice(0)));
  EXPECT_EQ(read_file<std::uint16_t>(folder.put("a", packed)), in_order({0}));
  EXPECT_TRUE(contains(refusal(folder.put("a", bare(packed))), "expected plain samples"));
}

std::string dicomdir() {
  std::string file = dicom({}, "");
  const std::string image = element(2, 2, "UI", "1.2.840.10008.5.1.4.1.1.2");
  const std::string index = element(2, 2, "UI", "1.2.840.10008.1.3.10");
  file.replace(file.find(image), image.size(), index);
  const std::size_t rows = file.find(us(0x10, kRows));
  return file.replace(rows, us(0x10, 0).size(), us(0x10, 0));
}

// An export: an index and a picture on top, slices in folders of folders.
void put_export(const TempFolder& folder) {
  std::filesystem::create_directories(folder / "DICOM/IMG0/A");
  std::filesystem::create_directories(folder / "DICOM/IMG1");
  std::filesystem::create_directories(folder / ".hidden");
  put_series(folder);
  for (const char* name : {"s5", "s6", "s7"}) {
    std::filesystem::rename(folder / name, folder / ("DICOM/IMG0/A/" + std::string(name)));
  }
  for (const char* name : {"s8", "s9"}) {
    std::filesystem::rename(folder / name, folder / ("DICOM/IMG1/" + std::string(name)));
  }
  folder.put(".hidden/s1", "hello");
  // What the index lists is not looked at, and may be damaged.
  const std::string index = dicomdir();
  folder.put("DICOMDIR", index.substr(0, index.size() - 15));
  folder.put("logo.png", "\x89PNG\r\n\x1a\n and so on");
  folder.put("DICOM/IMG1/thumbnail.png", "no picture at all");
}

TEST(DicomExport, IsReadThroughAllItsFolders) {
  const TempFolder folder;
  put_export(folder);
  const auto source = open_volume(folder / "");
  EXPECT_EQ(samples_of<std::uint16_t>(*source), kSamples);
  EXPECT_TRUE(contains(all_notes(source->info()),
                       "2 files of the folder are no slices and are left out: logo.png, "
                       "thumbnail.png\n1 DICOM file holds no image"))
      << all_notes(source->info());
  EXPECT_EQ(read_file<std::uint16_t>(folder / "DICOMDIR"), kSamples);
  EXPECT_EQ(open_volume(folder / "DICOMDIR")->info().path, folder / "DICOMDIR");
  EXPECT_EQ(read_file<std::uint16_t>(folder / "DICOM"), kSamples);
  DicomFields other;
  other.series = "1.2.4";
  std::filesystem::create_directory(folder / "OTHER");
  folder.put("OTHER/a", dicom(other, slice(0)));
  EXPECT_TRUE(contains(refusal(folder / ""), "1.2.3 ('thin', 5 slices); 1.2.4 ('thin', 1 slice)"));
}

TEST(DicomExport, FollowsNoLinkTwice) {
  const TempFolder folder;
  put_export(folder);
  std::filesystem::create_directory_symlink(folder / "", folder / "DICOM/loop");
  std::filesystem::create_directory_symlink(folder / "DICOM/IMG0", folder / "again");
  std::filesystem::create_symlink(folder / "gone", folder / "DICOM/broken");
  EXPECT_EQ(read_file<std::uint16_t>(folder / ""), kSamples);
  std::string deep = "DICOM";
  for (int n = 0; n < 20; ++n) deep += "/d";
  std::filesystem::create_directories(folder / deep);
  EXPECT_TRUE(contains(refusal(folder / ""), "expected folders no deeper than 16, found '"));
}

TEST(DicomSamples, OfKindsThatAreNotReadAreNamed) {
  const TempFolder folder;
  const std::string good = dicom({}, std::string(4 * kSlice, 'x'));
  const std::string integers = element(0x7fe0, 0x10, "OW", "").substr(0, 4);
  const auto found = [&](std::uint16_t number) {
    std::string file = good;
    file.replace(file.rfind(integers), 4, bytes_of(std::uint16_t{0x7fe0}) + bytes_of(number));
    return refusal(folder.put("a.dcm", file));
  };
  EXPECT_TRUE(contains(found(8), "expected samples of whole numbers (Pixel Data), found Float Pixel Data, which"));
  EXPECT_TRUE(contains(found(9), "found Double Float Pixel Data, which is not read"));
  EXPECT_TRUE(contains(found(7), "expected samples of whole numbers (Pixel Data), found none"));
}

// Siemens writes all slices of a moment side by side in one image.
TEST(DicomMosaic, IsNoSlice) {
  const TempFolder folder;
  DicomFields fields;
  fields.thickness = "1";
  fields.more = element(8, 8, "CS", "ORIGINAL\\PRIMARY\\M\\ND\\MOSAIC");
  const std::string expected = "expected one slice in an image, found a mosaic of slices (Image Type)";
  EXPECT_TRUE(contains(refusal(folder.put("a", dicom(fields, slice(0)))), expected));
  folder.put("b", dicom(fields, slice(1)));
  EXPECT_TRUE(contains(refusal(folder / ""), expected));
  // The slices of a mosaic that was cut up lie in several places, and may still be called one.
  const TempFolder cut;
  put_series(cut, fields);
  EXPECT_EQ(read_file<std::uint16_t>(cut / ""), kSamples);
}

TEST(DicomSyntax, ThatIsNotReadIsNamed) {
  const TempFolder folder;
  const auto found = [&](const std::string& syntax) {
    return refusal(folder.put("a", packed_image({}, "1.2.840.10008.1.2.4." + syntax, "stream")));
  };
  EXPECT_TRUE(contains(found("201"), "JPEG 2000 or RLE samples, found '1.2.840.10008.1.2.4.201' (High-Throughput"));
  EXPECT_TRUE(contains(found("110"), "(JPEG XL)"));
  EXPECT_TRUE(contains(found("102"), "(MPEG or HEVC)"));
}

TEST(DicomSeries, WithoutUidIsChosenByAName) {
  const TempFolder folder;
  DicomFields fields;
  fields.series.clear();
  put_series(folder, fields);
  fields.series = "1.2.4";
  folder.put("other", dicom(fields, slice(3)));
  EXPECT_TRUE(contains(refusal(folder / ""), "found 2 series: none ('thin', 5 slices); 1.2.4 ('thin', 1 slice)"));
  OpenOptions options;
  options.series = "none";
  EXPECT_EQ(read_file<std::uint16_t>(folder / "", options), kSamples);
  EXPECT_EQ(read_file<std::uint16_t>(folder / "s7", options), kSamples);
  EXPECT_TRUE(contains(refusal(folder / "other", options), "expected the series 'none', found '1.2.4'"));
}

TEST(DicomBits, AboveThoseThatAreStoredAreNoted) {
  const TempFolder folder;
  const auto notes_on = [&](int is_signed, int high, std::uint16_t sample) {
    DicomFields fields;
    fields.is_signed = is_signed;
    fields.thickness = "1";
    fields.more = us(0x101, high + 1) + us(0x102, high);
    std::vector<std::uint16_t> samples(kSlice, 1);
    samples[kSlice / 2] = sample;
    return all_notes(open_volume(folder.put("a", dicom(fields, stored(samples))))->info());
  };
  EXPECT_EQ(notes_on(0, 11, 0x0fff), "");
  EXPECT_TRUE(contains(notes_on(0, 11, 0x1fff), "samples have bits above the 12 that are said to be stored"));
  // As many signs as there is room for, or none, are two ways to write the same number.
  EXPECT_EQ(notes_on(1, 11, 0xffff), "");
  EXPECT_EQ(notes_on(1, 11, 0x0fff), "");
  EXPECT_TRUE(contains(notes_on(1, 11, 0x1001), "samples have bits above"));
  EXPECT_EQ(notes_on(0, 15, 0xffff), "");
}

}  // namespace
}  // namespace isoweave::testing::volume_dicom_forms_test
