// mesh --one-file with several iso-values or labels: one file of named parts, each like the file of its own.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_parts_test {
namespace {

using nlohmann::json;
using program::listing;
using program::Result;
using program::run;

constexpr const char* kVolume = "generate:noise:24x22x20:uint8";
constexpr const char* kMap = "map_24x22x20_uint8.raw";

// Boxes of the labels 3, 8 and 200.
void write_map(const files::Folder& folder) {
  std::string bytes(std::size_t{24} * 22 * 20, '\0');
  const auto fill = [&](std::size_t from, std::size_t to, int label) {
    for (std::size_t k = 4; k < 15; ++k) {
      for (std::size_t j = 3; j < 18; ++j) {
        for (std::size_t i = from; i < to; ++i) bytes[(k * 22 + j) * 24 + i] = static_cast<char>(label);
      }
    }
  };
  fill(2, 9, 3);
  fill(9, 15, 8);
  fill(17, 22, 200);
  files::write_bytes(folder / kMap, bytes);
}

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

json report_of(const files::Folder& folder, const std::vector<std::string>& arguments) {
  const Result result = run(folder.path(), joined(arguments, {"--report", "r.json"}));
  EXPECT_EQ(result.code, 0) << result.err;
  return json::parse(files::read_bytes(folder / "r.json"));
}

std::string digest_of(const files::Folder& folder, const std::string& name) {
  return json::parse(run(folder.path(), {"check", name, "--json"}).out).at("digest");
}

// The data of the meshes of a GLB file, by the names of their nodes: positions, normals, corners.
struct Glb {
  explicit Glb(const std::string& path) {
    const std::string bytes = files::read_bytes(path);
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    scene = json::parse(bytes.substr(20, length));
    for (const json& node : scene.at("nodes")) {
      if (!node.contains("mesh")) continue;
      const json& mesh = scene.at("meshes").at(node.at("mesh").get<std::size_t>());
      const json& primitive = mesh.at("primitives").at(0);
      std::vector<std::string> arrays;
      for (const json& accessor : {primitive.at("attributes").at("POSITION"), primitive.at("attributes").at("NORMAL"),
                                   primitive.at("indices")}) {
        const std::size_t number = scene.at("accessors").at(accessor.get<std::size_t>()).at("bufferView");
        const json& view = scene.at("bufferViews").at(number);
        arrays.push_back(bytes.substr(28 + length + view.at("byteOffset").get<std::size_t>(), view.at("byteLength")));
      }
      data.push_back(arrays);
      names.push_back(node.value("name", ""));
      materials.push_back(scene.at("materials").at(primitive.at("material").get<std::size_t>()));
    }
  }

  json scene;
  std::vector<std::vector<std::string>> data;
  std::vector<std::string> names;
  std::vector<json> materials;
};

void expect_refused(const files::Folder& folder, const std::vector<std::string>& arguments, int code,
                    const std::string& says, const program::Setup& setup = {}) {
  SCOPED_TRACE(says);
  const std::vector<std::string> before = listing(folder);
  program::expect_failed(run(folder.path(), arguments, setup), code, says);
  EXPECT_EQ(listing(folder), before);
}

TEST(CliParts, OfIsoValuesAreTheMeshesOfTheirFiles) {
  const files::Folder folder;
  const std::vector<std::string> task{"mesh", kVolume, "--iso", "150,99.5,200"};
  const json report = report_of(folder, joined(task, {"-o", "a.glb", "--one-file"}));
  EXPECT_EQ(listing(folder), (std::vector<std::string>{"a.glb", "r.json"}));
  report_of(folder, joined(task, {"-o", "b.glb"}));
  const Glb parts(folder / "a.glb");
  EXPECT_EQ(parts.names, (std::vector<std::string>{"iso 150", "iso 99.5", "iso 200"}));
  std::set<std::string> colors;
  for (std::size_t n = 0; n < 3; ++n) {
    const json& entry = report.at("isos").at(n);
    EXPECT_EQ(entry.at("output"), "a.glb");
    EXPECT_EQ(entry.at("name"), parts.names[n]);
    const Glb own(folder / ("b_iso" + parts.names[n].substr(4) + ".glb"));
    EXPECT_EQ(parts.data[n], own.data[0]) << parts.names[n];
    colors.insert(entry.at("color").get<std::string>());
  }
  EXPECT_EQ(colors.size(), 3U);
  const auto opacity = [&](std::size_t n) {
    return parts.materials[n].at("pbrMetallicRoughness").at("baseColorFactor").at(3).get<double>();
  };
  EXPECT_EQ(opacity(2), 1) << "the innermost";
  EXPECT_LT(opacity(0), 1);
  EXPECT_LT(opacity(1), opacity(0)) << "the outermost lets the most be seen";
  EXPECT_EQ(digest_of(folder, "a.glb"), report.at("digest")) << "check sees all parts";
  report_of(folder, joined(task, {"-o", "a.vtp", "--one-file", "--inside", "below", "--normals", "gradient"}));
  EXPECT_EQ(json::parse(files::read_bytes(folder / "r.json")).at("isos").at(1).at("opacity"), 1) << "below is inside";
  report_of(folder, joined(task, {"-o", "a.vtp", "--one-file"}));
  EXPECT_EQ(digest_of(folder, "a.vtp"), report.at("digest"));
}

TEST(CliParts, OfLabelsHaveTheirNamesAndColours) {
  const files::Folder folder;
  write_map(folder);
  files::write_bytes(folder / "names.txt",
                     "3 Left<&>\\part 255 0 0 255\n200 Gr\xc3\xb6\xc3\x9f"
                     "e/.. 0 0 255 255\n");
  const std::vector<std::string> task{"mesh", kMap, "--labels", "all", "--label-names", "names.txt"};
  const json report = report_of(folder, joined(task, {"-o", "a.glb", "--one-file", "--smooth"}));
  EXPECT_EQ(listing(folder), (std::vector<std::string>{"a.glb", kMap, "names.txt", "r.json"}));
  const Glb parts(folder / "a.glb");
  EXPECT_EQ(parts.names, (std::vector<std::string>{"Left<&>\\part", "8",
                                                   "Gr\xc3\xb6\xc3\x9f"
                                                   "e/.."}));
  EXPECT_EQ(parts.materials[0].at("pbrMetallicRoughness").at("baseColorFactor").dump(), "[1.0,0.0,0.0,1.0]");
  EXPECT_EQ(parts.materials[2].at("pbrMetallicRoughness").at("baseColorFactor").dump(), "[0.0,0.0,1.0,1.0]");
  EXPECT_EQ(report.at("labels").at(0).at("color"), "#ff0000");
  EXPECT_NE(report.at("labels").at(1).at("color"), nullptr) << "of the palette";
  report_of(folder, joined(task, {"-o", "b.glb", "--smooth"}));
  const json own = json::parse(files::read_bytes(folder / "r.json"));
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(parts.data[n], Glb(folder / own.at("labels").at(n).at("output").get<std::string>()).data[0]);
  }
  EXPECT_EQ(digest_of(folder, "a.glb"), report.at("digest"));
  const json one = report_of(folder, {"mesh", kMap, "--labels", "8", "-o", "c.glb", "--one-file", "--smooth"});
  const Glb single(folder / "c.glb");
  EXPECT_EQ(single.names, std::vector<std::string>{"8"});
  EXPECT_EQ(single.data[0], parts.data[1]);
}

// Packed parts and levels lie where those of a plain file do, to a hundredth of a voxel.
TEST(CliParts, PackedOnesAreReadBack) {
  const files::Folder folder;
  const auto check = [&](const std::vector<std::string>& task, const std::string& name) {
    report_of(folder, joined(task, {"-o", name, "--one-file"}));
    return json::parse(run(folder.path(), {"check", name, "--json"}).out);
  };
  for (const std::vector<std::string>& task : std::vector<std::vector<std::string>>{
           {"mesh", kVolume, "--iso", "100,150"}, {"mesh", kVolume, "--iso", "150", "--lods", "0.1vox,0.5vox"}}) {
    if (run(folder.path(), joined(task, {"-o", "a.glb", "--one-file", "--compress"})).code == 4) {
      GTEST_SKIP() << "a build without meshoptimizer";
    }
    const json plain = check(task, "plain.glb");
    const json packed = check(joined(task, {"--compress"}), "packed.glb");
    for (const char* same : {"triangles", "vertices", "components", "euler"}) {
      EXPECT_EQ(packed.at(same), plain.at(same)) << same;
    }
    const Result compared = run(folder.path(), {"compare", "plain.glb", "packed.glb", "--samples", "20000", "--json"});
    EXPECT_LT(json::parse(compared.out).at("a_to_b").at("max").get<double>(), 0.01) << compared.err;
  }
}

TEST(CliParts, AnEmptyOneIsANodeAlone) {
  const files::Folder folder;
  write_map(folder);
  expect_refused(folder, {"mesh", kVolume, "--iso", "150,400", "-o", "a.glb", "--one-file"}, 3, "iso is 400");
  expect_refused(folder, {"mesh", kMap, "--labels", "8,77", "-o", "a.glb", "--one-file"}, 3, "label 77");
  report_of(folder, {"mesh", kVolume, "--iso", "400,150", "-o", "a.glb", "--one-file", "--allow-empty"});
  const Glb parts(folder / "a.glb");
  EXPECT_EQ(parts.names, std::vector<std::string>{"iso 150"});
  EXPECT_EQ(parts.scene.at("nodes").at(1).dump().find("mesh\""), std::string::npos);
  EXPECT_EQ(parts.scene.at("nodes").at(1).at("name"), "iso 400");
  report_of(folder, {"mesh", kMap, "--labels", "77,8", "-o", "b.vtp", "--one-file", "--allow-empty"});
  report_of(folder, {"mesh", kMap, "--labels", "8", "-o", "c.vtp"});
  EXPECT_EQ(digest_of(folder, "b.vtp"), digest_of(folder, "c_label8.vtp"));
}

TEST(CliParts, WrongUseIsRefused) {
  const files::Folder folder;
  write_map(folder);
  const std::vector<std::string> isos{"mesh", kVolume, "--one-file", "--iso", "100,150"};
  const std::vector<std::string> labels{"mesh", kMap, "--one-file", "--labels", "3,8"};
  for (const std::vector<std::string>& task : {isos, labels}) {
    for (const std::string name : {"a.ply", "a.stl", "a.3mf", "a.precomputed"}) {
      expect_refused(folder, joined(task, {"-o", name}), 2, "--one-file: expected a mesh named .glb or .vtp");
    }
    expect_refused(folder, joined(task, {"-o", "a.glb", "--checkpoint", "run"}), 2, "--checkpoint");
    expect_refused(folder, joined(task, {"-o", "a.glb", "--scale", "2"}), 2, "--one-file");
    expect_refused(folder, joined(task, {"-o", "none/a.glb"}), 4, "none/a.glb");
    expect_refused(folder, joined(task, {"-o", "a.vtp", "--compress"}), 4, "a.vtp: expected a name that ends in .glb");
    expect_refused(folder, joined(task, {"-o", "a.glb", "--report", "a.glb"}), 2, "a.glb");
  }
  expect_refused(folder, {"mesh", kVolume, "--one-file", "--iso", "100", "-o", "a.glb"}, 2,
                 "--one-file: expected several levels by --lods or, of a volume, several surfaces by --iso");
}

TEST(CliParts, AFileThatIsThereIsKeptOrReplacedWhole) {
  const files::Folder folder;
  write_map(folder);
  for (const char* name : {"a.glb", "a_iso150.glb", "a_label3.glb"}) files::write_bytes(folder / name, "mine");
  const std::vector<std::string> isos{"mesh", kVolume, "--iso", "100,150", "-o", "a.glb", "--no-clobber"};
  const std::vector<std::string> labels{"mesh", kMap, "--labels", "3,8", "-o", "a.glb", "--no-clobber"};
  for (const std::vector<std::string>& task : {isos, labels}) {
    expect_refused(folder, joined(task, {"--one-file"}), 4, "a.glb");
  }
  expect_refused(folder, isos, 4, "a_iso150.glb");
  expect_refused(folder, labels, 4, "a_label3.glb");
  EXPECT_EQ(files::read_bytes(folder / "a.glb"), "mine");
}

TEST(CliParts, NothingIsLeftOfARunThatFails) {
  const files::Folder folder;
  write_map(folder);
  program::Setup small;
  small.file_limit = 20'000;
  for (const std::string name : {"a.glb", "a.vtp"}) {
    expect_refused(folder, {"mesh", kVolume, "--iso", "100,150", "-o", name, "--one-file", "--error", "0"}, 4, name,
                   small);
    expect_refused(folder, {"mesh", kMap, "--labels", "all", "-o", name, "--one-file", "--error", "0"}, 4, name, small);
    program::Setup stopped;
    stopped.signal = SIGINT;
    stopped.ready = [&](pid_t process) { return program::has_file_open_in(process, folder); };
    expect_refused(folder, {"mesh", "generate:smooth:64x64x2000000:uint8", "-o", name, "--iso", "90,120", "--one-file"},
                   130, "interrupted", stopped);
  }
}

}  // namespace
}  // namespace isoweave::testing::cli_parts_test
