// Headers that name other files, where they may not.
#include <gtest/gtest.h>

#include "volume_helpers.hpp"

namespace isoweave::testing::volume_external_test {
namespace {

const std::string kBytes = stored(ramp<std::uint8_t>(2 * 2 * 2));

std::string nrrd_header(const std::string& more) {
  return "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n" + more + "\n";
}

std::string meta_header(const std::string& data) {
  return "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = " + data + "\n";
}

void expect_refused(const std::string& path) {
  SCOPED_TRACE(path);
  EXPECT_EQ(read_all(*open_volume(path)).size(), 8U);
  OpenOptions options;
  options.external = false;
  try {
    open_volume(path, options);
    FAIL() << "opened";
  } catch (const BadInput& error) {
    const std::string text = error.what();
    EXPECT_TRUE(text.starts_with(path)) << text;
    EXPECT_NE(text.find("--no-external"), std::string::npos) << text;
  }
}

void expect_read(const std::string& path, std::size_t bytes = 8) {
  OpenOptions options;
  options.external = false;
  EXPECT_EQ(read_all(*open_volume(path, options)).size(), bytes) << path;
}

TEST(External, TextHeadersThatNameFilesAreRefusedWhereTheyMayNot) {
  const TempFolder folder;
  folder.put("all.raw", kBytes);
  folder.put("s1.raw", kBytes.substr(0, 4));
  folder.put("s2.raw", kBytes.substr(4));
  expect_refused(folder.put("one.nhdr", nrrd_header("data file: all.raw\n")));
  expect_refused(folder.put("absolute.nhdr", nrrd_header("datafile: " + folder / "all.raw" + "\n")));
  expect_refused(folder.put("list.nhdr", nrrd_header("data file: LIST\ns1.raw\ns2.raw")));
  expect_refused(folder.put("pattern.nhdr", nrrd_header("data file: s%d.raw 1 2 1\n")));
  expect_refused(folder.put("one.mhd", meta_header("all.raw")));
  expect_refused(folder.put("list.mhd", meta_header("LIST\ns1.raw\ns2.raw")));
  expect_refused(folder.put("pattern.mhd", meta_header("s%d.raw 1 2 1")));
  expect_read(folder.put("whole.nrrd", nrrd_header("") + kBytes));
  expect_read(folder.put("whole.mha", meta_header("LOCAL") + kBytes));
}

TEST(External, PairsOfNiftiAreRefusedFromBothSides) {
  const TempFolder folder;
  NiftiFields fields;
  fields.dim = {3, 2, 2, 1, 1, 1, 1, 1};
  const std::string bytes = stored(ramp<std::int16_t>(4));
  expect_read(folder.put("whole.nii", nifti_header(fields) + bytes));
  fields.pair = true;
  folder.put("a.img", bytes);
  expect_refused(folder.put("a.hdr", nifti_header(fields)));
  OpenOptions options;
  options.external = false;
  EXPECT_THROW(open_volume(folder / "a.img", options), BadInput);
}

OpenOptions strangers(int slices) {
  OpenOptions options;
  options.raw = RawLayout{{2, 2, slices}, SampleType::kUint8};
  options.external = false;
  return options;
}

void expect_link_refused(const std::string& path, const std::string& file, const std::string& inside) {
  OpenOptions options = strangers(2);
  EXPECT_EQ(refusal(path, options), file + ": expected a file inside '" + inside +
                                        "', as --no-external asks, found a link that leads out of it");
  options.external = true;
  EXPECT_EQ(read_all(*open_volume(path, options)).size(), 8U) << path;
}

TEST(External, LinksOutOfRawSlicesAreRefusedInFoldersAndPatterns) {
  const TempFolder folder;
  std::filesystem::create_directories(folder / "a/below");
  folder.put("a/z1.raw", kBytes.substr(0, 4));
  folder.put("secret.raw", kBytes.substr(4));
  std::filesystem::create_symlink("../secret.raw", folder / "a/z2.raw");
  expect_link_refused(folder / "a", folder / "a/z2.raw", folder / "a");
  expect_link_refused(folder / "a/z*.raw", folder / "a/z2.raw", folder / "a");
  expect_link_refused(folder / "[a]/z?.raw", folder / "a/z2.raw", folder / "a");
  // A link inside the folder is followed.
  std::filesystem::rename(folder / "secret.raw", folder / "a/below/z3");
  std::filesystem::remove(folder / "a/z2.raw");
  std::filesystem::create_symlink("below/z3", folder / "a/z2.raw");
  for (const std::string path : {"a", "a/z*.raw"}) {
    EXPECT_EQ(read_all(*open_volume(folder / path, strangers(2))).size(), 8U) << path;
  }
  // A link to a folder that the pattern names by itself is the user's own.
  std::filesystem::create_directory_symlink(folder / "a", folder / "own");
  EXPECT_EQ(read_all(*open_volume(folder / "own/z*.raw", strangers(2))).size(), 8U);
}

TEST(External, FoldersThatAPatternMatchesAreNoWayOut) {
  const TempFolder folder;
  std::filesystem::create_directories(folder / "b/one");
  std::filesystem::create_directories(folder / "away");
  folder.put("b/one/z.raw", kBytes.substr(0, 4));
  folder.put("away/z.raw", kBytes.substr(4));
  std::filesystem::create_directory_symlink("../away", folder / "b/two");
  expect_link_refused(folder / "b/*/z.raw", folder / "b/two/z.raw", folder / "b");
}

}  // namespace
}  // namespace isoweave::testing::volume_external_test
