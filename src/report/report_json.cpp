#include "isoweave/report_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

namespace isoweave {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, nlohmann::detail::error_handler_t::replace); }

// A number, or null where JSON has no number for it.
Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json sweep_of(std::span<const SlabRecord> sweep) {
  Json records = Json::array();
  for (const SlabRecord& record : sweep) {
    records.push_back({{"layer", record.layer},
                       {"live_triangles", record.live_triangles},
                       {"undecided_triangles", record.undecided_triangles},
                       {"final_triangles", record.final_triangles},
                       {"bytes", record.bytes}});
  }
  return records;
}

Json blocks_of(std::span<const BlockStage> stages) {
  Json list = Json::array();
  for (const BlockStage& stage : stages) {
    list.push_back({{"size", stage.size}, {"blocks", stage.blocks}, {"triangles", stage.triangles}});
  }
  return list;
}

Json ranks_of(std::span<const RankWork> ranks) {
  Json list = Json::array();
  for (const RankWork& rank : ranks) {
    list.push_back({{"tasks", rank.tasks},
                    {"triangles", rank.triangles},
                    {"messages", rank.messages},
                    {"bytes_sent", rank.bytes_sent},
                    {"seconds_waiting", rank.seconds_waiting},
                    {"peak_bytes", rank.peak_bytes}});
  }
  return list;
}

Json preview_of(const PreviewReport& preview) {
  return {{"cell", preview.cell},
          {"plane_rms", preview.plane_rms},
          {"cells", preview.cells},
          {"triangles_collapsed", preview.collapsed},
          {"triangles_repeated", preview.repeated}};
}

Json surface_of(const SurfaceReport& surface) {
  return {{"error", number_or_null(surface.error)},
          {"triangles", surface.triangles},
          {"vertices", surface.vertices},
          {"open_edges", surface.open_edges},
          {"nonmanifold_edges", surface.nonmanifold_edges},
          {"nonmanifold_vertices", surface.nonmanifold_vertices},
          {"components", surface.components},
          {"euler", surface.euler},
          {"digest", digest_text(surface.digest)}};
}

const char* schedule_name(Schedule schedule) {
  switch (schedule) {
    case Schedule::kQueue:
      return "queue";
    case Schedule::kLocal:
      return "local";
    case Schedule::kRounds:
      return "rounds";
    case Schedule::kAutomatic:
      break;
  }
  return "auto";
}

Json seconds_of(const MeshReport& report) {
  return {{"read", report.seconds_read},
          {"extract", report.seconds_extract},
          {"simplify", report.seconds_simplify},
          {"write", report.seconds_write},
          {"total", report.seconds_total}};
}

Json angles_of(const TriangleAngles& angles) {
  return {{"smallest", number_or_null(angles.smallest)},
          {"largest", number_or_null(angles.largest)},
          {"triangles_under_5", angles.under_5_degrees},
          {"smallest_histogram", {{"low", 0}, {"high", 60}, {"triangles", angles.smallest_in_bins}}}};
}

Json counts_of(const MeshReport& report) {
  return {{"cells_crossed", report.cells_crossed},
          {"triangles_extracted", report.triangles_extracted},
          {"vertices_extracted", report.vertices_extracted},
          {"collapses", report.collapses},
          {"postponed", report.postponed},
          {"rekeyed", report.rekeyed},
          {"specks", report.specks}};
}

// The number of triangles that a run was to leave, where it was given one.
void add_target(const MeshReport& report, Json& json) {
  if (report.target > 0) json["target"] = {{"triangles", report.target}};
}

Json distance_of(double mean, double rms, double max, double unit) {
  return {{"mean", mean / unit}, {"rms", rms / unit}, {"max", max / unit}};
}

}  // namespace

std::string volume_json(const VolumeInfo& info) {
  std::vector<std::string> notes = info.notes;
  notes.insert(notes.end(), info.remarks.begin(), info.remarks.end());
  return text_of({{"path", info.path},
                  {"format", info.format},
                  {"part", info.part},
                  {"dims", info.dims},
                  {"type", sample_type_name(info.type)},
                  {"spacing", info.geometry.spacing},
                  {"origin", info.geometry.origin},
                  {"direction", info.geometry.direction},
                  {"space", space_name(info.geometry.space)},
                  {"unit", info.geometry.unit},
                  {"slope", info.slope},
                  {"intercept", info.intercept},
                  {"notes", notes}});
}

std::string range_json(double min, double max, std::uint64_t nan) {
  const bool any = min <= max;
  return text_of({{"min", any ? number_or_null(min) : Json(nullptr)},
                  {"max", any ? number_or_null(max) : Json(nullptr)},
                  {"nan", nan}});
}

std::string surface_json(const SurfaceReport& surface) { return text_of(surface_of(surface)); }

std::string run_json(const MeshReport& report) {
  Json json = {{"version", ISOWEAVE_VERSION},
               {"backend", report.device == Device::kCuda ? "cuda" : "cpu"},
               {"threads", report.threads},
               {"slab", report.slab},
               {"schedule", schedule_name(report.schedule)},
               {"input", Json::object()}};
  json.update(counts_of(report));
  json.update({{"components_dropped", report.components_dropped},
               {"triangles_dropped", report.triangles_dropped},
               {"rounds", report.rounds},
               {"locked_vertices", report.locked_vertices},
               {"seconds", seconds_of(report)},
               {"memory", {{"peak_bytes", report.peak_bytes}, {"predicted_bytes", nullptr}}},
               {"sweep", sweep_of(report.sweep)},
               {"warnings", report.warnings}});
  json.update(surface_of(report));
  add_target(report, json);
  if (report.cap_cells) json["cap_cells"] = *report.cap_cells;
  if (!report.blocks.empty()) json["blocks"] = blocks_of(report.blocks);
  if (!report.ranks.empty()) json["ranks"] = ranks_of(report.ranks);
  if (report.preview) json["preview"] = preview_of(*report.preview);
  return text_of(json);
}

std::string counts_json(const MeshReport& report) {
  Json json = counts_of(report);
  json["warnings"] = report.warnings;
  add_target(report, json);
  return text_of(json);
}

std::string forecast_json(const Forecast& forecast, std::optional<std::uint64_t> output_bytes) {
  Json json = {{"triangles_extracted", forecast.triangles_extracted},
               {"triangles", forecast.triangles},
               {"vertices", forecast.vertices}};
  if (output_bytes) json["output_bytes"] = *output_bytes;
  json["peak_bytes"] = forecast.peak_bytes;
  json["least_bytes"] = forecast.least_bytes;
  json["seconds"] = forecast.seconds;
  return text_of(json);
}

std::string check_json(const MeshCheck& check, std::optional<std::string_view> path) {
  Json json = {{"version", ISOWEAVE_VERSION}};
  if (path) json["path"] = *path;
  json.update({{"triangles", check.triangles},
               {"vertices", check.vertices},
               {"unused_vertices", check.unused_vertices},
               {"open_edges", check.open_edges},
               {"nonmanifold_edges", check.nonmanifold_edges},
               {"nonmanifold_vertices", check.nonmanifold_vertices},
               {"misoriented_edges", check.misoriented_edges},
               {"degenerate_triangles", check.degenerate_triangles},
               {"coincident_triangles", check.coincident_triangles},
               {"zero_area_triangles", check.zero_area_triangles},
               {"components", check.components},
               {"euler", check.euler},
               {"area", number_or_null(check.area)},
               {"volume", number_or_null(check.volume)},
               {"angles", angles_of(check.angles)},
               {"digest", digest_text(check.digest)}});
  return text_of(json);
}

std::string self_intersections_json(const SelfIntersections& found) {
  return text_of({{"pairs", found.pairs()},
                  {"apart", found.apart},
                  {"at_vertex", found.at_vertex},
                  {"at_edge", found.at_edge},
                  {"triangles", found.triangles},
                  {"without_area", found.without_area},
                  {"first", found.first}});
}

std::string distances_json(const MeshDistance& distance, double unit) {
  const auto one_way = [&](const OneWayDistance& way) { return distance_of(way.mean, way.rms, way.max, unit); };
  return text_of({{"a_to_b", one_way(distance.a_to_b)},
                  {"b_to_a", one_way(distance.b_to_a)},
                  {"both", distance_of(distance.mean, distance.rms, distance.max, unit)}});
}

}  // namespace isoweave
