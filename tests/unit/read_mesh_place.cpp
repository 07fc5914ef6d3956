// Where a mesh lies: space, unit and offset as files say them, and coordinates that 32 bits do not hold.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <sstream>

#include "files.hpp"
#include "isoweave/error.hpp"
#include "isoweave/measure.hpp"
#include "mesh/read/mesh_input.hpp"
#include "mesh/read/mesh_place.hpp"
#include "meshes.hpp"

namespace isoweave::testing::read_mesh_place_test {
namespace {

using mesh_io::MeshPlace;
using mesh_io::WidePoint;

const WidePoint kFar{500000.1, 4649776.7, 120.3};

TriangleMesh placed_by(const MeshPlace& place) {
  TriangleMesh mesh;
  place.put_into(mesh);
  return mesh;
}

TEST(MeshPlace, IsSaidByWordsOfComments) {
  MeshPlace place;
  place.take_comment(" 3D Slicer output. SPACE=RAS;UNIT=um OFFSET=1,-2.5,3e6");
  EXPECT_EQ(placed_by(place).space, "RAS");
  EXPECT_EQ(placed_by(place).unit, "um");
  EXPECT_EQ(place.offset(), (WidePoint{1, -2.5, 3e6}));
  EXPECT_TRUE(placed_by(place).notes.empty());
}

TEST(MeshPlace, OtherNamesOfUnitsAndSpacesAreKnown) {
  for (const auto& [text, unit] : {std::pair<const char*, const char*>{"millimeter", "mm"},
                                   {"\u00b5m", "um"},
                                   {"\u03bcm", "um"},
                                   {"Micrometers", "um"},
                                   {"NM", "nm"},
                                   {"meter", "m"},
                                   {"inches", "in"}}) {
    MeshPlace place;
    place.take("UNIT", text);
    EXPECT_EQ(placed_by(place).unit, unit);
  }
  MeshPlace place;
  place.take("SPACE", "left-posterior-superior");
  EXPECT_EQ(placed_by(place).space, "LPS");
}

TEST(MeshPlace, WhatIsNotKnownOrContradictsIsNoted) {
  MeshPlace place;
  for (const char* text :
       {"UNIT=furlong SPACE=LPS SPACE=RAS", "OFFSET=1,2", "OFFSET=nan,0,0", "MYSPACE=RAS", "SPACE="}) {
    place.take_comment(text);
  }
  const TriangleMesh mesh = placed_by(place);
  EXPECT_EQ(mesh.unit, "");
  EXPECT_EQ(mesh.space, "LPS");
  EXPECT_FALSE(place.offset());
  EXPECT_EQ(mesh.notes, (std::vector<std::string>{"says UNIT=furlong, which is not known and not kept",
                                                  "says SPACE=LPS and SPACE=RAS: the first is taken"}));
}

TEST(MeshPlace, EveryFormatKeepsSpaceAndUnit) {
  const files::Folder folder;
  for (const char* name : meshes::kFileNames) {
    for (const char* unit : {"mm", "um", "nm", "m", "in", ""}) {
      for (const char* space : {"LPS", "RAS", "index", ""}) {
        TriangleMesh mesh = meshes::cube();
        mesh.unit = unit;
        mesh.space = space;
        write_mesh(folder / name, mesh);
        const TriangleMesh read = read_mesh(folder / name);
        EXPECT_EQ(read.unit, unit) << name;
        EXPECT_EQ(read.space, space) << name;
        EXPECT_EQ(check_mesh(read).digest, check_mesh(mesh).digest) << name;
        std::filesystem::remove_all(folder / name);
      }
    }
  }
}

// Nearest floats to decimal numbers, among them the middle of two floats, and what is close to it.
TEST(WideNumbers, RoundToTheFloatOfTheirText) {
  std::vector<std::string> texts{"0.1",
                                 "16777217",
                                 "16777217.00000000000001",
                                 "16777216.99999999999999",
                                 "500000.015625",
                                 "500000.01562500000000001",
                                 "1e-46",
                                 "1.4e-45",
                                 "1.17549435e-38",
                                 "3.4028235e38",
                                 "-3.4028235e+38",
                                 "-0",
                                 "+7"};
  std::mt19937 random(1);
  for (int n = 0; n < 1000; ++n) {
    std::ostringstream text;
    text.precision(1 + n % 17);
    text << std::ldexp(std::generate_canonical<double, 53>(random) - 0.5, static_cast<int>(random() % 200) - 100);
    texts.push_back(text.str());
  }
  for (const std::string& text : texts) {
    const std::optional<double> wide = mesh_io::parse_wide(text);
    const std::optional<float> narrow = mesh_io::parse_real<float>(text);
    ASSERT_TRUE(wide && narrow) << text;
    EXPECT_EQ(static_cast<float>(*wide), *narrow) << text;
  }
  for (const char* text : {"nan", "inf", "1e39", "1e400", "x", ""}) EXPECT_FALSE(mesh_io::parse_wide(text)) << text;
}

// Waves, 0.1 apart.
std::vector<WidePoint> waves(const WidePoint& at, int n = 40) {
  std::vector<WidePoint> points;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      points.push_back({at[0] + 0.1 * i, at[1] + 0.1 * j, at[2] + std::sin(0.3 * i) * std::cos(0.2 * j)});
    }
  }
  return points;
}

std::string number_text(double x) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.17g", x);
  return digits;
}

std::string point_text(const WidePoint& p) {
  return number_text(p[0]) + " " + number_text(p[1]) + " " + number_text(p[2]);
}

template <class Number>
void append(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::string ply_text(const std::vector<WidePoint>& points, const TriangleMesh& sheet, const char* type) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(points.size());
  for (const char* name : {"x", "y", "z"}) text += std::string("\nproperty ") + type + " " + name;
  text += "\nelement face " + std::to_string(sheet.triangles.size()) +
          "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const WidePoint& p : points) text += point_text(p) + "\n";
  for (const auto& [a, b, c] : sheet.triangles) {
    text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  }
  return text;
}

std::string ply_binary(const std::vector<WidePoint>& points, const TriangleMesh& sheet) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points.size());
  for (const char* name : {"x", "y", "z"}) bytes += std::string("\nproperty double ") + name;
  bytes += "\nelement face " + std::to_string(sheet.triangles.size()) +
           "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const WidePoint& p : points) {
    for (const double x : p) append(bytes, x);
  }
  for (const auto& t : sheet.triangles) {
    append(bytes, std::uint8_t{3});
    for (const std::uint32_t v : t) append(bytes, v);
  }
  return bytes;
}

std::string obj(const std::vector<WidePoint>& points, const TriangleMesh& sheet) {
  std::string text;
  for (const WidePoint& p : points) text += "v " + point_text(p) + "\n";
  for (const auto& [a, b, c] : sheet.triangles) {
    text += "f " + std::to_string(a + 1) + " " + std::to_string(b + 1) + " " + std::to_string(c + 1) + "\n";
  }
  return text;
}

std::string off(const std::vector<WidePoint>& points, const TriangleMesh& sheet) {
  std::string text = "OFF\n" + std::to_string(points.size()) + " " + std::to_string(sheet.triangles.size()) + " 0\n";
  for (const WidePoint& p : points) text += point_text(p) + "\n";
  for (const auto& [a, b, c] : sheet.triangles) {
    text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  }
  return text;
}

std::string stl(const std::vector<WidePoint>& points, const TriangleMesh& sheet) {
  std::string text = "solid t\n";
  for (const auto& t : sheet.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t v : t) text += "vertex " + point_text(points[v]) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid t\n";
}

// The waves at a place, in every format that has more than 32 bits, as other programs write them.
std::vector<std::pair<std::string, std::string>> wide_files(const WidePoint& at) {
  const std::vector<WidePoint> points = waves(at);
  const TriangleMesh sheet = meshes::grid(40);
  return {{"double.ply", ply_text(points, sheet, "double")},
          {"float.ply", ply_text(points, sheet, "float")},
          {"binary.ply", ply_binary(points, sheet)},
          {"a.obj", obj(points, sheet)},
          {"a.off", off(points, sheet)},
          {"a.stl", stl(points, sheet)}};
}

TEST(WideCoordinates, AShapeFarAwayIsThatNearTheOrigin) {
  const files::Folder folder;
  TriangleMesh near = meshes::grid(40);
  near.vertices.clear();
  for (const WidePoint& p : waves({0, 0, 0})) near.vertices.push_back(mesh_io::relative_point(p, {0, 0, 0}));
  const MeshCheck expected = check_mesh(near);
  for (const auto& [name, bytes] : wide_files(kFar)) {
    files::write_bytes(folder / name, bytes);
    const TriangleMesh mesh = read_mesh(folder / name);
    const MeshCheck check = check_mesh(mesh);
    EXPECT_EQ(mesh.vertices.size(), near.vertices.size()) << name;
    EXPECT_NEAR(check.area, expected.area, 1e-6 * expected.area) << name;
    EXPECT_EQ(check.zero_area_triangles, 0U) << name;
    EXPECT_NE(mesh.offset, (WidePoint{0, 0, 0})) << name;
    EXPECT_TRUE(mesh.notes.empty()) << name;
    for (const std::size_t v : {std::size_t{0}, std::size_t{700}}) {
      EXPECT_NEAR(mesh.offset[1] + double{mesh.vertices[v][1]}, kFar[1] + 0.1 * static_cast<double>(v / 41), 1e-6)
          << name;
    }
  }
}

TEST(WideCoordinates, NearTheOriginEveryFloatIsTheNearest) {
  const files::Folder folder;
  const std::vector<WidePoint> points = waves({10.1, -3.7, 0});
  for (const auto& [name, bytes] : wide_files({10.1, -3.7, 0})) {
    files::write_bytes(folder / name, bytes);
    const TriangleMesh mesh = read_mesh(folder / name);
    EXPECT_EQ(mesh.offset, (WidePoint{0, 0, 0})) << name;
    ASSERT_EQ(mesh.vertices.size(), points.size()) << name;
    if (name == "a.stl") continue;  // numbered as its triangles name them
    for (std::size_t v = 0; v < points.size(); ++v) {
      EXPECT_EQ(mesh.vertices[v], mesh_io::relative_point(points[v], {0, 0, 0})) << name;
    }
  }
}

TEST(WideCoordinates, AVertexOfNoTriangleMayLieAnywhere) {
  const files::Folder folder;
  files::write_bytes(folder / "a.obj", "v 1e30 0.1 0\nv 0.1 0 0\nv 1.1 0 0\nv 0.1 1 0\nf 2 3 4\n");
  const TriangleMesh mesh = read_mesh(folder / "a.obj");
  EXPECT_EQ(mesh.offset, (WidePoint{0, 0, 0}));
  EXPECT_EQ(mesh.vertices[0][0], 1e30F);
}

TEST(WideCoordinates, WhatNoOffsetMendsIsNoted) {
  const files::Folder folder;
  // A small triangle at each of two places that are far from each other.
  files::write_bytes(
      folder / "a.obj",
      "v 0 0 0\nv .01 0 0\nv 0 .01 0\nv 5000000 0 0\nv 5000000.01 0 0\nv 5000000 .01 0\nf 1 2 3\nf 4 5 6\n");
  const TriangleMesh mesh = read_mesh(folder / "a.obj");
  EXPECT_EQ(mesh.offset, (WidePoint{0, 0, 0}));
  ASSERT_EQ(mesh.notes.size(), 1U);
  EXPECT_NE(mesh.notes[0].find("rounded to 32 bits"), std::string::npos) << mesh.notes[0];
}

TEST(WideCoordinates, AnOffsetThatIsOfNoUseIsNotTaken) {
  const files::Folder folder;
  for (const char* offset : {"1e30,0,0", "-5e6,0,0", "x", "1,2,3,4"}) {
    files::write_bytes(folder / "a.obj",
                       std::string("# OFFSET=") + offset + "\nv 0.1 0 0\nv 1.1 0 0\nv 0.1 1 0\nf 1 2 3\n");
    EXPECT_EQ(read_mesh(folder / "a.obj").offset, (WidePoint{0, 0, 0})) << offset;
  }
}

// What relative_point says of sums: floats of all sizes, offsets of few and of many digits.
TEST(WideCoordinates, SumsWithAnOffsetComeBackAlways) {
  std::mt19937_64 random(7);
  const auto number = [&](int low, int high) {
    const int exponent = low + static_cast<int>(random() % static_cast<std::uint64_t>(high - low));
    return std::ldexp(1 + std::generate_canonical<double, 53>(random), exponent) * (random() % 2 == 0 ? 1 : -1);
  };
  for (int n = 0; n < 300000; ++n) {
    const double offset = n % 3 == 0   ? std::floor(number(0, 30))
                          : n % 3 == 1 ? number(-3, 30)
                                       : std::ldexp(1.0, n % 31);
    const auto coordinate = static_cast<float>(number(-60, n % 2 == 0 ? 10 : -20));
    const double sum = offset + double{coordinate};
    const auto back = static_cast<float>(sum - offset);
    ASSERT_EQ(offset + double{back}, sum) << offset << " " << coordinate;
    const double last = std::nextafter(std::abs(sum), HUGE_VAL) - std::abs(sum);
    if (std::abs(coordinate) >= std::ldexp(last, 25)) {
      ASSERT_EQ(back, coordinate) << offset << " " << coordinate;
    }
  }
}

TEST(MatchPlace, ConvertsTheUnitAndTurnsTheAxes) {
  TriangleMesh um = meshes::cube();
  um.unit = "um";
  um.space = "RAS";
  um.offset = {1000, 2000, 3000};
  um.normals.assign(8, {1, 0, 0});
  TriangleMesh mm;
  mm.unit = "mm";
  mm.space = "LPS";
  EXPECT_EQ(match_place(um, mm), (std::vector<std::string>{"turned from RAS to LPS", "converted from um to mm"}));
  EXPECT_EQ(um.vertices[7], (Point{-0.001F, -0.001F, 0.001F}));
  EXPECT_EQ(um.offset, (WidePoint{-1, -2, 3}));
  EXPECT_EQ(um.normals[0], (Point{-1, -0.0F, 0}));
  EXPECT_EQ(um.unit, "mm");
  EXPECT_EQ(um.space, "LPS");
  EXPECT_NEAR(check_mesh(um).volume, 1e-9, 1e-15);
}

TEST(MatchPlace, SaysWhatItAssumesAndRefusesTheIndexSpace) {
  TriangleMesh mesh = meshes::cube();
  TriangleMesh other = meshes::cube();
  EXPECT_TRUE(match_place(mesh, other).empty());
  other.unit = "um";
  other.space = "index";
  EXPECT_EQ(match_place(mesh, other),
            (std::vector<std::string>{
                "only one of the meshes says its space, index: that of the other one is taken for the same",
                "only one of the meshes says its unit, um: that of the other one is taken for the same"}));
  mesh.space = "RAS";
  EXPECT_THROW(match_place(mesh, other), std::invalid_argument);
}

TEST(Offsets, DistancesAreThoseOfThePlaces) {
  TriangleMesh a = meshes::cube();
  a.offset = {5e6, 1e6, 0};
  TriangleMesh b = meshes::cube();
  b.offset = {5e6 - 1, 1e6, 0};
  for (Point& p : b.vertices) p[0] += 1.25F;
  TriangleMesh same = b;
  for (Point& p : same.vertices) p[0] -= 1;
  same.offset = a.offset;
  const MeshDistance expected = compare_meshes(a, same, {.samples = 1000});
  EXPECT_NEAR(expected.max, 0.25, 1e-6);
  EXPECT_EQ(compare_meshes(a, b, {.samples = 1000}).max, expected.max);
  EXPECT_EQ(compare_meshes(a, b, {.samples = 1000}).mean, expected.mean);
  EXPECT_EQ(vertex_distances(a, b), vertex_distances(a, same));
  TriangleMesh absolute = a;
  move_to_offset(absolute, {0, 0, 0});
  EXPECT_EQ(absolute.vertices[7], (Point{5e6F + 1, 1e6F + 1, 1}));
  EXPECT_EQ(compare_meshes(absolute, a, {.samples = 1000}).max, 0);
}

TEST(Offsets, TheDigestIsThatOfTheSums) {
  const Point a{1, 2, 3}, b{4, 5, 6}, c{7, 8, 10};
  const std::array<double, 3> offset{5e6, 0.25, -1};
  EXPECT_EQ(triangle_digest(a, b, c, {0, 0, 0}), triangle_digest(a, b, c));
  EXPECT_NE(triangle_digest(a, b, c, offset), triangle_digest(a, b, c));
  EXPECT_EQ(triangle_digest(a, b, c, offset), triangle_digest(b, c, a, offset));
  EXPECT_EQ(triangle_digest(a, b, c, offset), triangle_digest(c, a, b, offset));
  EXPECT_NE(triangle_digest(a, b, c, offset), triangle_digest(a, c, b, offset));
  EXPECT_EQ(triangle_digest(a, a, b, offset), triangle_digest(a, b, a, offset));
  EXPECT_EQ(triangle_digest(a, a, b, offset), triangle_digest(b, a, a, offset));
  EXPECT_EQ(triangle_digest({2, 2, 3}, {5, 5, 6}, {8, 8, 10}, {5e6 - 1, 0.25, -1}), triangle_digest(a, b, c, offset));
  EXPECT_EQ(triangle_digest({0, -0.0F, 1}, b, c, {5, -0.0, -1}), triangle_digest({0, 0, 1}, b, c, {5, 0, -1}))
      << "0 and -0 are one place";
}

TEST(Check, CountsCornersInOnePlaceAndTrianglesWithoutArea) {
  TriangleMesh mesh = meshes::cube();
  mesh.vertices[1] = mesh.vertices[0];
  const MeshCheck check = check_mesh(mesh);
  EXPECT_EQ(check.degenerate_triangles, 0U);
  EXPECT_EQ(check.coincident_triangles, 2U);  // both along the edge from 0 to 1
  EXPECT_EQ(check.zero_area_triangles, 2U);
  mesh.vertices.push_back({2, 0, 0});
  mesh.vertices.push_back({4, 0, 0});
  mesh.vertices.push_back({3, 0, 0});
  mesh.triangles.push_back({8, 9, 10});
  mesh.triangles.push_back({8, 8, 9});
  EXPECT_EQ(check_mesh(mesh).degenerate_triangles, 1U);
  EXPECT_EQ(check_mesh(mesh).coincident_triangles, 2U);
  EXPECT_EQ(check_mesh(mesh).zero_area_triangles, 4U);
}

}  // namespace
}  // namespace isoweave::testing::read_mesh_place_test
