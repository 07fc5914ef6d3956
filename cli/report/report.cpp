#include "report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "isoweave/printable.hpp"
#include "report/print.hpp"

namespace isoweave::cli {
namespace {

Json sweep_json(const std::vector<SlabRecord>& sweep) {
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

Json distance_json(double mean, double rms, double max) { return {{"mean", mean}, {"rms", rms}, {"max", max}}; }

Json angles_json(const TriangleAngles& angles) {
  return {{"smallest", number_or_null(angles.smallest)},
          {"largest", number_or_null(angles.largest)},
          {"triangles_under_5", angles.under_5_degrees},
          {"smallest_histogram", {{"low", 0}, {"high", 60}, {"triangles", angles.smallest_in_bins}}}};
}

// One half of a pair beyond 16 bits, or the whole.
std::string unit_escaped(std::uint32_t unit) { return fmt::format("\\u{:04x}", unit); }

std::string character_escaped(char32_t code) {
  constexpr std::uint32_t kBasic = 0x10000;
  if (code < kBasic) return unit_escaped(code);
  const std::uint32_t beyond = code - kBasic;
  return unit_escaped(0xd800 + (beyond >> 10U)) + unit_escaped(0xdc00 + (beyond & 0x3ffU));
}

// JSON text with characters that do not show as escapes. Such characters can only be inside strings, where an escape
// means the same.
std::string escaped(std::string_view json) {
  std::string text;
  while (!json.empty()) {
    const TextCharacter character = first_character(json);
    const bool plain = character.is_printable() || character.code == U'\n';
    text += plain ? std::string(json.substr(0, character.bytes)) : character_escaped(character.code);
    json.remove_prefix(character.bytes);
  }
  return text;
}

}  // namespace

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json volume_json(const VolumeInfo& info, const std::string& path) {
  return {{"path", path},
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

void add_range(Json& input, double min, double max, std::uint64_t nan) {
  input["min"] = min <= max ? number_or_null(min) : Json(nullptr);
  input["max"] = min <= max ? number_or_null(max) : Json(nullptr);
  input["nan"] = nan;
}

Json label_json(const Label& label) {
  if (label.is_negative()) return static_cast<std::int64_t>(label.bits());
  return label.bits();
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
  return json;
}

Json left_out_json(const LeftOutReport& left_out, const std::string& path) {
  return {{"path", path},
          {"chunks", left_out.chunks},
          {"chunks_left_out", left_out.chunks_left_out},
          {"bytes_left_out", left_out.bytes_left_out}};
}

Json forecast_json(const Forecast& forecast, std::uint64_t output_bytes) {
  return {{"triangles_extracted", forecast.triangles_extracted},
          {"triangles", forecast.triangles},
          {"vertices", forecast.vertices},
          {"output_bytes", output_bytes},
          {"peak_bytes", forecast.peak_bytes},
          {"least_bytes", forecast.least_bytes},
          {"seconds", forecast.seconds}};
}

Json check_json(const MeshCheck& check, const std::string& path) {
  return {{"version", ISOWEAVE_VERSION},
          {"path", path},
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

Box box_of(const TriangleMesh& mesh) {
  Box box;
  bool first = true;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double place = mesh.offset[axis] + double{mesh.vertices[v][axis]};
        box.low[axis] = first ? place : std::min(box.low[axis], place);
        box.high[axis] = first ? place : std::max(box.high[axis], place);
      }
      first = false;
    }
  }
  return box;
}

Json place_json(const TriangleMesh& mesh) {
  const Box box = box_of(mesh);
  return {{"unit", mesh.unit},
          {"space", mesh.space},
          {"offset", mesh.offset},
          {"box", {{"low", box.low}, {"high", box.high}}}};
}

Json self_intersections_json(const SelfIntersections& found) {
  return {{"pairs", found.pairs()},   {"apart", found.apart},         {"at_vertex", found.at_vertex},
          {"at_edge", found.at_edge}, {"triangles", found.triangles}, {"without_area", found.without_area},
          {"first", found.first}};
}

Json distances_json(const MeshDistance& distance, double unit) {
  const auto one_way = [&](const OneWayDistance& way) {
    return distance_json(way.mean / unit, way.rms / unit, way.max / unit);
  };
  return {{"a_to_b", one_way(distance.a_to_b)},
          {"b_to_a", one_way(distance.b_to_a)},
          {"both", distance_json(distance.mean / unit, distance.rms / unit, distance.max / unit)}};
}

std::string json_text(const Json& json) {
  return escaped(json.dump(2, ' ', false, nlohmann::detail::error_handler_t::replace)) + "\n";
}

void write_report(OutputFile& file, const Json& json) {
  const std::string text = json_text(json);
  file.write(std::as_bytes(std::span(text)));
  file.commit();
}

std::string state_text(std::uint64_t open_edges, std::uint64_t nonmanifold_edges, std::uint64_t nonmanifold_vertices) {
  std::string text = open_edges == 0 ? "closed" : fmt::format("open ({} border edges)", grouped(open_edges));
  if (nonmanifold_edges == 0 && nonmanifold_vertices == 0) return text + ", manifold";
  return text + fmt::format(", not manifold ({} edges, {} vertices)", grouped(nonmanifold_edges),
                            grouped(nonmanifold_vertices));
}

void print_surface(const SurfaceReport& surface, const std::string& output) {
  print_note(fmt::format("{}: {} triangles, {} vertices, {}, digest {}", output, grouped(surface.triangles),
                         grouped(surface.vertices),
                         state_text(surface.open_edges, surface.nonmanifold_edges, surface.nonmanifold_vertices),
                         digest_text(surface.digest)));
}

void print_left_out(const MeshReport& report, const std::string& path) {
  if (!report.left_out) return;
  const LeftOutReport& left_out = *report.left_out;
  std::string text =
      fmt::format("by its index {}, {} of samples were not read", printable(path), byte_text(left_out.bytes_left_out));
  if (left_out.chunks > 0) {
    text += fmt::format(", nor {} of {} chunks", grouped(left_out.chunks_left_out), grouped(left_out.chunks));
  }
  print_note(text);
}

void print_summary(const MeshReport& report, const std::string& output, double voxels) {
  print_note(fmt::format("{}: {} of {} triangles, {} vertices, {}", output, grouped(report.triangles),
                         grouped(report.triangles_extracted), grouped(report.vertices),
                         state_text(report.open_edges, report.nonmanifold_edges, report.nonmanifold_vertices)));
  std::string speed = fmt::format("{:.2f} s", report.seconds_total);
  if (voxels > 0 && report.seconds_total > 0) {
    speed += fmt::format(", {:.1f} Mvoxel/s", voxels * 1e-6 / report.seconds_total);
  }
  print_note(fmt::format("{}, peak memory {}, {} thread{}, digest {}", speed, byte_text(report.peak_bytes),
                         report.threads, report.threads == 1 ? "" : "s", digest_text(report.digest)));
}

std::string_view space_name(Space space) {
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

std::string_view schedule_name(Schedule schedule) {
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

}  // namespace isoweave::cli
