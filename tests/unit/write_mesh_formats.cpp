// What the writers of OFF, GLB, VTP, 3MF and neuroglancer's meshes put on the disk. Round trips are in read_mesh_*.cpp.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "files.hpp"
#include "files/zip_archive.hpp"
#include "isoweave/error.hpp"
#include "isoweave/measure.hpp"
#include "mesh/read/zip_input.hpp"
#include "mesh/write/mesh_file_sink.hpp"
#include "mesh/write/mesh_format.hpp"
#include "meshes.hpp"

namespace isoweave::testing::write_mesh_formats_test {
namespace {

using Json = nlohmann::json;

const std::vector<Point> kCorners{{0, 0.5F, -2}, {1, 0, 0}, {0.1F, 1, 0}};
const std::vector<Triangle64> kOneTriangle{{0, 1, 2}};

// In nanometres at RAS, with a comment that XML and JSON must escape.
MeshFileOptions full_options() {
  MeshFileOptions options;
  options.comments = {"a <b> & \"c\" -- d"};
  options.unit = "um";
  options.space = "RAS";
  return options;
}

void write_one_triangle(const std::string& path, const MeshFileOptions& options = full_options()) {
  const auto sink = open_mesh_file(path, options);
  sink->append({.vertices = kCorners,
                .normals = options.normals ? std::vector<Point>(3) : std::vector<Point>{},
                .triangles = kOneTriangle});
  sink->finish();
}

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof(word));
  return word;
}

float float_at(const std::string& bytes, std::size_t at) {
  float number = 0;
  std::memcpy(&number, bytes.data() + at, sizeof(number));
  return number;
}

Json glb_scene(const std::string& bytes) { return Json::parse(bytes.substr(20, word_at(bytes, 12))); }

// Where the data of a view begin.
std::size_t glb_data(const std::string& bytes, const Json& scene, std::size_t view) {
  return 20 + word_at(bytes, 12) + 8 + scene["bufferViews"][view]["byteOffset"].get<std::size_t>();
}

TEST(MeshFormats, AreToldByTheEndingInAnyCase) {
  EXPECT_EQ(mesh_format("a.b/c.PLY"), MeshFormat::kPly);
  EXPECT_EQ(mesh_format("a.precomputed/"), MeshFormat::kPrecomputed);
  for (const char* path : {"", "ply", "a.png", "a.ply/", "a.ply/b"})
    EXPECT_THROW(mesh_format(path), CannotWrite) << path;
  EXPECT_TRUE(holds_values(MeshFormat::kVtp));
  EXPECT_FALSE(holds_values(MeshFormat::kStl));
}

TEST(WriteOff, HasCountsInALineOfTheirOwn) {
  const files::Folder folder;
  write_one_triangle(folder / "a.off");
  EXPECT_EQ(files::read_bytes(folder / "a.off"),
            "OFF\n# a <b> & \"c\" -- d\n# SPACE=RAS\n# UNIT=um\n# padding ......................................\n"
            "3 1 0\n0 0.5 -2\n1 0 0\n0.1 1 0\n3 0 1 2\n");
}

TEST(WriteGlb, SceneSaysWhereEverythingIs) {
  const files::Folder folder;
  MeshFileOptions options = full_options();
  options.normals = true;
  write_one_triangle(folder / "a.glb", options);
  const std::string bytes = files::read_bytes(folder / "a.glb");
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word_at(bytes, 4), 2U);
  EXPECT_EQ(word_at(bytes, 8), bytes.size());
  const Json scene = glb_scene(bytes);
  const std::size_t chunk = 20 + word_at(bytes, 12);
  EXPECT_EQ(chunk % 4, 0U);
  EXPECT_EQ(word_at(bytes, chunk), 3U * 12 + 3 * 12 + 12);
  EXPECT_EQ(bytes.substr(chunk + 4, 4), std::string("BIN\0", 4));
  EXPECT_EQ(scene["asset"]["extras"]["comments"], Json({"a <b> & \"c\" -- d"}));
  EXPECT_EQ(scene["asset"]["extras"]["unit"], "um");
  EXPECT_EQ(scene["asset"]["extras"]["space"], "RAS");
  const Json& primitive = scene["meshes"][0]["primitives"][0];
  const Json& positions = scene["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
  EXPECT_EQ(positions["count"], 3);
  EXPECT_EQ(positions["min"], Json({0.0, 0.0, -2.0}));
  EXPECT_EQ(positions["max"].get<std::vector<double>>(), (std::vector<double>{1, 1, 0}));
  EXPECT_EQ(float_at(bytes, glb_data(bytes, scene, 0) + 24), 0.1F);
  EXPECT_EQ(float_at(bytes, glb_data(bytes, scene, 1) + 8), 1.0F) << "a normal of no direction points up";
  EXPECT_EQ(word_at(bytes, glb_data(bytes, scene, 2) + 8), 2U);
}

// Turns p by a quaternion.
std::array<double, 3> turned(const std::vector<double>& q, const std::array<double, 3>& p) {
  const auto cross = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const std::array<double, 3> axis{q[0], q[1], q[2]};
  std::array<double, 3> inner = cross(axis, p);
  for (std::size_t i = 0; i < 3; ++i) inner[i] += q[3] * p[i];
  const std::array<double, 3> outer = cross(axis, inner);
  return {p[0] + 2 * outer[0], p[1] + 2 * outer[1], p[2] + 2 * outer[2]};
}

TEST(WriteGlb, TheNodeTurnsUpwardsAndScalesToMetres) {
  const files::Folder folder;
  struct Case {
    const char* space;
    std::array<double, 3> left, front;  // of the patient
  };
  for (const Case& c :
       {Case{"LPS", {1, 0, 0}, {0, -1, 0}}, {"RAS", {-1, 0, 0}, {0, 1, 0}}, {"", {1, 0, 0}, {0, -1, 0}}}) {
    MeshFileOptions options;
    options.space = c.space;
    options.unit = "mm";
    write_one_triangle(folder / "a.glb", options);
    const Json node = glb_scene(files::read_bytes(folder / "a.glb"))["nodes"][0];
    EXPECT_EQ(node["scale"], Json({1e-3, 1e-3, 1e-3}));
    const auto rotation = node["rotation"].get<std::vector<double>>();
    const auto expect_near = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-12);
    };
    // glTF: y is up, z is in front, and -x is on the right.
    expect_near(turned(rotation, {0, 0, 1}), {0, 1, 0});
    expect_near(turned(rotation, c.left), {1, 0, 0});
    expect_near(turned(rotation, c.front), {0, 0, 1});
  }
  write_one_triangle(folder / "a.glb", {});
  const Json scene = glb_scene(files::read_bytes(folder / "a.glb"));
  EXPECT_EQ(scene["nodes"][0]["scale"], Json({1e-3, 1e-3, 1e-3})) << "no unit is mm";
  EXPECT_EQ(scene["meshes"][0]["name"], "a");
  EXPECT_EQ(scene["materials"][scene["meshes"][0]["primitives"][0]["material"].get<std::size_t>()]
                 ["pbrMetallicRoughness"]["metallicFactor"],
            0);
}

TEST(WriteGlb, PlaceForTheSceneSufficesForLongNumbers) {
  const files::Folder folder;
  const auto sink = open_mesh_file(folder / "a.glb");
  const float tiny = -1.1754944e-38F;
  sink->append({.vertices = std::vector<Point>{{tiny, tiny, tiny}, {-3.4028235e38F, 1.1754944e-38F, 0.1F}},
                .triangles = std::vector<Triangle64>(100000, {0, 1, 0})});
  sink->finish();
  EXPECT_EQ(read_mesh(folder / "a.glb").triangles.size(), 100000U);
}

TEST(WriteGlb, PointsAloneArePoints) {
  const files::Folder folder;
  const auto sink = open_mesh_file(folder / "a.glb");
  sink->append({.vertices = kCorners});
  sink->finish();
  const Json scene = glb_scene(files::read_bytes(folder / "a.glb"));
  EXPECT_EQ(scene["meshes"][0]["primitives"][0]["mode"], 0);
  EXPECT_EQ(read_mesh(folder / "a.glb").vertices.size(), 3U);
}

TEST(WriteGlb, AnEmptyMeshIsAnEmptyScene) {
  const files::Folder folder;
  open_mesh_file(folder / "a.glb")->finish();
  const Json scene = glb_scene(files::read_bytes(folder / "a.glb"));
  EXPECT_EQ(scene["scenes"].dump(), R"([{"name":"empty"}])");
  EXPECT_FALSE(scene.contains("nodes"));
}

TEST(WriteGlb, FourGibibytesAreTheMost) {
  EXPECT_NO_THROW(check_glb_fits("a.glb", 1000, 1000, false, 0xffffffffU - 24000));
  EXPECT_THROW(check_glb_fits("a.glb", 1000, 1000, false, 0xffffffffU - 23999), CannotWrite);
  EXPECT_THROW(check_glb_fits("a.glb", ~std::uint64_t{0}, 0, true, 0), CannotWrite) << "the product wraps around";
  EXPECT_NO_THROW(mesh_file_bytes("a.glb", 100'000'000, 200'000'000));
  EXPECT_THROW(mesh_file_bytes("a.glb", 200'000'000, 200'000'000), CannotWrite);
}

TEST(WriteVtp, OffsetsLeadToTheArrays) {
  const files::Folder folder;
  MeshFileOptions options = full_options();
  options.normals = true;
  write_one_triangle(folder / "a.vtp", options);
  const std::string bytes = files::read_bytes(folder / "a.vtp");
  EXPECT_NE(bytes.find("<!-- a <b> & \"c\" - - d -->"), std::string::npos);
  EXPECT_NE(bytes.find("Name=\"SPACE\" NumberOfTuples=\"1\" format=\"ascii\">82 65 83 0<"), std::string::npos);
  const std::size_t data = bytes.find("\n_") + 2;
  const auto offset_of = [&](const std::string& name) {
    const std::size_t at = bytes.find("offset=\"", bytes.find("Name=\"" + name)) + 8;
    return data + std::stoul(bytes.substr(at, bytes.find('"', at) - at));
  };
  EXPECT_EQ(word_at(bytes, offset_of("Points")), 36U);
  EXPECT_EQ(word_at(bytes, offset_of("Normals")), 36U);
  EXPECT_EQ(word_at(bytes, offset_of("connectivity")), 24U);
  EXPECT_EQ(word_at(bytes, offset_of("connectivity") + 8 + 16), 2U);
  EXPECT_EQ(word_at(bytes, offset_of("offsets")), 8U);
  EXPECT_EQ(word_at(bytes, offset_of("offsets") + 8), 3U);
  EXPECT_TRUE(bytes.ends_with("</AppendedData>\n</VTKFile>"));
}

TEST(WriteVtp, ValuesStandBehindNormals) {
  const files::Folder folder;
  for (const bool normals : {false, true}) {
    MeshFileOptions options = full_options();
    options.normals = normals;
    options.values = true;
    TriangleMesh mesh{kCorners, {{0, 1, 2}}};
    if (normals) mesh.normals = kCorners;
    mesh.values = {1.5F, -2, std::numeric_limits<float>::quiet_NaN()};
    write_mesh(folder / "a.vtp", mesh, options);
    const std::string bytes = files::read_bytes(folder / "a.vtp");
    EXPECT_NE(
        bytes.find(normals ? "<PointData Normals=\"Normals\" Scalars=\"value\">" : "<PointData Scalars=\"value\">"),
        std::string::npos);
    const std::size_t at = bytes.find("offset=\"", bytes.find("Name=\"value\"")) + 8;
    const std::size_t array = bytes.find("\n_") + 2 + std::stoul(bytes.substr(at, bytes.find('"', at) - at));
    EXPECT_EQ(word_at(bytes, array), 12U);
    EXPECT_EQ(float_at(bytes, array + 8), 1.5F);
    EXPECT_EQ(float_at(bytes, array + 12), -2.0F);
    EXPECT_EQ(read_mesh(folder / "a.vtp").triangles.size(), 1U);
    EXPECT_EQ(mesh_file_bytes("a.vtp", 3, 1, options), normals ? 116U : 80U);
  }
}

TEST(WritePly, ValuesAreItsQuality) {
  const files::Folder folder;
  TriangleMesh mesh{kCorners, {{0, 1, 2}}};
  mesh.values = {1.5F, -2, std::numeric_limits<float>::infinity()};
  MeshFileOptions options;
  write_mesh(folder / "a.ply", mesh, options);
  EXPECT_TRUE(read_mesh(folder / "a.ply").values.empty()) << "they were not asked for";
  options.values = true;
  for (const bool normals : {false, true}) {
    options.normals = normals;
    if (normals) mesh.normals = kCorners;
    write_mesh(folder / "a.ply", mesh, options);
    const TriangleMesh back = read_mesh(folder / "a.ply");
    EXPECT_EQ(back.vertices, mesh.vertices);
    EXPECT_EQ(back.triangles, mesh.triangles);
    EXPECT_EQ(back.normals, mesh.normals);
    ASSERT_EQ(back.values.size(), 3U);
    EXPECT_EQ(back.values[0], 1.5F);
    EXPECT_EQ(back.values[1], -2.0F);
    EXPECT_TRUE(std::isnan(back.values[2]));
  }
  mesh.values.pop_back();
  EXPECT_THROW(write_mesh(folder / "b.ply", mesh, options), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder / "b.ply"));
}

TEST(WriteMesh, ValuesNeedAFormatWithAPlaceForThem) {
  const files::Folder folder;
  MeshFileOptions options;
  options.values = true;
  for (const char* name : {"a.stl", "a.obj", "a.off", "a.glb", "a.3mf", "a.precomputed"}) {
    EXPECT_THROW(open_mesh_file(folder / name, options), CannotWrite) << name;
    EXPECT_THROW(mesh_file_bytes(name, 1, 1, options), CannotWrite) << name;
  }
  EXPECT_THROW(open_mesh_stream(1, "out", "stl", options), std::invalid_argument);
  EXPECT_TRUE(folder.entries().empty());
}

std::string model_of(const std::string& path) {
  mesh_io::MeshInput input(path);
  mesh_io::ZipText text(input, mesh_io::read_zip_directory(input).back());
  std::string model;
  for (int c = text.get(); c >= 0; c = text.get()) model.push_back(static_cast<char>(c));
  return model;
}

TEST(Write3mf, SaysUnitAndSpace) {
  const files::Folder folder;
  const std::vector<std::pair<std::string, std::string>> units{
      {"", "millimeter"}, {"mm", "millimeter"}, {"um", "micron"}, {"nm", "micron"}, {"m", "meter"}, {"in", "inch"}};
  for (const auto& [unit, name] : units) {
    MeshFileOptions options = full_options();
    options.unit = unit;
    write_one_triangle(folder / "a.3mf", options);
    const std::string model = model_of(folder / "a.3mf");
    EXPECT_NE(model.find("<model unit=\"" + name + "\""), std::string::npos) << unit;
    EXPECT_EQ(model.find(" transform=\"0.001 ") != std::string::npos, unit == "nm");
    EXPECT_NE(model.find("a &lt;b&gt; &amp; &quot;c&quot; -- d; SPACE=RAS"), std::string::npos);
    EXPECT_NE(model.find("<vertex x=\"0\" y=\"0.5\" z=\"-2\"/>\n"), std::string::npos);
    EXPECT_NE(model.find("<triangle v1=\"0\" v2=\"1\" v3=\"2\"/>\n"), std::string::npos);
  }
  EXPECT_THROW(mesh_file_bytes("a.3mf", (std::uint64_t{1} << 31) + 1, 1), CannotWrite);
}

// Text longer than a block, so that blocks are put together.
TEST(Write3mf, ManyBlocksAreOneStream) {
  const files::Folder folder;
  const TriangleMesh mesh = meshes::grid(150);
  std::vector<Triangle64> triangles;
  for (const auto& t : mesh.triangles) triangles.push_back({t[0], t[1], t[2]});
  const auto sink = open_mesh_file(folder / "a.3mf");
  sink->append({.vertices = mesh.vertices, .triangles = triangles});
  sink->finish();
  EXPECT_GT(model_of(folder / "a.3mf").size(), std::size_t{2} << 20);
  EXPECT_EQ(check_mesh(read_mesh(folder / "a.3mf")).digest, check_mesh(mesh).digest);
}

TEST(ZipArchive, OffsetsBeyond32BitsAreFound) {
  const files::Folder folder;
  const std::string path = folder / "a.zip";
  constexpr std::uint64_t kFar = (std::uint64_t{1} << 32) + 1000;  // a hole takes no room
  ZipEntry entry{"far.model", false, zip_crc(0, "hello"), 5, 5, kFar};
  const auto text_of = [](const std::vector<std::byte>& bytes) {
    std::string text;
    for (const std::byte byte : bytes) text.push_back(static_cast<char>(byte));
    return text;
  };
  files::write_bytes(path, "");
  std::filesystem::resize_file(path, kFar);
  const std::string header = text_of(zip_header(entry));
  const std::string end = text_of(zip_directory(std::span(&entry, 1), kFar + header.size() + 5));
  std::ofstream(path, std::ios::binary | std::ios::app) << header << "hello" << end;
  EXPECT_EQ(model_of(path), "hello");
}

TEST(ZipArchive, SizesBeyond32BitsAreInTheFieldForThem) {
  const ZipEntry entry{"m", true, 1, std::uint64_t{5} << 32, std::uint64_t{6} << 32, 0};
  const std::vector<std::byte> header = zip_header(entry);
  EXPECT_EQ(header.size(), zip_header({"m", true, 1, 2, 3, 0}).size()) << "it is written over the first one";
  EXPECT_EQ(header[18], std::byte{0xff});
  EXPECT_EQ(header[31], std::byte{1}) << "the field of ZIP64";
  EXPECT_EQ(header[31 + 4 + 4], std::byte{6});
  EXPECT_EQ(header[31 + 12 + 4], std::byte{5});
}

TEST(WritePrecomputed, IsAFolderInNanometres) {
  const files::Folder folder;
  MeshFileOptions options = full_options();
  options.segment = 42;
  std::filesystem::create_directory(folder / "a.precomputed");  // an empty folder may be there
  write_one_triangle(folder / "a.precomputed/", options);
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"a.precomputed"});
  EXPECT_EQ(Json::parse(files::read_bytes(folder / "a.precomputed/info"))["@type"], "neuroglancer_legacy_mesh");
  const Json object = Json::parse(files::read_bytes(folder / "a.precomputed/42:0"));
  ASSERT_EQ(object["fragments"].size(), 1U);
  const std::string bytes = files::read_bytes(folder / ("a.precomputed/" + object["fragments"][0].get<std::string>()));
  ASSERT_EQ(bytes.size(), 4U + 3 * 12 + 12);
  EXPECT_EQ(word_at(bytes, 0), 3U);
  EXPECT_EQ(float_at(bytes, 4 + 8), -2000.0F);
  EXPECT_EQ(word_at(bytes, 4 + 36 + 8), 2U);
}

TEST(WritePrecomputed, NothingIsWrittenOver) {
  const files::Folder folder;
  std::filesystem::create_directory(folder / "a.precomputed");
  files::write_bytes(folder / "a.precomputed/info", "precious");
  EXPECT_THROW(open_mesh_file(folder / "a.precomputed"), CannotWrite);
  files::write_bytes(folder / "b.precomputed", "precious");
  EXPECT_THROW(open_mesh_file(folder / "b.precomputed"), CannotWrite);
  EXPECT_THROW(open_mesh_file(folder / "missing/c.precomputed"), CannotWrite);
  // It came while the mesh was made.
  const auto sink = open_mesh_file(folder / "d.precomputed");
  std::filesystem::create_directory(folder / "d.precomputed");
  files::write_bytes(folder / "d.precomputed/info", "precious");
  EXPECT_THROW(sink->finish(), CannotWrite);
  EXPECT_EQ(folder.entries().size(), 3U);
}

TEST(WritePrecomputed, AMissingUnitIsTold) {
  const files::Folder folder;
  const auto sink = open_mesh_file(folder / "a.precomputed");
  sink->finish();
  ASSERT_EQ(sink->notes().size(), 1U);
  EXPECT_EQ(sink->notes()[0], (folder / "a.precomputed") + ": the unit is not said, coordinates were taken for mm");
}

TEST(WriteMesh, SpaceAndUnitAreInEveryFile) {
  const files::Folder folder;
  for (const std::string name : {"a.ply", "a.obj", "a.off", "a.stl"}) {
    write_one_triangle(folder / name);
    const std::string bytes = files::read_bytes(folder / name);
    EXPECT_NE(bytes.find("SPACE=RAS"), std::string::npos) << name;
    EXPECT_NE(bytes.find("UNIT=um"), std::string::npos) << name;
  }
}

TEST(WriteMesh, OnlySomeFormatsAreCompressed) {
  MeshFileOptions options;
  options.compress = true;
  const files::Folder folder;
  for (const char* name : {"a.ply", "a.stl", "a.obj", "a.off", "a.vtp", "a.3mf"}) {
    EXPECT_THROW(open_mesh_file(folder / name, options), CannotWrite) << name;
    EXPECT_THROW(mesh_file_bytes(folder / name, 1, 1, options), CannotWrite) << name;
  }
  EXPECT_THROW(open_mesh_file(folder / "a.ply", {.normals = false, .comments = {}, .segment = 2}), CannotWrite);
  EXPECT_THROW(open_mesh_file(folder / "a.precomputed", {.normals = false, .comments = {}, .segment = 0}), CannotWrite);
  EXPECT_EQ(mesh_file_memory("a.glb", 1000, 1000), 0U);
  EXPECT_GT(mesh_file_memory("a.glb", 1000, 1000, options), 24000U);
  EXPECT_GT(mesh_file_memory("a.precomputed", 1000, 1000, options), 24000U);
  EXPECT_EQ(mesh_file_memory("a.stl", 1000, 1000), 12000U);
}

// A pipe with room for a small mesh.
class Pipe {
 public:
  Pipe() {
    if (::pipe(ends_.data()) != 0) throw std::runtime_error("no pipe");
  }
  ~Pipe() {
    close_reader();
    ::close(ends_[1]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int writer() const { return ends_[1]; }
  void close_reader() {
    if (ends_[0] >= 0) ::close(ends_[0]);
    ends_[0] = -1;
  }
  std::string read() {
    std::string bytes(4096, '\0');
    const ssize_t got = ::read(ends_[0], bytes.data(), bytes.size());
    bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return bytes;
  }

 private:
  std::array<int, 2> ends_{};
};

TEST(MeshStream, GivesTheBytesOfTheFile) {
  const files::Folder folder;
  for (const std::string format : {"ply", "stl"}) {
    write_one_triangle(folder / ("a." + format));
    Pipe pipe;
    const auto sink = open_mesh_stream(pipe.writer(), "a pipe", format, full_options());
    sink->append({.vertices = kCorners, .triangles = kOneTriangle});
    sink->finish();
    EXPECT_EQ(pipe.read(), files::read_bytes(folder / ("a." + format)));
  }
}

TEST(MeshStream, FailuresAreErrors) {
  EXPECT_THROW(open_mesh_stream(1, "a pipe", "obj"), std::invalid_argument);
  const files::Folder folder;
  MeshFileOptions kept;
  kept.parts = folder.path();
  EXPECT_THROW(open_mesh_stream(1, "a pipe", "ply", kept), std::invalid_argument);
  void (*handler)(int) = std::signal(SIGPIPE, SIG_IGN);
  Pipe pipe;
  pipe.close_reader();
  const auto sink = open_mesh_stream(pipe.writer(), "a pipe", "ply");
  try {
    sink->finish();
    ADD_FAILURE() << "nobody reads";
  } catch (const CannotWrite& error) {
    EXPECT_EQ(std::string(error.what()), "a pipe: cannot write: Broken pipe");
  }
  EXPECT_THROW(open_mesh_stream(-1, "closed", "ply")->finish(), CannotWrite);
  std::signal(SIGPIPE, handler);
}

}  // namespace
}  // namespace isoweave::testing::write_mesh_formats_test
