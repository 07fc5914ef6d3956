#include "vti_helpers.hpp"

namespace isoweave::testing::volume_vtk_test {
namespace {

using namespace vti_files;

TEST(Vti, ReadsEveryEncoding) {
  const TempFolder folder;
  for (const bool big : {false, true}) {
    for (const bool wide : {false, true}) {
      // Blocks that divide the array, that do not, and one larger than it.
      for (const std::size_t block : {0U, 24U, 50U, 4096U}) {
        for (const auto& [appended, text] : {std::pair(false, true), std::pair(true, true), std::pair(true, false)}) {
          const VtiForm form{big, wide, block, appended, text};
          const auto source = open_volume(folder.put("a.vti", whole(form)));
          EXPECT_EQ(source->info().format, "vti");
          EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{4, 3, 5}));
          EXPECT_EQ(samples_of<std::int16_t>(*source), kSamples) << big << wide << block << appended << text;
        }
      }
    }
  }
}

#ifdef ISOWEAVE_HAS_LZ4
TEST(Vti, ReadsLz4Blocks) {
  const TempFolder folder;
  VtiForm form;
  form.lz4 = true;
  for (const std::size_t block : {6U, 50U, 4096U}) {
    form.block = block;
    EXPECT_EQ(read_file<std::int16_t>(folder.put("a.vti", whole(form))), kSamples) << block;
  }
  const auto array = [&](std::uint32_t size, std::uint32_t stored, const std::string& block) {
    const std::string sizes = bytes_of(1U) + bytes_of(size) + bytes_of(0U) + bytes_of(stored);
    return vti(form, base64(sizes) + base64(block));
  };
  // Twenty sevens: one as it is, six copies of what stands one byte before, thirteen as they are.
  const std::string sevens = std::string("\x12\7\1\0\xd0", 5) + std::string(13, '\7');
  form.attributes = "type=\"UInt8\" Name=\"a\"";
  form.extent = "0 19 0 0 0 0";
  form.place = "WholeExtent=\"" + form.extent + "\"";
  EXPECT_EQ(read_file<std::uint8_t>(folder.put("a.vti", array(20, 18, sevens))), std::vector<std::uint8_t>(20, 7));
  EXPECT_TRUE(contains(refusal(folder.put("a.vti", array(20, 17, sevens))), "LZ4 blocks of 20 bytes, found damaged"));
  EXPECT_TRUE(contains(refusal(folder.put("a.vti", array(20, 5000, sevens))), "5000 bytes in block 0"));
  form.extent = "0 9999 0 0 0 0";
  form.place = "WholeExtent=\"" + form.extent + "\"";
  EXPECT_TRUE(contains(refusal(folder.put("a.vti", array(10000, 18, sevens))), "which cannot hold them"));
}
#endif

TEST(Vti, ReadsNumbersInText) {
  const TempFolder folder;
  const auto read = [&]<class Sample>(const std::string& type, const std::vector<Sample>& samples) {
    std::string text = "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 0 0 1\"><Piece><PointData>";
    text += "<DataArray type=\"" + type + "\" format=\"ascii\">";
    for (const Sample sample : samples) text += "\n " + std::to_string(sample);
    const std::string path = folder.put("a.vti", text + "\n</DataArray></PointData></Piece></ImageData></VTKFile>");
    EXPECT_EQ(read_file<Sample>(path), samples) << type;
  };
  read("UInt8", std::vector<std::uint8_t>{0, 255, 7, 8});
  read("Int8", std::vector<std::int8_t>{-128, 127, 7, 8});
  read("UInt16", std::vector<std::uint16_t>{0, 65535, 7, 8});
  read("UInt32", std::vector<std::uint32_t>{0, 4294967295U, 7, 8});
  read("Int32", std::vector<std::int32_t>{-2147483647 - 1, 2147483647, 7, 8});
  read("Float32", std::vector<float>{-1.5F, 0.25F, 7, 8});
  read("Float64", std::vector<double>{-1.5, 0.25, 7, 8});
}

TEST(Vti, RefusesTextThatIsNoNumberOfTheType) {
  const TempFolder folder;
  const auto with = [&](const std::string& numbers) {
    return refusal(folder.put("a.vti",
                              "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 0 0 1\"><Piece><PointData>"
                              "<DataArray type=\"UInt8\" format=\"ascii\">" +
                                  numbers + "</DataArray>"));
  };
  EXPECT_TRUE(contains(with("1 2 3 256"), "expected numbers of type uint8, found '256'"));
  EXPECT_TRUE(contains(with("1 2 3 x"), "found 'x'"));
  EXPECT_TRUE(contains(with("1 2 3"), "expected 4 bytes of samples, found 3"));
}

TEST(Vti, TakesActiveScalarsOrTheFirstOfOneComponent) {
  const TempFolder folder;
  VtiForm form;
  form.scalars = "a";
  EXPECT_EQ(read_file<std::int16_t>(folder.put("a.vti", whole(form))), kSamples);
  form.scalars = "v";
  EXPECT_TRUE(contains(refusal(folder.put("a.vti", whole(form))),
                       "expected one component per sample in 'v', found v (3 components)"));
  form.scalars = "b";
  EXPECT_TRUE(
      contains(refusal(folder.put("a.vti", whole(form))), "expected the active array 'b', found v (3 components), a"));
  form.scalars.clear();
  form.attributes += " NumberOfComponents=\"2\"";
  EXPECT_TRUE(contains(refusal(folder.put("a.vti", whole(form))),
                       "expected an array of one component, found v (3 components), a (2 components)"));
}

TEST(Vti, TakesOriginSpacingDirectionAndExtent) {
  const TempFolder folder;
  VtiForm form;
  form.extent = "2 5 -1 1 10 14";
  form.place =
      "WholeExtent=\"2 5 -1 1 10 14\" Origin=\"100 200 300\" Spacing=\"2 3 4\" Direction=\"0 -1 0 1 0 0 0 0 1\"";
  const Geometry geometry = open_volume(folder.put("a.vti", whole(form)))->info().geometry;
  EXPECT_EQ(geometry.spacing, (std::array<double, 3>{2, 3, 4}));
  EXPECT_EQ(geometry.direction, (std::array<double, 9>{0, -1, 0, 1, 0, 0, 0, 0, 1}));
  // Sample (2, -1, 10): x and y are turned.
  EXPECT_EQ(geometry.origin, (std::array<double, 3>{103, 204, 340}));
  EXPECT_EQ(geometry.space, Space::kUnknown);
  form.extent = "2 5 -1 1 10 12";
  EXPECT_TRUE(contains(refusal(folder.put("a.vti", whole(form))), "none for 0 to 3, 0 to 2, 3 to 4"));
}

TEST(Vti, RefusesWhatItDoesNotRead) {
  const TempFolder folder;
  const auto with = [&](const std::string& from, const std::string& to, VtiForm form = {}) {
    std::string text = whole(form);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return refusal(folder.put("a.vti", text.replace(at, from.size(), to)));
  };
  VtiForm packed;
  packed.block = 50;
  EXPECT_TRUE(contains(with("ImageData\"", "PolyData\""),
                       "expected VTK XML of type ImageData or RectilinearGrid, found 'PolyData'"));
  EXPECT_TRUE(contains(with("vtkZLib", "vtkOdd", packed), "found 'vtkOddDataCompressor'"));
  EXPECT_TRUE(contains(with("type=\"Int16\"", "type=\"Int128\""), "found 'Int128'"));
  EXPECT_TRUE(contains(with("format=\"binary\"", "format=\"odd\""), "found 'odd'"));
  EXPECT_TRUE(contains(with("Extent=\"0 3", "Extent=\"0 x"), "six whole numbers as an extent"));
  EXPECT_TRUE(contains(with("Spacing=\"1 1 1\"", "Spacing=\"1 1\""), "3 numbers as Spacing"));
  EXPECT_TRUE(contains(with("PointData ", "CellData "), "expected 48 bytes in the array, found 120"));
  EXPECT_TRUE(contains(refusal(folder.put("b.vti", "hello")), "<VTKFile type=\"ImageData\">"));
}

TEST(Vti, RefusesSizesThatLie) {
  const TempFolder folder;
  VtiForm form;
  form.place = "WholeExtent=\"0 99999 0 99999 0 99999\"";
  form.extent = "0 99999 0 99999 0 99999";
  EXPECT_TRUE(contains(refusal(folder.put("a.vti", whole(form))), "which cannot hold them"));
  form.block = 50;
  EXPECT_TRUE(contains(refusal(folder.put("a.vti", whole(form))), "which cannot hold them"));
  form.place = "WholeExtent=\"0 3 0 2 0 3\"";
  form.extent = "0 3 0 2 0 3";
  EXPECT_TRUE(contains(refusal(folder.put("a.vti", whole(form))), "expected compressed blocks of 96 bytes in all"));
  form.block = 0;
  EXPECT_TRUE(contains(refusal(folder.put("a.vti", whole(form))), "expected 96 bytes in the array, found 120"));
  VtiForm blocks;
  blocks.wide = true;
  blocks.block = 50;
  const std::string huge = bytes_of(std::uint64_t{1} << 61) + bytes_of(std::uint64_t{8}) + bytes_of(std::uint64_t{120});
  EXPECT_TRUE(contains(refusal(folder.put("a.vti", vti(blocks, base64(huge)))), "expected compressed blocks"));
  // The header says 50 and 20 bytes; the first block holds 49.
  const std::string samples = stored(kSamples);
  const std::string a = zlibbed(samples.substr(0, 49));
  const std::string b = zlibbed(samples.substr(49));
  const auto three = [&](std::uint64_t n, std::uint64_t block, std::uint64_t last) {
    return base64(bytes_of(n) + bytes_of(block) + bytes_of(last) + bytes_of(std::uint64_t{a.size()}) +
                  bytes_of(std::uint64_t{b.size()})) +
           base64(a + b);
  };
  EXPECT_TRUE(contains(refusal(folder.put("a.vti", vti(blocks, three(2, 50, 70)))), "a smaller one"));
  EXPECT_TRUE(contains(refusal(folder.put("a.vti", vti(blocks, three(2, 48, 72)))), "a larger one"));
}

TEST(Vti, SurvivesCutsAndFlips) {
  const TempFolder folder;
  for (const std::size_t block : {0U, 50U}) {
    for (const auto& [appended, text] : {std::pair(false, true), std::pair(true, true), std::pair(true, false)}) {
      const std::string content = whole({false, false, block, appended, text});
      expect_prefixes_are_safe(folder, "a.vti", content);
      expect_flips_are_safe(folder, "a.vti", content, content.size(), 1500);
    }
  }
}

// A header with lines replaced or added before POINT_DATA.
std::string legacy(const std::string& form, const std::string& type = "short", const std::string& more = "") {
  return "# vtk DataFile Version 3.0\na title\n" + form +
         "\nDATASET STRUCTURED_POINTS\nDIMENSIONS 4 3 5\nSPACING 2 3 4\nORIGIN 10 20 30\n" + more +
         "POINT_DATA 60\nSCALARS s " + type + " 1\nLOOKUP_TABLE default\n";
}

TEST(VtkLegacy, ReadsBinaryAndText) {
  const TempFolder folder;
  const auto source = open_volume(folder.put("a.vtk", legacy("BINARY") + stored(kSamples, true)));
  EXPECT_EQ(source->info().format, "vtk");
  EXPECT_EQ(source->info().geometry.spacing, (std::array<double, 3>{2, 3, 4}));
  EXPECT_EQ(source->info().geometry.origin, (std::array<double, 3>{10, 20, 30}));
  EXPECT_EQ(samples_of<std::int16_t>(*source), kSamples);
  std::string text = legacy("ASCII");
  for (const std::int16_t sample : kSamples) text += std::to_string(sample) + "\n";
  EXPECT_EQ(read_file<std::int16_t>(folder.put("a.vtk", text + "METADATA\nINFORMATION 0\n")), kSamples);
  const auto reals = ramp<float>(60);
  EXPECT_EQ(read_file<float>(folder.put("a.vtk", legacy("BINARY", "float") + stored(reals, true))), reals);
}

TEST(VtkLegacy, RefusesWhatItDoesNotRead) {
  const TempFolder folder;
  const auto with = [&](const std::string& header) { return refusal(folder.put("a.vtk", header + stored(kSamples))); };
  EXPECT_TRUE(contains(with(legacy("OCTAL")), "ASCII or BINARY"));
  EXPECT_TRUE(contains(with(legacy("BINARY", "complex")), "a type of VTK, found 'complex'"));
  EXPECT_TRUE(contains(with(legacy("BINARY", "double")), "expected 480 bytes of samples, found 120"));
  EXPECT_TRUE(contains(with(legacy("ASCII")), "expected numbers of type int16"));
  EXPECT_TRUE(contains(with(legacy("BINARY", "short", "DATASET POLYDATA\n")), "DATASET STRUCTURED_POINTS"));
  EXPECT_TRUE(contains(with(legacy("BINARY", "short", "DIMENSIONS 4 3\n")), "3 whole numbers as DIMENSIONS"));
  EXPECT_TRUE(contains(with(legacy("BINARY", "short", "DIMENSIONS 4 3 6\n")),
                       "expected 72 samples in the array 's', found 60"));
  EXPECT_TRUE(contains(refusal(folder.put("b.vtk", "hello")), "# vtk DataFile Version"));
}

TEST(VtkLegacy, SurvivesCutsAndFlips) {
  const TempFolder folder;
  const std::string content = legacy("BINARY") + stored(kSamples, true);
  expect_prefixes_are_safe(folder, "a.vtk", content);
  expect_flips_are_safe(folder, "a.vtk", content, 200);
}

}  // namespace
}  // namespace isoweave::testing::volume_vtk_test
