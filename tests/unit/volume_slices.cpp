// Series of one file per slice: how files are found and ordered, and what a series must have in common.
#include "tiff_helpers.hpp"
#include "volume/slice_files.hpp"

namespace isoweave::testing {
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
  EXPECT_EQ(source->info().notes.at(0),
            "5 files of the folder are no slices and are left out: a?.txt, b.txt, c.txt, ...");
  EXPECT_TRUE(
      contains(refusal(folder / "*.t*"), "a?.txt: expected a slice in TIFF, PNG or DICOM, found other content"));
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

}  // namespace
}  // namespace isoweave::testing
