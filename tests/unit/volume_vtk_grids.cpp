// Rectilinear grids of VTK, in XML and in legacy files: even ones as they are, uneven slices as those of DICOM.
#include "vti_helpers.hpp"

namespace isoweave::testing::volume_vtk_grids_test {
namespace {

using namespace vti_files;
using Samples = std::vector<std::int16_t>;

std::string text_array(const std::string& attributes, const std::string& numbers) {
  return "<DataArray " + attributes + " format=\"ascii\">" + numbers + "</DataArray>";
}

std::string text_of(const Samples& samples) {
  std::string text;
  for (const std::int16_t sample : samples) text += " " + std::to_string(sample);
  return text;
}

struct Grid {
  std::string x = "0 2 4", y = "5 4", z = "7 8 9 10", extent = "0 2 0 1 0 3", type = "Float64";
  bool cells = false;
};

std::string piece(const Grid& grid, const Samples& samples) {
  std::string coordinates = "<Coordinates>";
  for (const std::string* axis : {&grid.x, &grid.y, &grid.z}) {
    coordinates += text_array("type=\"" + grid.type + "\" Name=\"c\"", *axis);
  }
  const std::string data = grid.cells ? "CellData" : "PointData";
  return "<Piece Extent=\"" + grid.extent + "\"><" + data + ">" +
         text_array("type=\"Int16\" Name=\"s\"", text_of(samples)) + "</" + data + ">" + coordinates +
         "</Coordinates></Piece>";
}

std::string vtr(const std::string& extent, const std::string& pieces) {
  return "<VTKFile type=\"RectilinearGrid\"><RectilinearGrid WholeExtent=\"" + extent + "\">" + pieces +
         "</RectilinearGrid></VTKFile>\n";
}

std::string vtr(const Grid& grid, const Samples& samples) { return vtr(grid.extent, piece(grid, samples)); }

std::string legacy(const std::string& z, const Samples& samples) {
  const auto count = std::count(z.begin(), z.end(), ' ') + 1;
  return "# vtk DataFile Version 4.2\nx\nASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS 2 1 " + std::to_string(count) +
         "\nX_COORDINATES 2 float\n0 1\nY_COORDINATES 1 float\n0\nZ_COORDINATES " + std::to_string(count) +
         " double\n" + z + "\nPOINT_DATA " + std::to_string(samples.size()) + "\nSCALARS s short\nLOOKUP_TABLE d\n" +
         text_of(samples) + "\n";
}

TEST(VtkGrids, EvenCoordinatesAreAVolume) {
  const TempFolder folder;
  const Samples samples = ramp<std::int16_t>(24);
  const auto source = open_volume(folder.put("a.vtr", vtr(Grid{}, samples)));
  EXPECT_EQ(source->info().format, "vtr");
  EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{3, 2, 4}));
  EXPECT_EQ(source->info().geometry.spacing, (std::array<double, 3>{2, 1, 1}));
  EXPECT_EQ(source->info().geometry.origin, (std::array<double, 3>{0, 5, 7}));
  EXPECT_EQ(source->info().geometry.direction[4], -1) << "coordinates that descend";
  EXPECT_TRUE(source->info().notes.empty());
  EXPECT_EQ(samples_of<std::int16_t>(*source), samples);
  Grid grid;
  grid.cells = true;
  const Samples middles = ramp<std::int16_t>(6);
  const auto cells = open_volume(folder.put("b.vtr", vtr(grid, middles)));
  EXPECT_EQ(cells->info().dims, (std::array<std::int64_t, 3>{2, 1, 3}));
  EXPECT_EQ(cells->info().geometry.origin, (std::array<double, 3>{1, 4.5, 7.5}));
  EXPECT_EQ(samples_of<std::int16_t>(*cells), middles);
}

// Two pieces that share a layer of points, in one file and in two.
TEST(VtkGrids, PiecesHaveCoordinatesOfTheirOwn) {
  const TempFolder folder;
  const Samples samples = ramp<std::int16_t>(24);
  const std::string low = piece({.z = "7 8", .extent = "0 2 0 1 0 1"}, Samples(samples.begin(), samples.begin() + 12));
  const std::string high = piece({.z = "8 9 10", .extent = "0 2 0 1 1 3"}, Samples(samples.begin() + 6, samples.end()));
  EXPECT_EQ(read_file<std::int16_t>(folder.put("a.vtr", vtr("0 2 0 1 0 3", low + high))), samples);
  folder.put("a_0.vtr", vtr("0 2 0 1 0 1", low));
  folder.put("a_1.vtr", vtr("0 2 0 1 1 3", high));
  const std::string path =
      folder.put("a.pvtr",
                 "<VTKFile type=\"PRectilinearGrid\"><PRectilinearGrid WholeExtent=\"0 2 0 1 0 3\"><PCoordinates/>"
                 "<Piece Extent=\"0 2 0 1 0 1\" Source=\"a_0.vtr\"/><Piece Extent=\"0 2 0 1 1 3\" Source=\"a_1.vtr\"/>"
                 "</PRectilinearGrid></VTKFile>");
  EXPECT_EQ(read_file<std::int16_t>(path), samples);
  OpenOptions strangers;
  strangers.external = false;
  EXPECT_TRUE(contains(refusal(path, strangers), "a file that names no other"));
  EXPECT_TRUE(contains(refusal(folder.put("b.vtr", vtr("0 2 0 1 0 3", low))), "finite z coordinates, found others"));
  EXPECT_TRUE(contains(refusal(folder.put("b.vtr", vtr("0 2 0 1 0 2", low + high))), "pieces within the whole extent"));
}

TEST(VtkGrids, UnevenSlicesAreTreatedAsThoseOfDicom) {
  const TempFolder folder;
  const Samples samples{0, 1, 10, 11, 30, 31};  // a slice of two samples at 0, 1 and 3
  const Samples made{0, 1, 10, 11, 20, 21, 30, 31};
  const Grid grid{.x = "0 1", .y = "0", .z = "0 1 3", .extent = "0 1 0 0 0 2"};
  Grid down = grid;
  down.z = "0 -1 -3";
  const std::string paths[] = {folder.put("a.vtr", vtr(grid, samples)), folder.put("a.vtk", legacy("0 1 3", samples)),
                               folder.put("b.vtr", vtr(down, samples))};
  for (const std::string& path : paths) {
    const auto source = open_volume(path);
    EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{2, 1, 4})) << path;
    EXPECT_EQ(source->info().geometry.spacing[2], 1);
    EXPECT_EQ(source->info().geometry.direction[8], path == paths[2] ? -1 : 1);
    EXPECT_TRUE(has_note(source->info(), "read as 4 slices 1 apart, 1 of which is interpolated"));
    EXPECT_EQ(samples_of<std::int16_t>(*source), made);
    OpenOptions options;
    options.uneven_slices = UnevenSlices::kMean;
    EXPECT_EQ(read_file<std::int16_t>(path, options), samples);
    EXPECT_EQ(open_volume(path, options)->info().geometry.spacing[2], 1.5);
    options.uneven_slices = UnevenSlices::kRefuse;
    EXPECT_TRUE(
        contains(refusal(path, options), "found distances of 1 to 2, the widest between 'slice 1' and 'slice 2'"))
        << refusal(path, options);
    options = {};
    options.spacing = std::array<double, 3>{1, 1, 4};
    EXPECT_EQ(read_file<std::int16_t>(path, options), samples);
    EXPECT_EQ(open_volume(path, options)->info().geometry.spacing[2], 4);
  }
}

// Samples in the order that is not the machine's are turned before they are interpolated.
TEST(VtkGrids, SlicesThatTurnBackAreRefusedByTheirCoordinates) {
  const TempFolder folder;
  const auto found = [&](const std::string& z) {
    const std::string expected = "expected z coordinates that ascend, or descend, from the first to the last, found ";
    const Grid grid{.x = "0 1", .y = "0", .z = z, .extent = "0 1 0 0 0 4"};
    const std::string message = refusal(folder.put("a.vtr", vtr(grid, ramp<std::int16_t>(10))));
    EXPECT_EQ(refusal(folder.put("a.vtk", legacy(z, ramp<std::int16_t>(10)))),
              folder / "a.vtk" + message.substr((folder / "a.vtr").size()));
    const std::size_t at = message.find(expected);
    return at == std::string::npos ? message : message.substr(at + expected.size());
  };
  EXPECT_EQ(found("0 1 3 2 4"), "2 behind 3 at 3");
  EXPECT_EQ(found("4 2 3 1 0"), "3 behind 2 at 2");
  EXPECT_EQ(found("0 1 2 1 0"), "1 behind 2 at 3");
  EXPECT_TRUE(contains(found("0 1 1 2 3"), "a position of its own for every slice, found that of 'slice 1'"));
}

TEST(VtkGrids, UnevenSlicesMayHaveTheOtherByteOrder) {
  const TempFolder folder;
  const Samples samples{0, 1000, 10, 1010, 30, 1030};
  const Grid grid{.x = "0 1", .y = "0", .z = "0 1 3", .extent = "0 1 0 0 0 2"};
  std::string content = vtr(grid, samples);
  const std::string bytes = bytes_of(std::uint32_t{12}, true) + stored(samples, true);
  const std::string plain = text_array("type=\"Int16\" Name=\"s\"", text_of(samples));
  content.replace(content.find(plain), plain.size(),
                  "<DataArray type=\"Int16\" Name=\"s\" format=\"binary\">" + base64(bytes) + "</DataArray>");
  content.replace(content.find("<VTKFile"), 8, "<VTKFile byte_order=\"BigEndian\"");
  EXPECT_EQ(read_file<std::int16_t>(folder.put("a.vtr", content)), (Samples{0, 1000, 10, 1010, 20, 1020, 30, 1030}));
}

TEST(VtkGrids, OtherUnevenCoordinatesAreRefusedByTheirAxis) {
  const TempFolder folder;
  const Samples samples = ramp<std::int16_t>(24);
  const auto with = [&](const Grid& grid) { return refusal(folder.put("a.vtr", vtr(grid, samples))); };
  EXPECT_TRUE(contains(with({.x = "0 1 4"}), "expected evenly spaced x coordinates, 2 at 1, found 1"));
  EXPECT_TRUE(contains(with({.x = "0 0 0", .y = "1 1"}), "expected"));
  EXPECT_TRUE(contains(with({.y = "5 nan"}), "expected finite y coordinates"));
  EXPECT_TRUE(contains(with({.z = "1 2 2 3"}), "a position of its own for every slice")) << with({.z = "1 2 2 3"});
  EXPECT_TRUE(contains(with({.z = "1 2 3"}), "expected"));
  EXPECT_TRUE(contains(with({.extent = "0 2 0 1 0 99999999"}), "expected"));
  EXPECT_TRUE(contains(refusal(folder.put("a.vtr", "text")), "<VTKFile type=\"RectilinearGrid\">, found text"));
}

TEST(VtkGrids, DamageIsSafe) {
  const TempFolder folder;
  const std::string content = vtr({.z = "7 8 9 11"}, ramp<std::int16_t>(24));
  for (std::size_t length = 0; length < content.size(); ++length) {
    reads_or_refuses(folder.put("a.vtr", content.substr(0, length)));
  }
  expect_flips_are_safe(folder, "a.vtr", content, content.size(), 2000);
}

}  // namespace
}  // namespace isoweave::testing::volume_vtk_grids_test
