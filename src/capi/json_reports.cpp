#include "capi/json_reports.hpp"

#include <cmath>
#include <optional>
#include <utility>

namespace isoweave::capi {
namespace {

// A number, or null where JSON has no number for it.
Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json label_json(const Label& label) {
  if (label.is_negative()) return static_cast<std::int64_t>(label.bits());
  return label.bits();
}

Json distance_json(double mean, double rms, double max) { return {{"mean", mean}, {"rms", rms}, {"max", max}}; }

Json sweep_json(std::span<const SlabRecord> sweep) {
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

const char* space_name(Space space) {
  switch (space) {
    case Space::kLps:
      return "lps";
    case Space::kRas:
      return "ras";
    case Space::kUnknown:
      break;
  }
  return "unknown";
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

Json angles_json(const TriangleAngles& angles) {
  return {{"smallest", number_or_null(angles.smallest)},
          {"largest", number_or_null(angles.largest)},
          {"triangles_under_5", angles.under_5_degrees},
          {"smallest_histogram", {{"low", 0}, {"high", 60}, {"triangles", angles.smallest_in_bins}}}};
}

}  // namespace

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, nlohmann::detail::error_handler_t::replace); }

Json volume_json(const VolumeInfo& info) {
  return {{"path", info.path},
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
          {"notes", info.notes}};
}

Json histogram_json(const Histogram& histogram) {
  const std::optional<double> iso = otsu_threshold(histogram);
  return {{"min", histogram.empty() ? Json(nullptr) : Json(histogram.min)},
          {"max", histogram.empty() ? Json(nullptr) : Json(histogram.max)},
          {"nan", histogram.nan},
          {"infinite", histogram.infinite},
          {"histogram", histogram.bins},
          {"suggested_iso", iso ? Json(*iso) : Json(nullptr)}};
}

Json labels_json(std::span<const LabelExtent> labels) {
  Json list = Json::array();
  for (const LabelExtent& label : labels)
    list.push_back({{"label", label_json(label.label)}, {"samples", label.samples}});
  return list;
}

Json surface_json(const SurfaceReport& surface) {
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

Json run_json(const MeshReport& report, Json input) {
  Json json = {{"version", ISOWEAVE_VERSION},
               {"backend", report.device == Device::kCuda ? "cuda" : "cpu"},
               {"threads", report.threads},
               {"slab", report.slab},
               {"schedule", schedule_name(report.schedule)},
               {"input", std::move(input)},
               {"cells_crossed", report.cells_crossed},
               {"triangles_extracted", report.triangles_extracted},
               {"vertices_extracted", report.vertices_extracted},
               {"collapses", report.collapses},
               {"postponed", report.postponed},
               {"rekeyed", report.rekeyed},
               {"specks", report.specks},
               {"components_dropped", report.components_dropped},
               {"triangles_dropped", report.triangles_dropped},
               {"rounds", report.rounds},
               {"locked_vertices", report.locked_vertices},
               {"seconds",
                {{"read", report.seconds_read},
                 {"extract", report.seconds_extract},
                 {"simplify", report.seconds_simplify},
                 {"write", report.seconds_write},
                 {"total", report.seconds_total}}},
               {"memory", {{"peak_bytes", report.peak_bytes}, {"predicted_bytes", nullptr}}},
               {"sweep", sweep_json(report.sweep)},
               {"warnings", report.warnings}};
  json.update(surface_json(report));
  if (report.levels.empty()) return json;
  for (const SurfaceReport& level : report.levels) json["levels"].push_back(surface_json(level));
  return json;
}

const char* extractor_name(ExtractorKind extractor) {
  switch (extractor) {
    case ExtractorKind::kTrilinear:
      return "trilinear";
    case ExtractorKind::kTetrahedra:
      return "tetrahedra";
    case ExtractorKind::kDual:
      return "dual";
    case ExtractorKind::kCubes:
      break;
  }
  return "cubes";
}

void add_range(const MeshReport& report, Json& input) {
  const bool any = report.min <= report.max;
  input["min"] = any ? number_or_null(report.min) : Json(nullptr);
  input["max"] = any ? number_or_null(report.max) : Json(nullptr);
  input["nan"] = report.nan;
}

Json forecast_json(const Forecast& forecast) {
  return {{"triangles_extracted", forecast.triangles_extracted},
          {"triangles", forecast.triangles},
          {"vertices", forecast.vertices},
          {"peak_bytes", forecast.peak_bytes},
          {"least_bytes", forecast.least_bytes},
          {"seconds", forecast.seconds}};
}

Json check_json(const MeshCheck& check) {
  return {{"version", ISOWEAVE_VERSION},
          {"triangles", check.triangles},
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
          {"angles", angles_json(check.angles)},
          {"digest", digest_text(check.digest)}};
}

Json self_intersections_json(const SelfIntersections& found) {
  return {{"pairs", found.pairs()},   {"apart", found.apart},         {"at_vertex", found.at_vertex},
          {"at_edge", found.at_edge}, {"triangles", found.triangles}, {"without_area", found.without_area},
          {"first", found.first}};
}

Json distances_json(const MeshDistance& distance) {
  const auto one_way = [](const OneWayDistance& way) { return distance_json(way.mean, way.rms, way.max); };
  return {{"a_to_b", one_way(distance.a_to_b)},
          {"b_to_a", one_way(distance.b_to_a)},
          {"both", distance_json(distance.mean, distance.rms, distance.max)}};
}

}  // namespace isoweave::capi
