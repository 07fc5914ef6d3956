// VTI, PVTI and legacy VTK volumes in the ways that are not the plainest: cells, pieces, bits, several arrays.
#include <cmath>

#include "vti_helpers.hpp"

namespace isoweave::testing::volume_vtk_variants_test {
namespace {

using namespace vti_files;

OpenOptions named(const std::string& array) {
  OpenOptions options;
  options.dataset = array;
  return options;
}

template <class Sample>
std::string text_of(const std::vector<Sample>& samples) {
  std::string text;
  for (const Sample sample : samples) text += " " + std::to_string(sample);
  return text;
}

bool has_note(const SliceSource& source, const std::string& part) {
  for (const std::string& note : source.info().notes) {
    if (contains(note, part)) return true;
  }
  return false;
}

std::string data_array(const std::string& attributes, const std::string& text) {
  return "<DataArray " + attributes + " format=\"ascii\">" + text + "</DataArray>";
}

std::string image(const std::string& extent, const std::string& pieces, const std::string& more = "") {
  return "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"" + extent +
         "\" Origin=\"10 20 30\" Spacing=\"2 4 8\" " + more + ">" + pieces + "</ImageData></VTKFile>";
}

std::string points(const std::string& arrays) { return "<PointData>" + arrays + "</PointData>"; }
std::string cells(const std::string& arrays) { return "<CellData Scalars=\"c\">" + arrays + "</CellData>"; }
std::string piece(const std::string& extent, const std::string& data) {
  return "<Piece Extent=\"" + extent + "\">" + data + "</Piece>";
}

// 3 x 2 x 1 cells between 4 x 3 x 1 points: the image is flat along z, and so are its cells.
TEST(VtiVariants, ReadsCellsInTheirMiddles) {
  const TempFolder folder;
  const std::vector<std::int16_t> samples = ramp<std::int16_t>(6);
  const std::string array = data_array("type=\"Int16\" Name=\"c\"", text_of(samples));
  const auto source =
      open_volume(folder.put("a.vti", image("1 4 0 2 5 5", piece("1 4 0 2 5 5", points("") + cells(array)))));
  EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{3, 2, 1}));
  // Between the points (1, 0, 5) and (2, 1, 5).
  EXPECT_EQ(source->info().geometry.origin, (std::array<double, 3>{13, 22, 70}));
  EXPECT_TRUE(has_note(*source, "one of cells"));
  EXPECT_EQ(samples_of<std::int16_t>(*source), samples);
}

TEST(VtiVariants, PrefersPointsAndTakesWhatIsNamed) {
  const TempFolder folder;
  const std::string data =
      points(data_array("type=\"Int8\" Name=\"a\"", " 1 2 3 4") + data_array("type=\"Int8\" Name=\"b\"", " 5 6 7 8")) +
      cells(data_array("type=\"Int8\" Name=\"c\"", " 9"));
  const std::string path = folder.put("a.vti", image("0 1 0 1 0 0", piece("0 1 0 1 0 0", data)));
  const auto read = [&](const std::string& name) { return samples_of<std::int8_t>(*open_volume(path, named(name))); };
  EXPECT_EQ(read(""), (std::vector<std::int8_t>{1, 2, 3, 4}));
  EXPECT_EQ(read("b"), (std::vector<std::int8_t>{5, 6, 7, 8}));
  EXPECT_EQ(read("c"), (std::vector<std::int8_t>{9}));
  EXPECT_EQ(open_volume(path, named("b"))->info().part, "array b");
  EXPECT_TRUE(has_note(*open_volume(path, named("c")), "the array c is read, not a, b"));
  EXPECT_THROW(open_volume(path, named("d")), BadInput);
}

TEST(VtiVariants, PassesOverArraysOfVtkItself) {
  const TempFolder folder;
  const std::string data =
      points(data_array("type=\"UInt8\" Name=\"vtkGhostType\"", "0 1") + data_array("type=\"Int8\" Name=\"a\"", "5 6"));
  const std::string path = folder.put("a.vti", image("0 1 0 0 0 0", piece("0 1 0 0 0 0", data)));
  EXPECT_EQ(read_file<std::int8_t>(path), (std::vector<std::int8_t>{5, 6}));
  EXPECT_EQ(samples_of<std::uint8_t>(*open_volume(path, named("vtkGhostType"))), (std::vector<std::uint8_t>{0, 1}));
}

// 4 x 3 x 3 points, sample = 100 k + 10 j + i, in pieces that share their borders.
std::string pieces_of(const std::vector<std::array<int, 6>>& extents) {
  std::string all;
  for (const auto& e : extents) {
    std::string extent, text;
    for (const int n : e) extent += std::to_string(n) + " ";
    for (int k = e[4]; k <= e[5]; ++k) {
      for (int j = e[2]; j <= e[3]; ++j) {
        for (int i = e[0]; i <= e[1]; ++i) text += " " + std::to_string(100 * k + 10 * j + i);
      }
    }
    all += piece(extent, points(data_array("type=\"Int32\" Name=\"n\"", text)));
  }
  return all;
}

std::vector<std::int32_t> whole_samples() {
  std::vector<std::int32_t> samples;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 4; ++i) samples.push_back(100 * k + 10 * j + i);
    }
  }
  return samples;
}

const std::string kExtent = "0 3 0 2 0 2";
const std::vector<std::array<int, 6>> kPieces{
    {0, 1, 0, 2, 0, 2}, {1, 3, 0, 1, 0, 1}, {1, 3, 1, 2, 0, 1}, {1, 3, 0, 2, 1, 2}};

TEST(VtiVariants, PutsPiecesTogether) {
  const TempFolder folder;
  const std::string path = folder.put("a.vti", image(kExtent, pieces_of(kPieces)));
  EXPECT_EQ(read_file<std::int32_t>(path), whole_samples());
  for (const std::int64_t at_once : {1, 3}) {
    const auto source = open_volume(path);
    EXPECT_EQ(samples_of<std::int32_t>(*source, at_once), whole_samples());
  }
  // Pieces that repeat the whole, or hold nothing.
  const std::string whole = pieces_of({{0, 3, 0, 2, 0, 2}});
  const std::string none = piece("0 -1 0 -1 0 -1", points(""));
  EXPECT_EQ(read_file<std::int32_t>(folder.put("b.vti", image(kExtent, none + whole + whole))), whole_samples());
}

TEST(VtiVariants, RefusesPiecesThatDoNotFit) {
  const TempFolder folder;
  const auto with = [&](const std::string& pieces) { return refusal(folder.put("a.vti", image(kExtent, pieces))); };
  EXPECT_TRUE(contains(with(pieces_of({kPieces[0], kPieces[1], kPieces[2]})), "none for 2 to 3, 2 to 2, 2 to 2"));
  EXPECT_TRUE(contains(with(pieces_of({kPieces[0], {1, 4, 0, 2, 0, 2}})), "pieces within the samples"));
  const std::string other = piece("1 3 0 2 0 2", points(data_array("type=\"Int16\" Name=\"n\"", " 1")));
  EXPECT_TRUE(contains(with(pieces_of({kPieces[0]}) + other), "the array 'n' of type Int32 in each piece"));
  std::string shorter = pieces_of(kPieces);
  shorter.erase(shorter.rfind("223"), 3);
  EXPECT_THROW(read_file<std::int32_t>(folder.put("b.vti", image(kExtent, shorter))), BadInput);
}

TEST(VtiVariants, ReadsPiecesInFilesOfTheirOwn) {
  const TempFolder folder;
  std::string names;
  for (std::size_t n = 0; n < kPieces.size(); ++n) {
    const std::string name = "p_" + std::to_string(n) + ".vti";
    folder.put(name, image(kExtent, pieces_of({kPieces[n]}), "Direction=\"0 1 0 1 0 0 0 0 1\""));
    names += "<Piece Extent=\"0 0 0 0 0 0\" Source=\"" + name + "\"/>";
  }
  const std::string path =
      folder.put("p.pvti", "<VTKFile type=\"PImageData\"><PImageData WholeExtent=\"" + kExtent +
                               "\" GhostLevel=\"0\" Origin=\"10 20 30\" Spacing=\"2 4 8\"><PPointData Scalars=\"n\">"
                               "<PDataArray type=\"Int32\" Name=\"n\"/></PPointData>" +
                               names + "</PImageData></VTKFile>");
  const auto source = open_volume(path);
  EXPECT_EQ(samples_of<std::int32_t>(*source), whole_samples());
  EXPECT_EQ(source->info().geometry.direction, (std::array<double, 9>{0, 1, 0, 1, 0, 0, 0, 0, 1}));
  OpenOptions alone;
  alone.external = false;
  EXPECT_THROW(open_volume(path, alone), BadInput);
  std::filesystem::remove(folder / "p_2.vti");
  EXPECT_EQ(refusal(path), path + ": expected a piece in " + folder / "p_2.vti" + ", found no such file");
}

TEST(VtiVariants, ReadsBits) {
  const TempFolder folder;
  VtiForm form;
  form.attributes = "type=\"Bit\" Name=\"a\"";
  form.extent = "0 4 0 1 0 0";
  form.place = "WholeExtent=\"" + form.extent + "\"";
  const std::vector<std::uint8_t> right{1, 0, 1, 1, 0, 0, 0, 1, 1, 0};
  EXPECT_EQ(read_file<std::uint8_t>(folder.put("a.vti", vti(form, array_of(form, "\xb1\x80")))), right);
  const std::string text = points(data_array("type=\"Bit\" Name=\"a\"", text_of(right)));
  EXPECT_EQ(read_file<std::uint8_t>(folder.put("b.vti", image(form.extent, piece(form.extent, text)))), right);
}

TEST(VtiVariants, ReadsTheFirstOfSeveralTimes) {
  const TempFolder folder;
  const auto at = [](int time, const std::string& text) {
    return data_array("type=\"Int8\" Name=\"a\" TimeStep=\"" + std::to_string(time) + "\"", text);
  };
  const auto source =
      open_volume(folder.put("a.vti", image("0 1 0 0 0 0", piece("0 1 0 0 0 0", points(at(0, "1 2") + at(1, "3 4"))),
                                            "TimeValues=\" 0 0.5\n\"")));
  EXPECT_EQ(samples_of<std::int8_t>(*source), (std::vector<std::int8_t>{1, 2}));
  EXPECT_TRUE(has_note(*source, "the first of 2 times"));
}

std::string legacy(const std::string& form, const std::string& data) {
  return "# vtk DataFile Version 5.1\nvtk output\n" + form +
         "\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 2\nSPACING 2 3 4\nORIGIN 10 20 30\n" + data;
}

const std::string kMetadata = "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1\n\n";

// What VTK writes for samples of 8 bits: as they are in binary, and as parts of 1 in text.
TEST(VtkLegacyVariants, ReadsColourScalars) {
  const TempFolder folder;
  const std::vector<std::uint8_t> samples{0, 1, 2, 3, 127, 128, 200, 251, 252, 253, 254, 255};
  EXPECT_EQ(read_file<std::uint8_t>(folder.put(
                "a.vtk", legacy("BINARY", "POINT_DATA 12\nCOLOR_SCALARS my%%20mask 1\n" + stored(samples) + "\n"))),
            samples);
  std::string text;
  for (const std::uint8_t sample : samples) {
    std::ostringstream part;
    part << sample / 255.0;  // six digits, as VTK has them
    text += part.str() + " ";
  }
  EXPECT_EQ(
      read_file<std::uint8_t>(folder.put("b.vtk", legacy("ASCII", "POINT_DATA 12\nCOLOR_SCALARS m 1\n" + text + "\n"))),
      samples);
}

TEST(VtkLegacyVariants, FindsTheArrayAmongOthers) {
  const TempFolder folder;
  const std::vector<std::uint16_t> samples = ramp<std::uint16_t>(12);
  // Binary samples that look like lines of text stand before.
  const std::string others = "FIELD FieldData 1\nTIME 1 1 double\n" + bytes_of(1.5, true) + "\n" + kMetadata +
                             "CELL_DATA 2\nSCALARS c short\nLOOKUP_TABLE default\n\n\n\n\n\n" + kMetadata +
                             "POINT_DATA 12\nVECTORS v float\n" + std::string(144, '\n') + "\n" + kMetadata +
                             "FIELD FieldData 2\nmany 2 12 unsigned_char\n" + std::string(24, 'F') + "\n" + kMetadata +
                             "my%20array 1 12 unsigned_short\n" + stored(samples, true) + "\n" + kMetadata;
  const std::string path = folder.put("a.vtk", legacy("BINARY", others));
  const auto source = open_volume(path);
  EXPECT_EQ(source->info().part, "array my array");
  EXPECT_EQ(samples_of<std::uint16_t>(*source), samples);
  EXPECT_TRUE(has_note(*source, "not v (3 components), many (2 components), in cells: c"));
  const auto in_cells = open_volume(path, named("c"));
  EXPECT_EQ(samples_of<std::int16_t>(*in_cells), (std::vector<std::int16_t>{0x0a0a, 0x0a0a}));
  EXPECT_EQ(in_cells->info().geometry.origin, (std::array<double, 3>{11, 21.5, 32}));
  EXPECT_EQ(in_cells->info().dims, (std::array<std::int64_t, 3>{2, 1, 1}));
}

TEST(VtkLegacyVariants, ReadsEveryTypeOfSmallLetters) {
  const TempFolder folder;
  const auto type_of = [&](const std::string& type) {
    return open_volume(folder.put("a.vtk", legacy("ASCII", "POINT_DATA 12\nSCALARS s " + type +
                                                               "\n1 2 3 4 5 6 7 8 9 10 11 12\n")))
        ->info()
        .type;
  };
  EXPECT_EQ(type_of("Unsigned_Char"), SampleType::kUint8);
  EXPECT_EQ(type_of("signed_char 1"), SampleType::kInt8);
  EXPECT_EQ(type_of("vtkIdType"), SampleType::kInt32);
  EXPECT_EQ(type_of("unsigned_int"), SampleType::kUint32);
  EXPECT_EQ(type_of("bit"), SampleType::kUint8);
  EXPECT_TRUE(contains(refusal(folder.put("b.vtk", legacy("ASCII", "POINT_DATA 12\nSCALARS s int 3\n1 2 3\n"))),
                       "one component"));
}

TEST(VtkLegacyVariants, RefusesCountsThatCannotBe) {
  const TempFolder folder;
  const auto with = [&](const std::string& array) {
    return refusal(folder.put("a.vtk", legacy("BINARY", "POINT_DATA 12\nFIELD f 1\n" + array + "\n")));
  };
  EXPECT_TRUE(contains(with("a 4096 281474976710656 double"), "at most 2^48 numbers"));
  EXPECT_TRUE(contains(with("a 1 281474976710657 int"), "a whole number behind 'a'"));
  EXPECT_TRUE(contains(with("a 1 12 int"), "expected 48 bytes of the array 'a', found 0"));
  EXPECT_TRUE(contains(with("a -1 12 int"), "a whole number behind 'a'"));
  EXPECT_TRUE(contains(with("a 1 12"), "name, components, tuples and type"));
}

std::string rectilinear(const std::string& x) {
  return "# vtk DataFile Version 4.2\nx\nASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS 3 2 1\nX_COORDINATES 3 float\n" +
         x +
         "\nY_COORDINATES 2 double\n5 4.5\nZ_COORDINATES 1 int\n7\nPOINT_DATA 6\nSCALARS s short\nLOOKUP_TABLE d\n"
         "1 2 3 4 5 6\n";
}

TEST(VtkLegacyVariants, ReadsRectilinearGridsThatAreEven) {
  const TempFolder folder;
  const auto source = open_volume(folder.put("a.vtk", rectilinear("1 1.1 1.2")));
  const Geometry& geometry = source->info().geometry;
  EXPECT_NEAR(geometry.spacing[0], 0.1, 1e-6);
  EXPECT_EQ(geometry.spacing[1], 0.5);
  EXPECT_EQ(geometry.direction[4], -1) << "coordinates that descend";
  EXPECT_EQ(geometry.origin, (std::array<double, 3>{1, 5, 7}));
  EXPECT_TRUE(has_note(*source, "one z coordinate"));
  EXPECT_EQ(samples_of<std::int16_t>(*source), (std::vector<std::int16_t>{1, 2, 3, 4, 5, 6}));
  EXPECT_TRUE(contains(refusal(folder.put("b.vtk", rectilinear("1 1.2 1.3"))), "evenly spaced x coordinates"));
  EXPECT_TRUE(contains(refusal(folder.put("b.vtk", rectilinear("1 1 1"))), "expected"));
}

TEST(VtkVariants, SurviveCutsAndFlips) {
  const TempFolder folder;
  const std::vector<std::uint8_t> samples = ramp<std::uint8_t>(12);
  const std::string contents[] = {
      legacy("BINARY",
             "CELL_DATA 2\nSCALARS c short\nLOOKUP_TABLE default\n1234\nPOINT_DATA 12\nFIELD f 2\nv 3 12 "
             "bit\n12345\ns 1 12 unsigned_char\n" +
                 stored(samples)),
      rectilinear("1 1.1 1.2")};
  for (const std::string& content : contents) {
    for (std::size_t length = 0; length < content.size(); ++length) {
      try {
        read_all(*open_volume(folder.put("a.vtk", content.substr(0, length))));
      } catch (const BadInput&) {
        continue;
      }
    }
    expect_flips_are_safe(folder, "a.vtk", content, content.size(), 1500);
  }
  const std::string pieces = image(kExtent, pieces_of(kPieces));
  expect_flips_are_safe(folder, "a.vti", pieces, pieces.size(), 1500);
}

}  // namespace
}  // namespace isoweave::testing::volume_vtk_variants_test
