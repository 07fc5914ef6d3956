// mesh --iso with several values: a file for each, like those of runs of their own; and what is refused.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_isos_test {
namespace {

using nlohmann::json;
using program::listing;
using program::Result;
using program::run;

constexpr const char* kVolume = "generate:noise:24x22x20:uint8";

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

json report_of(const files::Folder& folder, const std::vector<std::string>& arguments) {
  const Result result = run(folder.path(), joined(arguments, {"--report", "r.json"}));
  EXPECT_EQ(result.code, 0) << result.err;
  return json::parse(files::read_bytes(folder / "r.json"));
}

json digest_of(const files::Folder& folder, const std::string& name) {
  return json::parse(run(folder.path(), {"check", name, "--json"}).out).at("digest");
}

TEST(CliIsos, AreFilesLikeThoseOfTheirOwnRuns) {
  const files::Folder folder;
  for (const std::vector<std::string>& how : {std::vector<std::string>{},
                                              {"--open", "--normals", "gradient", "--extractor", "dual"},
                                              {"--triangles", "500"},
                                              {"--ratio", "10%"}}) {
    const json report = report_of(folder, joined({"mesh", kVolume, "-o", "a.ply", "--iso", "150,99.5"}, how));
    ASSERT_EQ(report.at("isos").size(), 2U);
    std::uint64_t triangles = 0;
    for (const json& entry : report.at("isos")) {
      const std::string value = entry.at("iso") == 150 ? "150" : "99.5";
      const json own = report_of(folder, joined({"mesh", kVolume, "-o", "own.ply", "--iso", value}, how));
      EXPECT_EQ(entry.at("output"), "a_iso" + value + ".ply");
      EXPECT_EQ(digest_of(folder, "a_iso" + value + ".ply"), own.at("digest"));
      for (const char* key : {"error", "triangles", "vertices", "components", "euler", "digest", "triangles_extracted",
                              "collapses", "warnings"}) {
        EXPECT_EQ(entry.at(key), own.at(key)) << value << ' ' << key;
      }
      EXPECT_EQ(entry.value("target", json()), own.value("target", json()));
      EXPECT_EQ(report.at("input"), own.at("input"));
      triangles += entry.at("triangles").get<std::uint64_t>();
    }
    EXPECT_EQ(report.at("triangles"), triangles);
  }
  EXPECT_EQ(listing(folder), (std::vector<std::string>{"a_iso150.ply", "a_iso99.5.ply", "own.ply", "r.json"}));
}

TEST(CliIsos, OfAnotherSizeHaveTheDigestsOfTheirFiles) {
  const files::Folder folder;
  const std::vector<std::string> mesh{"mesh", kVolume, "-o", "a.ply", "--iso", "150,99.5"};
  const json plain = report_of(folder, mesh);
  const json scaled = report_of(folder, joined(mesh, {"--scale", "2"}));
  EXPECT_NE(scaled.at("digest"), plain.at("digest"));
  std::uint64_t sum = 0;
  for (const json& entry : scaled.at("isos")) {
    EXPECT_EQ(entry.at("digest"), digest_of(folder, entry.at("output")));
    sum += std::stoull(entry.at("digest").get<std::string>(), nullptr, 16);
  }
  EXPECT_EQ(std::stoull(scaled.at("digest").get<std::string>(), nullptr, 16), sum);
  for (const std::string option : {"--center", "--ground"}) {
    program::expect_failed(run(folder.path(), joined(mesh, {option})), 2,
                           "expected one mesh, as several would be moved");
  }
}

TEST(CliIsos, AForecastIsTheSum) {
  const files::Folder folder;
  const auto forecast = [&](const std::string& isos) {
    return report_of(folder, {"mesh", kVolume, "-o", "a.ply", "--iso", isos, "--dry-run"}).at("forecast");
  };
  const json both = forecast("150,99.5");
  const json one = forecast("150");
  const json other = forecast("99.5");
  for (const char* key : {"triangles_extracted", "triangles", "vertices", "output_bytes"}) {
    EXPECT_EQ(both.at(key).get<std::uint64_t>(), one.at(key).get<std::uint64_t>() + other.at(key).get<std::uint64_t>());
  }
  EXPECT_GT(both.at("peak_bytes"), one.at("peak_bytes"));
  EXPECT_EQ(listing(folder), std::vector<std::string>{"r.json"});
}

TEST(CliIsos, OneThatIsMetNowhereIsRefusedUnlessAllowed) {
  const files::Folder folder;
  program::expect_failed(run(folder.path(), {"mesh", kVolume, "-o", "a.ply", "--iso", "150,400"}), 3, "iso is 400");
  EXPECT_EQ(listing(folder), std::vector<std::string>{});
  const Result result = run(folder.path(), {"mesh", kVolume, "-o", "a.ply", "--iso", "150,400", "--allow-empty"});
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.err.find("iso is 400"), std::string::npos) << result.err;
  EXPECT_EQ(run(folder.path(), {"mesh", kVolume, "-o", "a.ply", "--iso", "150,99", "--quiet"}).err, "");
}

TEST(CliIsos, WrongUseIsRefused) {
  const files::Folder folder;
  files::write_bytes(folder / "v_4x4x4_uint8.raw", std::string(64, 'a'));
  const auto refused = [&](const std::vector<std::string>& arguments, int code, const std::string& says) {
    SCOPED_TRACE(says);
    const std::vector<std::string> before = listing(folder);
    program::expect_failed(run(folder.path(), arguments), code, says);
    EXPECT_EQ(listing(folder), before);
  };
  for (const std::string isos : {"1,", ",1", "1,,2", "1,auto", "1,x", "1,2,1", "1,1.0", "1,inf"}) {
    refused({"mesh", kVolume, "-o", "a.ply", "--iso=" + isos}, 2, "--iso");
  }
  const std::vector<std::vector<std::string>> together{{"--lods", "0.1,0.2"},   {"--memory", "1G"},
                                                       {"--checkpoint", "run"}, {"--color-by", "v.raw"},
                                                       {"--largest"},           {"--min-component", "9"}};
  for (const std::vector<std::string>& more : together) {
    refused(joined({"mesh", kVolume, "-o", "a.ply", "--iso", "1,2"}, more), 2,
            "--iso with several values: expected a run without " + more[0] + ", which takes one surface");
  }
  refused({"mesh", kVolume, "--to-stdout", "ply", "--iso", "1,2"}, 2, "--to-stdout");
  refused({"mesh", kVolume, "-o", "a.ply", "--iso", "1,2", "--report", "a_iso2.ply"}, 2, "a_iso2.ply");
  refused({"mesh", kVolume, "-o", "none/a.ply", "--iso", "1,2"}, 4, "none/a_iso1.ply");
}

// Every file is whole or not there: those of values before the one that fails have been finished.
TEST(CliIsos, AFileThatCannotBeWrittenLeavesNoneHalfWritten) {
  const files::Folder folder;
  program::Setup setup;
  setup.file_limit = 60'000;  // enough for the sparse surface, not for the other one
  const std::vector<std::string> few{"mesh", kVolume, "-o", "a.ply", "--iso", "205", "--error", "0"};
  ASSERT_EQ(run(folder.path(), few, setup).code, 0);
  const auto fails = [&](const std::string& isos) {
    const Result result = run(folder.path(), {"mesh", kVolume, "-o", "b.ply", "--iso", isos, "--error", "0"}, setup);
    program::expect_failed(result, 4, "b_iso128.ply");
  };
  fails("128,205");
  EXPECT_EQ(listing(folder), std::vector<std::string>{"a.ply"});
  fails("205,128");
  EXPECT_EQ(listing(folder), (std::vector<std::string>{"a.ply", "b_iso205.ply"}));
  EXPECT_EQ(digest_of(folder, "b_iso205.ply"), digest_of(folder, "a.ply"));
}

}  // namespace
}  // namespace isoweave::testing::cli_isos_test
