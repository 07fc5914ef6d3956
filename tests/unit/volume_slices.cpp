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

// Of `count` planes along z, with what stands in Pixels.
std::string ome(std::size_t count, const std::string& inside, const std::string& uuid = "") {
  return "<?xml version=\"1.0\"?><!-- <Pixels> of a comment --><OME" + (uuid.empty() ? "" : " UUID=\"" + uuid + "\"") +
         "><Image Name=\"a > b\"><Pixels DimensionOrder=\"XYZCT\" SizeZ=\"" + std::to_string(count) +
         "\" SizeC=\"1\" SizeT=\"1\">" + inside + "</Pixels></Image></OME>";
}

std::string tiff_data(std::size_t page, std::size_t plane, const std::string& more = "") {
  return "<TiffData IFD=\"" + std::to_string(page) + "\" FirstZ=\"" + std::to_string(plane) + "\" " + more;
}

std::string in_file(const std::string& name, const std::string& uuid = "") {
  return "><UUID FileName=\"" + name + "\">" + uuid + "</UUID></TiffData>";
}

std::string put_stack(const TempFolder& folder, const std::string& description, const std::string& name = "a.tif") {
  TiffPage page;
  page.description = description;
  return write_stack(folder / name, page, slice(0) + slice(1) + slice(2) + slice(3));
}

// The first samples of slices tell which pages they are.
std::vector<std::size_t> pages_in(const std::string& path, const OpenOptions& options = {}) {
  const auto samples = read_file<std::uint16_t>(path, options);
  std::vector<std::size_t> pages;
  for (std::size_t at = 0; at < samples.size(); at += 20) {
    const auto found = std::find(kSamples.begin(), kSamples.end(), samples[at]);
    pages.push_back(static_cast<std::size_t>(found - kSamples.begin()) / 20);
  }
  return pages;
}

using Pages = std::vector<std::size_t>;

TEST(OmeTiff, PagesAreThePlanesThatTiffDataSays) {
  const TempFolder folder;
  std::string backwards, named;
  for (std::size_t n = 0; n < 4; ++n) backwards += tiff_data(n, 3 - n, "PlaneCount=\"1\"/>");
  for (std::size_t n = 0; n < 4; ++n) named += tiff_data(n, 3 - n) + in_file("other name.tif", "urn:uuid:1");
  const auto pages = [&](const std::string& inside) { return pages_in(put_stack(folder, ome(4, inside))); };
  EXPECT_EQ(pages(backwards), (Pages{3, 2, 1, 0}));
  EXPECT_TRUE(contains(open_volume(folder / "a.tif")->info().notes.front(), "TiffData"));
  EXPECT_EQ(pages(named), (Pages{3, 2, 1, 0})) << "a file that was renamed";
  EXPECT_EQ(pages("<TiffData IFD=\"2\" PlaneCount=\"2\"/><TiffData FirstZ=\"2\" PlaneCount=\"2\"/>"),
            (Pages{2, 3, 0, 1}));
  // A number of planes that is not given reaches to the next plane that is described.
  EXPECT_EQ(pages("<TiffData IFD=\"2\"/><TiffData FirstZ=\"2\"/>"), (Pages{2, 3, 0, 1}));
  for (const std::string plain : {"", "<TiffData/>", "<TiffData></TiffData>", "<TiffData IFD='0'/>"}) {
    EXPECT_EQ(pages(plain), (Pages{0, 1, 2, 3})) << plain;
  }
  EXPECT_TRUE(open_volume(folder / "a.tif")->info().notes.size() == 3) << "spacings alone";
}

TEST(OmeTiff, PlanesOfChannelsAreCountedInTheirOrder) {
  const TempFolder folder;
  const std::string text =
      "<OME><Image><Pixels DimensionOrder=\"XYCZT\" SizeZ=\"2\" SizeC=\"2\" SizeT=\"1\"><TiffData IFD=\"0\" "
      "FirstC=\"1\" "
      "FirstZ=\"1\"/><TiffData IFD=\"1\" FirstC=\"0\" FirstZ=\"1\"/><TiffData IFD=\"2\" FirstC=\"1\"/><TiffData "
      "IFD=\"3\"/></Pixels></Image></OME>";
  OpenOptions options;
  for (const std::int64_t channel : {0, 1}) {
    options.channel = channel;
    EXPECT_EQ(pages_in(put_stack(folder, text), options), channel == 0 ? (Pages{3, 1}) : (Pages{2, 0}));
  }
}

// Directories that are left out count as well.
TEST(OmeTiff, PagesAreCountedWithSmallerCopies) {
  const TempFolder folder;
  TIFF* tiff = TIFFOpen((folder / "a.tif").c_str(), "w");
  TiffPage page, copy{2, 2};
  page.description = ome(2, tiff_data(2, 0, "/>") + tiff_data(0, 1, "/>"));
  copy.subfile = FILETYPE_REDUCEDIMAGE;
  write_page(tiff, page, slice(0));
  write_page(tiff, copy, std::string(8, 'x'));
  write_page(tiff, {}, slice(1));
  TIFFClose(tiff);
  EXPECT_EQ(pages_in(folder / "a.tif"), (Pages{1, 0}));
}

TEST(OmeTiff, RefusesTiffDataThatIsNoOrder) {
  const TempFolder folder;
  const std::vector<std::pair<std::string, std::string>> refused{
      {"<TiffData FirstZ=\"1\" PlaneCount=\"3\"/>", "expected a page for plane 0 in TiffData, found none"},
      {"<TiffData PlaneCount=\"1\"/><TiffData FirstZ=\"1\"/>",
       "a page for each plane in TiffData, found IFD 0 for two"},
      {"<TiffData IFD=\"1\"/>", "a page for plane 3 in TiffData, found IFD 4, which is none of the slices"},
      {"<TiffData PlaneCount=\"5\"/>", "expected 4 planes in TiffData, found more"},
      {"<TiffData/><TiffData/>", "expected one page for each plane in TiffData, found two for plane 0"},
      {"<TiffData FirstZ=\"4\"/>", "expected FirstZ below 4, found 4"},
      {"<TiffData IFD=\"-1\"/>", "expected a number of at least 0 as IFD of TiffData, found '-1'"},
      {tiff_data(0, 0) + in_file("a.tif") + tiff_data(0, 1) + in_file("b.tif"),
       "expected all planes in this file, found some in files that its description names"}};
  for (const auto& [inside, message] : refused) {
    const std::string path = put_stack(folder, ome(4, inside));
    EXPECT_TRUE(contains(refusal(path), message)) << inside << refusal(path);
  }
}

TEST(OmeTiff, SeveralImagesAreRefusedUnlessOneAloneIsInTheFile) {
  const TempFolder folder;
  const auto image = [](const std::string& inside) {
    return "<Image><Pixels DimensionOrder=\"XYZCT\" SizeZ=\"4\" SizeC=\"1\" SizeT=\"1\" PhysicalSizeZ=\"" +
           std::to_string(inside.size()) + "\">" + inside + "</Pixels></Image>";
  };
  const std::string both = "<OME>" + image("<TiffData/>") + image("<TiffData IFD=\"4\"/>") + "</OME>";
  EXPECT_EQ(refusal(put_stack(folder, both)),
            folder /
                "a.tif: expected one image in its OME description, found 2 (each can be read from a file of its "
                "own, which bfconvert -series N writes)");
  const std::string first = "<TiffData" + in_file("b.tif"), second = "<TiffData " + in_file("a.tif");
  const std::string path = put_stack(folder, "<OME>" + image(first) + image(second) + "</OME>");
  EXPECT_EQ(open_volume(path)->info().geometry.spacing[2], static_cast<double>(second.size()));
}

TEST(OmeTiff, FilesThatAreElsewhereAreTold) {
  const TempFolder folder;
  std::string seven;
  for (std::size_t n = 0; n < 7; ++n) seven += tiff_data(0, n) + in_file("z" + std::to_string(n) + ".tif");
  EXPECT_TRUE(contains(refusal(put_stack(folder, ome(7, seven))),
                       "expected 7 pages by its description, found 4 (the others are in the files that it names)"));
  const std::string strange = tiff_data(0, 0) + in_file("z0.tif") + tiff_data(0, 1) + in_file("z1.tif");
  EXPECT_TRUE(contains(open_volume(put_stack(folder, ome(4, strange)))->info().notes.front(),
                       "the files that its description names are others"));
}

// Writes z0.tif to z3.tif; `text` gives the description of the n-th.
template <class Text>
void put_ome_series(const TempFolder& folder, const Text& text) {
  for (std::size_t n = 0; n < 4; ++n) {
    TiffPage page;
    page.description = text(n);
    write_stack(folder / ("z" + std::to_string(n) + ".tif"), page, slice(n));
  }
}

TEST(OmeSeries, FilesAreInTheOrderOfTheirPlanes) {
  const TempFolder folder;
  const auto note = [&] { return contains(open_volume(folder / "")->info().notes.back(), "FirstZ"); };
  std::string backwards, identified;
  for (std::size_t n = 0; n < 4; ++n) backwards += tiff_data(0, 3 - n) + in_file("z" + std::to_string(n) + ".tif");
  put_ome_series(folder, [&](std::size_t) { return ome(4, backwards); });
  EXPECT_EQ(pages_in(folder / ""), (Pages{3, 2, 1, 0}));
  EXPECT_EQ(pages_in(folder / "z*.tif"), (Pages{3, 2, 1, 0}));
  EXPECT_TRUE(note());
  // Identifiers count before names, as files may have been renamed.
  const auto uuid = [](std::size_t n) { return "urn:uuid:" + std::to_string(n); };
  for (std::size_t n = 0; n < 4; ++n) identified += tiff_data(0, n ^ 1) + in_file("z0.tif", uuid(n));
  put_ome_series(folder, [&](std::size_t n) { return ome(4, identified, uuid(n)); });
  EXPECT_EQ(pages_in(folder / ""), (Pages{1, 0, 3, 2}));
  put_ome_series(folder, [](std::size_t n) { return ome(4, tiff_data(0, n, "/>")); });
  EXPECT_EQ(pages_in(folder / ""), (Pages{0, 1, 2, 3}));
  EXPECT_FALSE(note());
  put_ome_series(folder, [](std::size_t) { return ome(4, "<TiffData/>"); });
  EXPECT_EQ(pages_in(folder / ""), (Pages{0, 1, 2, 3})) << "descriptions that say nothing of a file";
}

TEST(OmeSeries, PlanesThatAreMissingOrOccurTwiceAreTold) {
  const TempFolder folder;
  put_ome_series(folder, [](std::size_t n) { return ome(9, tiff_data(0, 2 * n, "/>")); });
  EXPECT_EQ(open_volume(folder / "")->info().notes.back(),
            "3 slices seem to be missing by the planes in the descriptions (FirstZ)");
  put_ome_series(folder, [](std::size_t n) { return ome(4, tiff_data(0, n / 2, "/>")); });
  EXPECT_EQ(refusal(folder / ""), folder / "z1.tif: expected a plane of its own (FirstZ) in the description of each "
                                           "file, found that of '" +
                                      folder / "z0.tif'");
  put_ome_series(folder, [](std::size_t n) { return n == 1 ? "" : ome(4, tiff_data(0, 3 - n, "/>")); });
  EXPECT_TRUE(contains(refusal(folder / ""), "z1.tif: expected a plane of its own (FirstZ)"));
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
