// The texts that reports are made of, as other programs read them.
// Threads: none, their number is a member of a report here.
#include "isoweave/report_json.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace isoweave::testing::report_json_test {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> keys(const Json& json) {
  std::vector<std::string> all;
  for (const auto& item : json.items()) all.push_back(item.key());
  return all;
}

TEST(ReportJson, NumbersThatJsonHasNotAreNull) {
  EXPECT_EQ(range_json(1, -1, 7), R"({"min":null,"max":null,"nan":7})");
  EXPECT_EQ(range_json(-std::numeric_limits<double>::infinity(), 0.5, 0), R"({"min":null,"max":0.5,"nan":0})");
  SurfaceReport surface;
  surface.error = std::numeric_limits<double>::infinity();
  surface.triangles = std::numeric_limits<std::uint64_t>::max();
  surface.euler = -4;
  surface.digest = 0xab;
  EXPECT_EQ(surface_json(surface),
            R"({"error":null,"triangles":18446744073709551615,"vertices":0,"open_edges":0,"nonmanifold_edges":0,)"
            R"("nonmanifold_vertices":0,"components":0,"euler":-4,"digest":"00000000000000ab"})");
}

TEST(ReportJson, NamesThatAreNoUtf8AreReplaced) {
  VolumeInfo info;
  info.path = "sca\xffn\n.nrrd";
  info.geometry.space = Space::kRas;
  const std::string text = volume_json(info);
  EXPECT_EQ(text.find('\n'), std::string::npos);
  const Json json = Json::parse(text);
  EXPECT_EQ(json["path"], "sca\xef\xbf\xbdn\n.nrrd");
  EXPECT_EQ(json["space"], "ras");
  EXPECT_EQ(json["type"], sample_type_name(info.type));
}

TEST(ReportJson, ARunHasItsSurfaceAndAPlaceForItsInput) {
  MeshReport report;
  report.threads = 3;
  report.schedule = Schedule::kRounds;
  report.device = Device::kCuda;
  report.rekeyed = 11;
  report.seconds_write = 0.25;
  report.peak_bytes = 5'000'000'000;
  report.triangles = 12;
  report.sweep.push_back({2, 30, 20, 10, 1000});
  report.warnings = {"a warning"};
  const Json json = Json::parse(run_json(report));
  EXPECT_EQ(json["input"], Json::object());
  EXPECT_EQ(json["backend"], "cuda");
  EXPECT_EQ(json["schedule"], "rounds");
  EXPECT_EQ(json["seconds"]["write"], 0.25);
  EXPECT_EQ(json["memory"]["peak_bytes"], 5'000'000'000);
  EXPECT_EQ(json["sweep"][0]["undecided_triangles"], 20);
  const Json surface = Json::parse(surface_json(report));
  for (const std::string& key : keys(surface)) EXPECT_EQ(json[key], surface[key]) << key;
  const Json counts = Json::parse(counts_json(report));
  EXPECT_EQ(counts["rekeyed"], 11);
  for (const std::string& key : keys(counts)) {
    EXPECT_EQ(json[key], counts[key]) << key;
    EXPECT_FALSE(surface.contains(key)) << key;
  }
}

TEST(ReportJson, WhatIsNotKnownIsNotThere) {
  EXPECT_EQ(keys(Json::parse(forecast_json({}))),
            (std::vector<std::string>{"triangles_extracted", "triangles", "vertices", "peak_bytes", "least_bytes",
                                      "seconds"}));
  EXPECT_EQ(Json::parse(forecast_json({}, 9))["output_bytes"], 9);
  EXPECT_FALSE(Json::parse(check_json({})).contains("path"));
  EXPECT_EQ(keys(Json::parse(check_json({}, "")))[1], "path");
}

TEST(ReportJson, DistancesAreMultiplesOfTheUnit) {
  MeshDistance distance;
  distance.a_to_b.mean = 3;
  distance.b_to_a.max = 5;
  distance.rms = 7;
  const Json json = Json::parse(distances_json(distance, 2));
  EXPECT_EQ(json["a_to_b"]["mean"], 1.5);
  EXPECT_EQ(json["b_to_a"]["max"], 2.5);
  EXPECT_EQ(json["both"]["rms"], 3.5);
  EXPECT_EQ(Json::parse(distances_json(distance))["both"]["rms"], 7.0);
}

}  // namespace
}  // namespace isoweave::testing::report_json_test
