#include "report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "isoweave/printable.hpp"
#include "isoweave/report_json.hpp"
#include "report/print.hpp"

namespace isoweave::cli {
namespace {

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

Json volume_json(const VolumeInfo& info, const std::string& path) {
  Json json = Json::parse(isoweave::volume_json(info));
  json["path"] = path;
  return json;
}

void print_volume_notes(const VolumeInfo& info) {
  for (const std::string& note : info.notes) print_note("warning: " + note);
  for (const std::string& remark : info.remarks) print_note(remark);
}

void add_range(Json& input, double min, double max, std::uint64_t nan) {
  input.update(Json::parse(range_json(min, max, nan)));
}

Json label_json(const Label& label) { return Json::parse(label.text()); }

Json run_json(const MeshReport& report, Json input) {
  Json json = Json::parse(isoweave::run_json(report));
  json["input"] = std::move(input);
  return json;
}

Json left_out_json(const LeftOutReport& left_out, const std::string& path) {
  return {{"path", path},
          {"chunks", left_out.chunks},
          {"chunks_left_out", left_out.chunks_left_out},
          {"bytes_left_out", left_out.bytes_left_out}};
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

}  // namespace isoweave::cli
