// Series of one file per slice: how files are found and ordered, and what a series must have in common.
#include "index_helpers.hpp"
#include "tiff_helpers.hpp"
#include "volume/formats/images/slice_files.hpp"
#include "volume/formats/images/slice_numbers.hpp"

namespace isoweave::testing::volume_slices_test {
namespace {

const std::vector<std::uint16_t> kSamples = ramp<std::uint16_t>(5 * 4 * 12);

std::string slice(std::size_t n) { return stored(kSamples).substr(40 * n, 40); }

// Slices z0.tif to z11.tif, whose alphabetic order is not that of their numbers.
void put_series(const TempFolder& folder, const TiffPage& page = {}) {
  for (std::size_t n = 0; n < 12; ++n) write_stack(folder / ("z" + std::to_string(n) + ".tif"), page, slice(n));
}

TEST(SliceFiles, OrdersRunsOfDigitsAsNumbers) {
  for (const auto& [before, after] :
       std::vector<std::pair<std::string, std::string>>{{"z9", "z10"},
                                                        {"z09", "z10"},
                                                        {"z1", "z01a"},
                                                        {"a", "b"},
                                                        {"z", "z0"},
                                                        {"z01", "z1"},
                                                        {"1_9", "1_10"},
                                                        {"a99999999999999999999999", "a100000000000000000000000"},
                                                        {"z1.tif", "z1a.tif"}}) {
    EXPECT_TRUE(natural_less(before, after)) << before << " " << after;
    EXPECT_FALSE(natural_less(after, before)) << before << " " << after;
  }
  EXPECT_FALSE(natural_less("z1", "z1"));
}

std::string notes_on(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& note : notes_on_numbers(names)) text += note + "\n";
  return text;
}

TEST(SliceNumbers, ThatAreLeftOutAreNoted) {
  EXPECT_EQ(notes_on({"d/z06.tif", "d/z07.tif", "d/z10.tif", "d/z11.tif"}),
            "2 slices seem to be missing by the numbers of the files: between 'z07.tif' and 'z10.tif'\n");
  EXPECT_EQ(notes_on({"1.png", "2.png", "4.png", "5.png", "6.png", "8.png", "9.png"}),
            "2 slices seem to be missing by the numbers of the files: between '2.png' and '4.png', between '6.png' and "
            "'8.png'\n");
  EXPECT_EQ(notes_on({"s.001", "s.002", "s.003", "s.005"}),
            "1 slice seems to be missing by the numbers of the files: between 's.003' and 's.005'\n");
  EXPECT_EQ(notes_on({"z00.tif", "z02.tif", "z04.tif", "z08.tif"}),
            "1 slice seems to be missing by the numbers of the files: between 'z04.tif' and 'z08.tif'; the numbers are "
            "usually 2 apart\n");
  EXPECT_TRUE(contains(notes_on({"1", "2", "4", "5", "6", "8", "9", "10", "12", "13", "14", "15", "17", "18", "19"}),
                       "4 slices seem to be missing by the numbers of the files: between '2' and '4', between '6' and "
                       "'8', between '10' and '12', and 1 more gaps"));
}

TEST(SliceNumbers, ThatFollowOneAnotherAreNot) {
  for (const std::vector<std::string>& names : std::vector<std::vector<std::string>>{
           {"z1.tif", "z2.tif", "z3.tif"},
           {"z0.tif", "z2.tif", "z4.tif", "z6.tif"},
           {"z5.tif", "z9.tif"},
           {"z7.tif"},
           {"a.tif", "b.tif", "d.tif", "e.tif"},
           {"mask.tif", "z1.tif", "z2.tif", "z3.tif"},
           // Taken at uneven times, and counted.
           {"20240102_1201_001.tif", "20240102_1203_002.tif", "20240102_1204_003.tif", "20240102_1205_004.tif"},
           {"s1_20240102_1201.tif", "s2_20240102_1203.tif", "s3_20240102_1204.tif", "s4_20240102_1205.tif"},
           {"z1_ch1.tif", "z1_ch2.tif", "z2_ch1.tif", "z2_ch2.tif", "z3_ch1.tif", "z3_ch2.tif"},
           {"z0.50.tif", "z1.00.tif", "z1.50.tif", "z2.00.tif", "z2.50.tif", "z3.00.tif"},
           {"17.tif", "94.tif", "180.tif", "2222.tif"},
           {"99999999999999999999.tif", "199999999999999999999.tif", "999999999999999999999999.tif"}}) {
    EXPECT_EQ(notes_on(names), "") << names.front();
  }
}

TEST(SliceNumbers, ThatOccurTwiceAreNoted) {
  EXPECT_EQ(notes_on({"z1.tif", "z01.tif", "z2.tif", "z3.tif"}),
            "'z1.tif' and 'z01.tif' have the same number, and both are taken as slices\n");
  EXPECT_EQ(notes_on({"z1.tif", "z1.tiff", "z2.tif", "z2.tiff", "z3.tif", "z3.tiff"}),
            "3 files have the number of another, as 'z1.tif' and 'z1.tiff' have, and all are taken as slices\n");
}

TEST(SliceSeries, NotesAGapInItsNumbers) {
  const TempFolder folder;
  put_series(folder);
  EXPECT_FALSE(contains(open_volume(folder / "")->info().notes.back(), "missing"));
  for (const char* name : {"z8.tif", "z9.tif"}) std::filesystem::remove(folder / name);
  for (const std::string path : {"", "z*.tif"}) {
    EXPECT_EQ(open_volume(folder / path)->info().notes.back(),
              "2 slices seem to be missing by the numbers of the files: between 'z7.tif' and 'z10.tif'");
  }
}

TEST(SliceSeries, IsReadFromAFolderOrAPattern) {
  const TempFolder folder;
  put_series(folder);
  const auto source = open_volume(folder / "");
  EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{5, 4, 12}));
  EXPECT_EQ(source->info().format, "tiff");
  EXPECT_EQ(source->info().path, folder / "");
  EXPECT_EQ(samples_of<std::uint16_t>(*source, 5), kSamples);
  EXPECT_EQ(read_file<std::uint16_t>(folder / "z*.tif"), kSamples);
  EXPECT_EQ(read_file<std::uint16_t>(folder / "z[0-2].tif"),
            std::vector<std::uint16_t>(kSamples.begin(), kSamples.begin() + 60));
  EXPECT_EQ(open_volume(folder / "z3.tif")->info().dims[2], 1);
  EXPECT_TRUE(contains(refusal(folder / "gone/z*.tif"), "expected files that match the pattern, found none"));
  EXPECT_TRUE(contains(refusal(folder / "y*.tif"), "expected files that match the pattern, found none"));
}

TEST(SliceSeries, LinksOutOfTheFolderAreRefusedWhereTheyAreNotTrusted) {
  const TempFolder folder;
  std::filesystem::create_directory(folder / "a");
  write_stack(folder / "a/z0.tif", {}, slice(0));
  write_stack(folder / "secret.tif", {}, slice(1));
  std::filesystem::create_symlink("../secret.tif", folder / "a/z1.tif");
  OpenOptions options;
  options.external = false;
  for (const std::string path : {"a", "a/z*.tif"}) {
    EXPECT_EQ(open_volume(folder / path)->info().dims[2], 2);
    EXPECT_TRUE(contains(refusal(folder / path, options), "a/z1.tif: expected a file inside '" + folder / "a")) << path;
  }
  // A file is not opened to see what it is.
  std::filesystem::remove(folder / "a/z1.tif");
  folder.put("secret", "text");
  std::filesystem::create_symlink("../secret", folder / "a/z1.tif");
  EXPECT_TRUE(contains(refusal(folder / "a", options), "a link that leads out of it"));
}

TEST(SliceSeries, SkipsSlices) {
  const TempFolder folder;
  put_series(folder);
  const auto source = open_volume(folder / "");
  std::vector<std::uint16_t> slices(20);
  for (const std::int64_t n : {1, 4, 11}) {
    source->read(n, 1, std::as_writable_bytes(std::span(slices)));
    EXPECT_TRUE(std::equal(slices.begin(), slices.end(), kSamples.begin() + 20 * n)) << n;
  }
}

TEST(SliceSeries, PrefersAFileOfThePatternsOwnName) {
  const TempFolder folder;
  put_series(folder);
  write_stack(folder / "z[1].tif", {}, slice(5));
  EXPECT_EQ(open_volume(folder / "z[1].tif")->info().dims[2], 1);
  EXPECT_EQ(read_file<std::uint16_t>(folder / "z[1].tif")[0], kSamples[100]);
}

TEST(SliceSeries, LeavesOtherFilesOfAFolderOutButNotOfAPattern) {
  const TempFolder folder;
  put_series(folder);
  for (const char* name : {"a\n.txt", "b.txt", "c.txt", "d.txt"}) folder.put(name, "hello");
  folder.put(".hidden.tif", "hello");
  folder.put("empty", "");
  std::filesystem::create_directory(folder / "more.tif");
  const auto source = open_volume(folder / "");
  EXPECT_EQ(source->info().dims[2], 12);
  EXPECT_EQ(source->info().remarks.at(0),
            "4 files of the folder are no slices and are left out: a?.txt, b.txt, c.txt, ...");
  EXPECT_EQ(source->info().notes.at(0), "1 file of the folder is no slice and is left out: empty");
  EXPECT_TRUE(contains(refusal(folder / "*.t*"), "a?.txt: expected a slice in TIFF, PNG or DICOM, found text"));
}

// Files that might have been slices are told apart from those that are usual beside slices.
TEST(SliceSeries, TellsUsualFilesFromThoseThatMightBeSlices) {
  const TempFolder folder;
  put_series(folder);
  for (const char* name : {"README", "Thumbs.db", "info.json", "z13.jpg", "z14.tif.part", "z15"})
    folder.put(name, "hello");
  const auto source = open_volume(folder / "");
  EXPECT_EQ(
      source->info().remarks,
      std::vector<std::string>{"3 files of the folder are no slices and are left out: README, Thumbs.db, info.json"});
  EXPECT_EQ(source->info().notes.at(0),
            "3 files of the folder are no slices and are left out: z13.jpg, z14.tif.part, z15");
}

TEST(SliceSeries, RefusesFoldersWithoutSlices) {
  const TempFolder folder;
  EXPECT_TRUE(contains(refusal(folder / ""), "expected slices in TIFF, PNG or DICOM, found a directory without any"));
  folder.put("a.txt", "hello");
  EXPECT_TRUE(contains(refusal(folder / ""), "a directory without any"));
}

TEST(SliceSeries, RefusesSlicesThatWereLost) {
  const TempFolder folder;
  put_series(folder);
  folder.put("z3.tif", "");
  EXPECT_TRUE(contains(refusal(folder / ""), "z3.tif: expected a volume file, found an empty file"));
  folder.put("z3.tif", "hello");
  EXPECT_TRUE(contains(refusal(folder / ""), "z3.tif: expected content of TIFF, found other content"));
  const std::string whole = get(write_stack(folder / "z3.tif", {}, slice(3)));
  folder.put("z3.tif", whole.substr(0, 40));
  EXPECT_TRUE(contains(refusal(folder / ""), "z3.tif: expected"));
}

TEST(SliceSeries, NamesAFileThatVanishesWhileItIsRead) {
  const TempFolder folder;
  put_series(folder);
  const auto source = open_volume(folder / "");
  std::filesystem::remove(folder / "z7.tif");
  try {
    read_all(*source);
    FAIL() << "nothing was thrown";
  } catch (const BadInput& error) {
    EXPECT_TRUE(contains(error.what(), "z7.tif: cannot be opened")) << error.what();
  }
}

TEST(SliceSeries, RefusesSlicesThatDiffer) {
  const TempFolder folder;
  put_series(folder);
  write_stack(folder / "z3.tif", {5, 5}, std::string(50, 'x'));
  const std::string size = refusal(folder / "");
  EXPECT_TRUE(contains(size, "z3.tif: expected 5 x 4 uint16 as in '")) << size;
  EXPECT_TRUE(contains(size, "found 5 x 5 uint16")) << size;
  TiffPage other;
  other.format = SAMPLEFORMAT_INT;
  write_stack(folder / "z3.tif", other, slice(3));
  EXPECT_TRUE(contains(refusal(folder / ""), "found 5 x 4 int16"));
  write_stack(folder / "z3.tif", {}, slice(3) + slice(4));
  EXPECT_TRUE(contains(refusal(folder / ""), "z3.tif: expected one page in each file of a series, found 2"));
  folder.put("z3.tif", "\x89PNG\r\n\x1a\n and so on");
  EXPECT_TRUE(contains(refusal(folder / ""), "z3.tif: expected content of TIFF"));
  std::filesystem::rename(folder / "z3.tif", folder / "z3");
  EXPECT_TRUE(contains(refusal(folder / ""), "z3: expected TIFF as '"));
}

TEST(SliceSeries, ReadsAnOmeSeriesOfOneChannel) {
  const TempFolder folder;
  TiffPage page;
  const std::string pixels = "<OME><Pixels DimensionOrder=\"XYZCT\" SizeZ=\"12\" PhysicalSizeZ=\"2\" SizeT=\"1\" ";
  page.description = pixels + "SizeC=\"1\"/></OME>";
  put_series(folder, page);
  EXPECT_EQ(read_file<std::uint16_t>(folder / ""), kSamples);
  EXPECT_EQ(open_volume(folder / "")->info().geometry.spacing[2], 2);
  page.description = pixels + "SizeC=\"2\"/></OME>";
  put_series(folder, page);
  EXPECT_TRUE(contains(refusal(folder / ""), "one channel and one frame"));
}

TEST(Tiff, TilesThatTheSurfaceMissesAreNotDecoded) {
  const TempFolder folder;
  for (const std::uint32_t tile : {0U, 16U}) {
    TiffPage page;
    page.width = 70, page.height = 50, page.tile = tile, page.rows_per_strip = 10;
    page.compression = COMPRESSION_LZW;
    std::vector<std::uint16_t> samples;
    for (int n = 0; n < 70 * 50 * 40; ++n) samples.push_back(static_cast<std::uint16_t>(n / 70 % 50 + n / 3500));
    const std::string path = write_stack(folder / ("a" + std::to_string(tile) + ".tif"), page, stored(samples));
    const MeshReport report = expect_same_with_index(path, 20.5);
    EXPECT_GT(report.left_out->chunks_left_out, report.left_out->chunks / 8);
    EXPECT_LT(report.left_out->chunks_left_out, report.left_out->chunks);
  }
}

}  // namespace
}  // namespace isoweave::testing::volume_slices_test
