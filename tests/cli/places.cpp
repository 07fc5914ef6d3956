// Space, unit and place of meshes on their way through all verbs.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_places_test {
namespace {

using Json = nlohmann::json;
using program::Result;
using program::run;

Result succeed(const files::Folder& folder, const std::vector<std::string>& arguments) {
  const Result result = run(folder.path(), arguments);
  EXPECT_EQ(result.code, 0) << result.err;
  return result;
}

Json check(const files::Folder& folder, const std::string& name) {
  return Json::parse(succeed(folder, {"check", name, "--json"}).out);
}

// A ball of bytes, in a file whose header says what `lines` say.
void write_ball(const std::string& path, const std::string& lines) {
  std::string bytes = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 20 20 20\nencoding: raw\n" + lines + "\n";
  for (int n = 0; n < 8000; ++n) {
    const int x = n % 20 - 9, y = n / 20 % 20 - 9, z = n / 400 - 9;
    bytes += static_cast<char>(x * x + y * y + z * z < 36 ? 200 - (x * x + y * y + z * z) : 60);
  }
  files::write_bytes(path, bytes);
}

constexpr const char* kInMicrons =
    "space: RAS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace units: \"um\" \"um\" \"um\"\n";
constexpr const char* kUtm =
    "space dimension: 3\nspace directions: (0.01,0,0) (0,0.01,0) (0,0,0.01)\nspace origin: "
    "(500000.1,4649776.7,120.3)\n";
constexpr const char* kNear =
    "space dimension: 3\nspace directions: (0.01,0,0) (0,0.01,0) (0,0,0.01)\nspace origin: (0,0,0)\n";

TEST(CliPlaces, SpaceAndUnitGoThroughSimplifyInEveryFormat) {
  const files::Folder folder;
  write_ball(folder / "um.nrrd", kInMicrons);
  for (const std::string name : {"a.ply", "a.stl", "a.obj", "a.off", "a.glb", "a.vtp", "a.3mf"}) {
    succeed(folder, {"mesh", "um.nrrd", "--iso", "130", "--error", "0", "-o", name});
    const std::string by_unit = "b" + name.substr(1), plain = "c" + name.substr(1);
    succeed(folder, {"simplify", name, "-o", by_unit, "--error", "500nm", "--report", "b.json"});
    succeed(folder, {"simplify", name, "-o", plain, "--error", "0.5"});
    const Json found = check(folder, by_unit);
    EXPECT_EQ(found["unit"], "um") << name;
    EXPECT_EQ(found["space"], "RAS") << name;
    EXPECT_EQ(found["digest"], check(folder, plain)["digest"]) << name;
    EXPECT_LT(found["triangles"], check(folder, name)["triangles"]) << name;
    const Json report = Json::parse(files::read_bytes(folder / "b.json"));
    EXPECT_EQ(report["input"]["unit"], "um");
    EXPECT_EQ(report["input"]["space"], "RAS");
  }
  const Result text = succeed(folder, {"check", "b.ply"});
  EXPECT_NE(text.out.find("unit                                  um\n"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("space                                RAS\n"), std::string::npos) << text.out;
}

TEST(CliPlaces, InchesStayInches) {
  const files::Folder folder;
  files::write_bytes(folder / "a.obj", "# UNIT=inches\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
  std::string before = "a.obj";
  for (const std::string name : {"b.3mf", "b.glb", "b.ply", "c.3mf", "b.vtp"}) {
    succeed(folder, {"simplify", before, "-o", name, "--error", "1mm"});
    EXPECT_EQ(check(folder, name)["unit"], "in") << name;
    EXPECT_EQ(check(folder, name)["area"], 1) << name;
    before = name;
  }
  const Result left = succeed(folder, {"simplify", "b.ply", "-o", "d.ply", "--triangles", "1"});
  EXPECT_NE(left.err.find(" within an error of 0.0707107 in keeps"), std::string::npos) << left.err;
}

TEST(CliPlaces, AMetricLengthWithoutAUnitSaysWhatIsAssumed) {
  const files::Folder folder;
  succeed(folder, {"mesh", "generate:gyroid:16x16x16", "--iso", "0", "--error", "0", "-o", "a.ply"});
  const std::string assumed =
      "isoweave: a.ply: does not say its unit: lengths are taken for it to be mm, and so it is 15.0";
  const std::vector<std::string> simplify{"simplify", "a.ply", "-o", "b.ply"};
  for (const auto& [stop, said] : {std::pair<std::vector<std::string>, bool>{{"--error", "0.1mm"}, true},
                                   {{"--lods", "0.1,200um"}, true},
                                   {{"--error", "0.01inches"}, true},
                                   {{"--error", "0.1", "--max-distance", "1mm"}, true},
                                   {{"--error", "0.1vox"}, false},
                                   {{"--error", "0.1"}, false}}) {
    std::vector<std::string> arguments = simplify;
    arguments.insert(arguments.end(), stop.begin(), stop.end());
    EXPECT_EQ(succeed(folder, arguments).err.find(assumed) != std::string::npos, said) << stop.back();
  }
  EXPECT_NE(succeed(folder, {"mesh", "generate:gyroid:16x16x16", "--iso", "0", "--error", "0.1mm", "-o", "c.ply"})
                .err.find("does not say its unit: lengths are taken for it to be mm"),
            std::string::npos);
}

TEST(CliPlaces, CompareConvertsAndSaysSo) {
  const files::Folder folder;
  files::write_bytes(folder / "a.obj", "# UNIT=um SPACE=LPS\nv 0 0 0\nv 1000 0 0\nv 0 1000 0\nf 1 2 3\n");
  files::write_bytes(folder / "b.obj", "# UNIT=mm\n# SPACE=RAS\nv 0 0 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\n");
  files::write_bytes(folder / "c.obj", "v 0 0 0\nv 1000 0 0\nv 0 1000 0\nf 1 2 3\n");
  files::write_bytes(folder / "d.obj", "# SPACE=index\nv 0 0 0\nv 1000 0 0\nv 0 1000 0\nf 1 2 3\n");
  const Result converted = succeed(folder, {"compare", "a.obj", "b.obj", "--samples", "100", "--distances", "d.ply"});
  EXPECT_EQ(converted.err, "isoweave: b.obj: turned from RAS to LPS\nisoweave: b.obj: converted from mm to um\n");
  EXPECT_NE(converted.out.find("distance in um"), std::string::npos);
  const Json json = Json::parse(succeed(folder, {"compare", "a.obj", "b.obj", "--samples", "100", "--json"}).out);
  EXPECT_LT(json["both"]["max"], 1e-3);
  EXPECT_EQ(json["unit"], "um");
  EXPECT_EQ(json["notes"].size(), 2U);
  EXPECT_EQ(check(folder, "d.ply")["unit"], "um");
  EXPECT_EQ(check(folder, "d.ply")["space"], "LPS");
  const Result assumed = succeed(folder, {"compare", "a.obj", "c.obj", "--samples", "100"});
  EXPECT_NE(assumed.err.find("c.obj: only one of the meshes says its unit, um"), std::string::npos) << assumed.err;
  program::expect_failed(run(folder.path(), {"compare", "a.obj", "d.obj"}), 3,
                         "d.obj: cannot be compared with a.obj: expected meshes in one space, found LPS and index");
}

TEST(CliPlaces, AVolumeFarAwayIsMeshedAsNearTheOrigin) {
  const files::Folder folder;
  write_ball(folder / "utm.nrrd", kUtm);
  write_ball(folder / "near.nrrd", kNear);
  succeed(folder, {"mesh", "near.nrrd", "--iso", "130", "-o", "near.ply"});
  const Json near = check(folder, "near.ply");
  for (const std::string name : {"a.ply", "a.vtp", "a.obj", "a.off", "a.glb", "a.3mf"}) {
    const Result meshed = succeed(folder, {"mesh", "utm.nrrd", "--iso", "130", "-o", name, "--report", "a.json"});
    EXPECT_EQ(meshed.err.find("warning"), std::string::npos) << meshed.err;
    const Json far = check(folder, name);
    const Json report = Json::parse(files::read_bytes(folder / "a.json"));
    EXPECT_EQ(far["digest"], report["digest"]) << name;
    EXPECT_EQ(report["offset"], (std::vector<double>{500000.1, 4649776.7, 120.3}));
    EXPECT_EQ(far["offset"], report["offset"]) << name;
    EXPECT_EQ(far["triangles"], near["triangles"]) << name;
    EXPECT_EQ(far["coincident_triangles"], 0) << name;
    EXPECT_NEAR(far["area"].get<double>(), near["area"].get<double>(), 1e-6) << name;
    EXPECT_NEAR(far["volume"].get<double>(), near["volume"].get<double>(), 1e-6) << name;
  }
  succeed(folder, {"simplify", "a.ply", "-o", "b.ply", "--error", "0.5vox"});
  succeed(folder, {"simplify", "near.ply", "-o", "c.ply", "--error", "0.5vox"});
  EXPECT_EQ(check(folder, "b.ply")["triangles"], check(folder, "c.ply")["triangles"]);
  EXPECT_EQ(check(folder, "b.ply")["area"], check(folder, "c.ply")["area"]);
  EXPECT_EQ(check(folder, "b.ply")["offset"], check(folder, "a.ply")["offset"]);
}

TEST(CliPlaces, StlSaysHowFarItMovesVertices) {
  const files::Folder folder;
  write_ball(folder / "utm.nrrd", kUtm);
  const Result meshed = succeed(folder, {"mesh", "utm.nrrd", "--iso", "130", "--error", "0", "-o", "a.stl"});
  EXPECT_NE(meshed.err.find("warning: a.stl: so far from the origin coordinates of 32 bits move vertices by up to 0.2"),
            std::string::npos)
      << meshed.err;
  // Read from its 32 bits it has lost its shape, which the count of its corners says.
  succeed(folder, {"mesh", "utm.nrrd", "--iso", "130", "--error", "0", "-o", "a.ply"});
  std::string text = succeed(folder, {"check", "a.ply"}).out;
  EXPECT_EQ(text.find("corners in one place"), std::string::npos) << text;
  files::write_bytes(folder / "flat.obj", "v 0 0 0\nv 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\nf 1 3 2\n");
  text = succeed(folder, {"check", "flat.obj"}).out;
  EXPECT_NE(text.find(", 1 triangles with corners in one place\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace isoweave::testing::cli_places_test
