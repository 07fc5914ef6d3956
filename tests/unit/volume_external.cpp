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

}  // namespace
}  // namespace isoweave::testing::volume_external_test
