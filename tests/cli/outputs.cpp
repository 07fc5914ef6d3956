// Where meshes go: formats, standard output, spaces and units.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_outputs_test {
namespace {

using Json = nlohmann::json;
using program::listing;
using program::Result;
using program::run;

constexpr const char* kVolume = "generate:gyroid:24x24x24:uint8";

std::vector<std::string> mesh(const std::vector<std::string>& more, const std::string& volume = kVolume) {
  std::vector<std::string> arguments{"mesh", volume, "--iso", "127.5"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

void expect_failure(const files::Folder& folder, const std::vector<std::string>& arguments, int code,
                    const std::string& says, const program::Setup& setup = {}) {
  const Result result = run(folder.path(), arguments, setup);
  program::expect_failed(result, code, says);
  EXPECT_EQ(listing(folder), std::vector<std::string>{});
}

TEST(CliStandardOutput, CarriesTheBytesOfTheFileAndNothingElse) {
  const files::Folder folder;
  for (const std::string format : {"ply", "stl"}) {
    ASSERT_EQ(run(folder.path(), mesh({"-o", "a." + format})).code, 0);
    const Result streamed = run(folder.path(), mesh({"--to-stdout", format, "--progress", "always"}));
    EXPECT_EQ(streamed.code, 0);
    EXPECT_TRUE(streamed.out == files::read_bytes(folder / ("a." + format))) << format;
    EXPECT_NE(streamed.err.find("standard output: "), std::string::npos) << streamed.err;
  }
  const Result simplified = run(folder.path(), {"simplify", "a.ply", "--to-stdout=stl", "--error", "1", "--quiet"});
  EXPECT_EQ(simplified.code, 0);
  EXPECT_EQ(simplified.err, "");
  files::write_bytes(folder / "s.stl", simplified.out);
  EXPECT_EQ(run(folder.path(), {"check", "s.stl"}).code, 0);
}

TEST(CliStandardOutput, WrongUseIsRefused) {
  const files::Folder folder;
  expect_failure(folder, mesh({"--to-stdout", "obj"}), 2, "--to-stdout: expected one of ply, stl, found 'obj'");
  expect_failure(folder, mesh({"--to-stdout", "ply", "-o", "a.ply"}), 2, "--to-stdout");
  expect_failure(folder, mesh({"--to-stdout", "ply", "--checkpoint", "run"}), 2, "--to-stdout");
  expect_failure(folder, mesh({"--to-stdout", "ply", "--compress"}), 4, "compressed");
  expect_failure(folder, mesh({"--to-stdout"}), 2, "--to-stdout");
}

TEST(CliStandardOutput, WhoeverStopsReadingIsAnError) {
  const files::Folder folder;
  program::Setup setup;
  setup.out_path = "/dev/full";
  if (::access("/dev/full", W_OK) == 0) {
    expect_failure(folder, mesh({"--to-stdout", "ply", "--quiet"}), 4, "standard output: cannot write: No space",
                   setup);
  }
  // A shell closes it, or the program behind a pipe ends early.
  const std::string command =
      ISOWEAVE_BINARY " mesh generate:gyroid:24x24x24:uint8 --iso 127.5 --to-stdout ply --quiet 2>err";
  for (const std::string& line : {command + " >&-; echo $? >code", "(" + command + "; echo $? >code) | true"}) {
    ASSERT_EQ(std::system(("cd '" + folder.path() + "' && { " + line + "; }").c_str()), 0);
    EXPECT_EQ(files::read_bytes(folder / "code"), "4\n") << line;
    const std::string err = files::read_bytes(folder / "err");
    EXPECT_TRUE(program::is_one_line(err)) << err;
    EXPECT_NE(err.find("standard output: cannot write"), std::string::npos) << err;
  }
}

TEST(CliOutputs, SpaceAndUnitAreInTheFile) {
  const files::Folder folder;
  const std::string header =
      "NRRD0005\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nspace: left-posterior-superior\n"
      "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (10,20,30)\nspace units: \"um\" \"um\" \"um\"\n"
      "encoding: raw\n\n";
  files::write_bytes(folder / "v.nrrd", header + std::string(256, '\0') + std::string(256, '\1'));
  const std::vector<std::pair<std::string, std::string>> spaces{
      {"", "SPACE=LPS"}, {"lps", "SPACE=LPS"}, {"ras", "SPACE=RAS"}, {"index", "SPACE=index"}};
  for (const auto& [option, text] : spaces) {
    for (const std::string name : {"a.ply", "a.obj", "a.off", "a.stl"}) {
      std::vector<std::string> arguments{"mesh", "v.nrrd", "-o", name, "--iso", "0.5"};
      if (!option.empty()) arguments.insert(arguments.end(), {"--space", option});
      ASSERT_EQ(run(folder.path(), arguments).code, 0);
      const std::string bytes = files::read_bytes(folder / name);
      EXPECT_NE(bytes.find(text), std::string::npos) << name << option;
      EXPECT_NE(bytes.find("UNIT=um"), std::string::npos) << name;
    }
  }
  // Where the volume does not say, nothing is claimed.
  ASSERT_EQ(run(folder.path(), mesh({"-o", "a.ply", "--space", "lps"})).code, 0);
  EXPECT_EQ(files::read_bytes(folder / "a.ply").find("SPACE="), std::string::npos);
}

TEST(CliOutputs, PackedMeshesTellTheirError) {
  const files::Folder folder;
  for (const std::string name : {"a.glb", "a.precomputed"}) {
    const Result result = run(folder.path(), mesh({"-o", name, "--compress", "--report", "r.json"}));
    if (result.code == 4) {
      EXPECT_NE(result.err.find("expected a build with"), std::string::npos) << result.err;
      continue;
    }
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.err.find("rounded"), std::string::npos) << result.err;
    const Json report = Json::parse(files::read_bytes(folder / "r.json"));
    EXPECT_NE(report["notes"].dump().find("rounded"), std::string::npos) << report["notes"];
    if (name != "a.glb") continue;
    // The packed file is read back.
    const Result check = run(folder.path(), {"check", name, "--json"});
    EXPECT_EQ(check.code, 0) << check.err;
    for (const char* same : {"triangles", "vertices", "components"}) {
      EXPECT_EQ(Json::parse(check.out)[same], report[same]) << same;
    }
  }
}

TEST(CliOutputs, LimitsAreFoundBeforeTheRun) {
  const files::Folder folder;
  // 9 G triangles; what a forecast takes grows with the slices.
  const std::vector<std::string> huge{"mesh", "generate:white:64x64x2000000:uint8", "--iso", "127.5", "--error", "0"};
  for (const auto& [name, says] : {std::pair<std::string, std::string>{"a.glb", "at most 4294967295 bytes"},
                                   {"a.3mf", "at most 2147483648 vertices"}}) {
    std::vector<std::string> arguments = huge;
    arguments.insert(arguments.end(), {"-o", name});
    expect_failure(folder, arguments, 4, says);
  }
}

TEST(CliOutputs, PackedMeshesNeedMemoryThatIsForeseen) {
  const files::Folder folder;
  const auto forecast = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{
        "mesh", "generate:noise:96x96x96:uint8", "--iso", "127.5", "--error", "0", "--dry-run", "--report", "r.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(folder.path(), arguments).code, 0);
    return Json::parse(files::read_bytes(folder / "r.json"))["forecast"]["peak_bytes"].get<std::uint64_t>();
  };
  EXPECT_GT(forecast({"-o", "a.glb", "--compress"}), forecast({"-o", "a.glb"}) + 10'000'000);
}

Json report_of(const files::Folder& folder, const std::vector<std::string>& arguments) {
  const Result result = run(folder.path(), arguments);
  EXPECT_EQ(result.code, 0) << result.err;
  return Json::parse(files::read_bytes(folder / "r.json"));
}

TEST(CliLevels, AreFilesLikeThoseOfRunsWithTheirErrors) {
  const files::Folder folder;
  const std::vector<std::string> errors{"0", "0.1vox", "0.5"};
  const Json levels = report_of(folder, mesh({"-o", "a.ply", "--lods", "0,0.1vox,0.5", "--report", "r.json"}));
  ASSERT_EQ(levels.at("levels").size(), 2U);
  EXPECT_EQ(levels.at("output"), "a_lod2.ply");
  for (std::size_t n = 0; n < errors.size(); ++n) {
    const std::string name = "a_lod" + std::to_string(n) + ".ply";
    const Json direct = report_of(folder, mesh({"-o", "b.ply", "--error", errors[n], "--report", "r.json"}));
    const Json& level = n < 2 ? levels.at("levels").at(n) : levels;
    EXPECT_EQ(level.at("output"), name);
    for (const char* key : {"error", "triangles", "vertices", "components", "euler", "open_edges", "digest"}) {
      EXPECT_EQ(level.at(key), direct.at(key)) << name << ' ' << key;
    }
    EXPECT_EQ(Json::parse(run(folder.path(), {"check", name, "--json"}).out).at("digest"), direct.at("digest"));
    // Nothing tells the file from that of a run of its own but the order of triangles and vertices.
    EXPECT_EQ(files::read_bytes(folder / name).substr(0, 150), files::read_bytes(folder / "b.ply").substr(0, 150));
  }
  EXPECT_EQ(listing(folder), (std::vector<std::string>{"a_lod0.ply", "a_lod1.ply", "a_lod2.ply", "b.ply", "r.json"}));
}

TEST(CliLevels, ComeFromMeshesTooAndCanBeResumed) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), mesh({"-o", "full.ply", "--error", "0"})).code, 0);
  const Json levels =
      report_of(folder, {"simplify", "full.ply", "-o", "s.obj", "--lods", "0.1,0.5", "--report", "r.json"});
  const Json direct =
      report_of(folder, {"simplify", "full.ply", "-o", "d.obj", "--error", "0.1", "--report", "r.json"});
  EXPECT_EQ(levels.at("levels").at(0).at("digest"), direct.at("digest"));
  EXPECT_EQ(levels.at("output"), "s_lod1.obj");
  const Json whole = report_of(folder, mesh({"-o", "a.stl", "--lods", "0.1,0.5", "--report", "r.json"}));
  const Json kept = report_of(folder, mesh({"-o", "c.stl", "--lods", "0.1,0.5", "--report", "r.json", "--checkpoint",
                                            "run", "--every", "1layers", "--slab", "4"}));
  EXPECT_EQ(kept.at("levels").at(0).at("digest"), whole.at("levels").at(0).at("digest"));
  EXPECT_EQ(kept.at("digest"), whole.at("digest"));
  EXPECT_FALSE(std::filesystem::exists(folder / "run"));
}

TEST(CliLevels, OneFileHasThemAll) {
  const files::Folder folder;
  const std::vector<std::string> lods{"--lods", "0,0.1vox,0.5", "--report", "r.json"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = mesh(lods);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return report_of(folder, arguments);
  };
  const Json separate = with({"-o", "s.glb"});
  const Json one = with({"-o", "a.glb", "--one-file"});
  EXPECT_EQ(one.at("output"), "a.glb");
  EXPECT_EQ(one.at("digest"), separate.at("digest"));
  EXPECT_EQ(one.at("levels").at(0).at("digest"), separate.at("levels").at(0).at("digest"));
  // The data of each level are those of its file, one after the other.
  std::string data;
  for (int level = 0; level < 3; ++level) {
    const std::string bytes = files::read_bytes(folder / ("s_lod" + std::to_string(level) + ".glb"));
    data += bytes.substr(bytes.find("BIN", 20) + 4);
  }
  const std::string bytes = files::read_bytes(folder / "a.glb");
  EXPECT_TRUE(bytes.substr(bytes.find("BIN", 20) + 4) == data);
  EXPECT_EQ(Json::parse(run(folder.path(), {"check", "a.glb", "--json"}).out).at("digest"),
            one.at("levels").at(0).at("digest"))
      << "the finest is read";
  with({"-o", "k.glb", "--one-file", "--checkpoint", "run", "--every", "1layers", "--slab", "4"});
  EXPECT_TRUE(files::read_bytes(folder / "k.glb").substr(bytes.find("BIN", 20) + 4).size() == data.size());
  EXPECT_FALSE(std::filesystem::exists(folder / "run"));
  ASSERT_EQ(run(folder.path(), mesh({"-o", "full.ply", "--error", "0"})).code, 0);
  report_of(folder, {"simplify", "full.ply", "-o", "m.glb", "--one-file", "--lods", "0.1,0.5", "--report", "r.json"});
  EXPECT_EQ(run(folder.path(), {"check", "m.glb"}).code, 0);
}

TEST(CliLevels, OneFileIsRefusedWhereThereCanBeNone) {
  const files::Folder folder;
  const std::vector<std::string> lods{"--lods", "0.1,0.2"};
  const auto refused = [&](std::vector<std::string> more, int code, const std::string& says) {
    more.insert(more.end(), lods.begin(), lods.end());
    more.emplace_back("--one-file");
    expect_failure(folder, mesh(more), code, says);
  };
  refused({"-o", "a.ply"}, 2, "--one-file: expected a mesh named .glb, or .precomputed with --compress");
  refused({"-o", "a.precomputed"}, 2, "--one-file: expected a mesh named .glb");
  refused({"-o", "missing/a.glb"}, 4, "missing");
  refused({"-o", "a.glb", "--html", "a.html"}, 2, "--html");
  expect_failure(folder, mesh({"-o", "a.glb", "--one-file", "--error", "1"}), 2, "--one-file: expected several levels");
  // Each would fit alone: 3.8 and 3.6 GB.
  expect_failure(folder,
                 {"mesh", "generate:white:64x64x16000:uint8", "--iso", "127.5", "--lods", "0,0.001vox", "-o", "a.glb",
                  "--one-file"},
                 4, "at most 4294967295 bytes");
}

TEST(CliLevels, WrongUseIsRefused) {
  const files::Folder folder;
  expect_failure(folder, mesh({"-o", "a.ply", "--lods", "0.2,0.1"}), 2, "expected ascending errors");
  expect_failure(folder, mesh({"-o", "a.ply", "--lods", "0.1,,0.3"}), 2, "--lods: expected a length");
  expect_failure(folder, mesh({"-o", "a.ply", "--lods", "0.1,wide"}), 2, "'wide'");
  expect_failure(folder, mesh({"-o", "a.ply", "--lods", "0.1,0.2", "--error", "0.3"}), 2, "excludes");
  expect_failure(folder, mesh({"-o", "a.ply", "--lods", "0.1,0.2", "--triangles", "300"}), 2, "excludes");
  expect_failure(folder, mesh({"--to-stdout", "ply", "--lods", "0.1,0.2"}), 2, "excludes");
  expect_failure(folder, mesh({"-o", "a.ply", "--lods", "0.1,0.2", "--report", "a_lod0.ply"}), 2, "a_lod0.ply");
}

TEST(CliValues, AreInTheFileAndColourAPicture) {
  const files::Folder folder;
  const std::string other = "generate:noise:24x24x24:uint8";
  const auto report = [&](const std::vector<std::string>& more) {
    std::vector<std::string> options{"--color-by", other, "--report", "r.json"};
    options.insert(options.end(), more.begin(), more.end());
    const Result result = run(folder.path(), mesh(options));
    EXPECT_EQ(result.code, 0) << result.err;
    return Json::parse(files::read_bytes(folder / "r.json"));
  };
  EXPECT_EQ(report({"-o", "a.ply"})["color_by"], other);
  const std::string ply = files::read_bytes(folder / "a.ply");
  EXPECT_NE(ply.find("property float quality"), std::string::npos);
  EXPECT_EQ(report({"-o", "a.vtp"})["color_by"], other);
  EXPECT_NE(files::read_bytes(folder / "a.vtp").find("Scalars=\"value\""), std::string::npos);
  EXPECT_EQ(report({"-o", "part.ply", "--roi", "0:12,:,:"})["input"]["dims"], Json({12, 24, 24}));
#ifdef ISOWEAVE_HAS_PNG
  const Result picture =
      run(folder.path(), {"render", "a.ply", "-o", "a.png", "--color-by", "quality", "--size", "9x9"});
  EXPECT_EQ(picture.code, 0);
  EXPECT_NE(picture.err.find("colours from"), std::string::npos) << picture.err;
#endif
  // A run that can be resumed opens the volume anew.
  ASSERT_EQ(run(folder.path(), {"generate", "noise", "-o", "n.mha", "--size", "24"}).code, 0);
  const auto resumable = mesh({"-o", "b.ply", "--color-by", "n.mha", "--checkpoint", "run", "--every", "4layers"});
  EXPECT_EQ(run(folder.path(), resumable).code, 0);
  EXPECT_NE(files::read_bytes(folder / "b.ply").find("property float quality"), std::string::npos);
}

TEST(CliValues, WrongUseIsRefused) {
  const files::Folder folder;
  const std::string other = "generate:noise:24x24x24:uint8";
  expect_failure(folder, mesh({"-o", "a.stl", "--color-by", other}), 4,
                 "a.stl: expected a name that ends in .ply or .vtp");
  expect_failure(folder, mesh({"-o", "a.ply", "--color-by", "generate:noise:24x24x25:uint8"}), 3,
                 "expected 24 x 24 x 24 samples");
  expect_failure(folder, mesh({"-o", "a.ply", "--color-by", "missing.nii"}), 3, "missing.nii");
  expect_failure(folder, mesh({"--to-stdout", "stl", "--color-by", other}), 4,
                 "expected a name that ends in .ply or .vtp");
}

TEST(CliNormals, AreKeptWhereTheyCount) {
  const files::Folder folder;
  std::vector<Json> reports;
  for (const char* normals : {"none", "gradient", "quadric"}) {
    ASSERT_EQ(run(folder.path(), mesh({"-o", "a.ply", "--normals", normals, "--report", "r.json"})).code, 0);
    reports.push_back(Json::parse(files::read_bytes(folder / "r.json")));
    EXPECT_EQ(reports.back()["normals"], normals);
    const bool has_normals = files::read_bytes(folder / "a.ply").find("property float nx") != std::string::npos;
    EXPECT_EQ(has_normals, normals != std::string("none"));
  }
  EXPECT_EQ(reports[0]["digest"], reports[1]["digest"]);
  EXPECT_NE(reports[0]["digest"], reports[2]["digest"]);
  const Result other = run(folder.path(), mesh({"-o", "b.ply", "--normals", "sobel"}));
  program::expect_failed(other, 2, "expected one of none, gradient, quadric");
}

TEST(CliDistance, IsGuaranteedAndIsTheErrorWhereNoneIsGiven) {
  constexpr const char* kSmall = "generate:gyroid:12x12x12:uint8";
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), mesh({"-o", "full.ply", "--error", "0"}, kSmall)).code, 0);
  const Json bounded =
      report_of(folder, mesh({"-o", "a.ply", "--max-distance", "0.3vox", "--report", "r.json"}, kSmall));
  EXPECT_DOUBLE_EQ(bounded.at("error").get<double>(), 0.3);
  const Json distance = Json::parse(run(folder.path(), {"compare", "a.ply", "full.ply", "--json"}).out);
  EXPECT_LE(distance.at("a_to_b").at("max").get<double>(), 0.3 * (1 + 1e-5));
  const auto tight = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"-o", "b.ply", "--error", "0.5vox", "--report", "r.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return report_of(folder, mesh(arguments, kSmall)).at("digest");
  };
  EXPECT_NE(tight({"--max-distance", "0.1vox"}), tight({}));
  EXPECT_EQ(tight({"--max-distance", "0.1vox"}),
            tight({"--max-distance", "0.1vox", "--slab", "2", "--schedule", "rounds"}));
  const Json small =
      report_of(folder, {"simplify", "full.ply", "-o", "s.ply", "--max-distance", "0.2", "--report", "r.json"});
  EXPECT_LT(small.at("triangles"), bounded.at("triangles_extracted"));
}

// An infinite error is 64 times the distance; beside a number it is none.
TEST(CliDistance, TheErrorMayBeInfinite) {
  constexpr const char* kSmall = "generate:gyroid:12x12x12:uint8";
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), mesh({"-o", "full.ply", "--error", "0"}, kSmall)).code, 0);
  const auto digest_of = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"-o", "b.ply", "--report", "r.json"});
    return report_of(folder, arguments).at("digest").get<std::string>();
  };
  const auto of_volume = [&](const std::vector<std::string>& stop) { return digest_of(mesh(stop, kSmall)); };
  const std::string fewest = of_volume({"--max-distance", "0.3vox", "--error", "inf"});
  EXPECT_EQ(fewest, of_volume({"--max-distance", "0.3vox", "--error", "19.2vox"}));
  EXPECT_NE(fewest, of_volume({"--max-distance", "0.3vox", "--error", "1vox"}));
  const std::string to_number = of_volume({"--triangles", "4", "--error", "inf"});
  EXPECT_EQ(to_number, of_volume({"--triangles", "4", "--error", "1000000mm"}));
  EXPECT_NE(to_number, of_volume({"--triangles", "4"}));
  EXPECT_EQ(digest_of({"simplify", "full.ply", "--max-distance", "0.3", "--error", "inf"}),
            digest_of({"simplify", "full.ply", "--max-distance", "0.3", "--error", "19.2"}));
  EXPECT_NE(
      run(folder.path(), mesh({"-o", "c.ply", "--max-distance", "0.3vox", "--error", "inf", "--dry-run"}, kSmall)).out,
      "");
}

TEST(CliDistance, WrongUseIsRefused) {
  const files::Folder folder;
  expect_failure(folder, mesh({"-o", "a.ply", "--max-distance", "0"}), 2, "--max-distance: expected a length above 0");
  expect_failure(folder, mesh({"-o", "a.ply", "--max-distance", "-1"}), 2, "--max-distance");
  expect_failure(folder, mesh({"-o", "a.ply", "--max-distance", "near"}), 2, "'near'");
  expect_failure(folder, mesh({"-o", "a.ply", "--max-distance", "inf"}), 2, "--max-distance: expected a length");
  expect_failure(folder, mesh({"-o", "a.ply", "--error", "inf"}), 2, "inf beside --max-distance");
  expect_failure(folder, mesh({"-o", "a.ply", "--max-distance"}), 2, "--max-distance");
}

TEST(CliOutputs, AFolderIsNotWrittenOver) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), mesh({"-o", "a.precomputed"})).code, 0);
  const Result again = run(folder.path(), mesh({"-o", "a.precomputed"}));
  EXPECT_EQ(again.code, 4);
  EXPECT_NE(again.err.find("a.precomputed: exists"), std::string::npos) << again.err;
  EXPECT_EQ(listing(folder), std::vector<std::string>{"a.precomputed"});
}

}  // namespace
}  // namespace isoweave::testing::cli_outputs_test
