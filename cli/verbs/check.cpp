// isoweave check: counts and defects of a mesh. Defects are findings, not errors.
#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <memory>

#include "isoweave/measure.hpp"
#include "isoweave/printable.hpp"
#include "isoweave/weld.hpp"
#include "options/input_mesh.hpp"
#include "options/values.hpp"
#include "report/print.hpp"
#include "report/report.hpp"
#include "signals.hpp"
#include "verbs/verbs.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kCheckExamples = R"(
Examples:
  isoweave check bone.ply
  isoweave check bone.ply --self-intersections --json)";

constexpr std::size_t kListedPairs = 10;

struct CheckArguments {
  ReadMeshOptions reading;
  std::string path, threads = "all";
  bool self_intersections = false, json = false, weld = false;
};

std::string degrees_text(double angle) { return std::isnan(angle) ? "none" : fmt::format("{:.4g} degrees", angle); }

// The share of the triangles that have an angle below 5 degrees.
std::string sharp_text(const TriangleAngles& angles) {
  if (angles.triangles == 0) return "none";
  return fmt::format("in {:.3g} %",
                     100 * static_cast<double>(angles.under_5_degrees) / static_cast<double>(angles.triangles));
}

// Warns of coincident vertices: where rounding has put several into one place, a surface that is closed by its numbers
// does not look closed.
std::string coincident_text(const MeshCheck& check) {
  if (check.coincident_triangles == 0) return "";
  return fmt::format(", {} triangles with corners in one place", grouped(check.coincident_triangles));
}

std::string check_text(const MeshCheck& check, const TriangleMesh& mesh, const std::string& path) {
  std::string text = fmt::format(
      "{}: {}{}{}\n", printable(path),
      state_text(check.open_edges, check.nonmanifold_edges, check.nonmanifold_vertices),
      check.misoriented_edges == 0 ? ", consistently oriented" : ", not consistently oriented", coincident_text(check));
  const auto line = [&](std::string_view name, const std::string& value) {
    text += fmt::format("{:<22}{:>18}\n", name, value);
  };
  line("triangles", grouped(check.triangles));
  line("vertices", grouped(check.vertices));
  line("unused vertices", grouped(check.unused_vertices));
  line("open edges", grouped(check.open_edges));
  line("non-manifold edges", grouped(check.nonmanifold_edges));
  line("non-manifold vertices", grouped(check.nonmanifold_vertices));
  line("misoriented edges", grouped(check.misoriented_edges));
  line("degenerate triangles", grouped(check.degenerate_triangles));
  line("coincident corners", grouped(check.coincident_triangles));
  line("triangles of area 0", grouped(check.zero_area_triangles));
  line("components", grouped(check.components));
  line("Euler number", std::to_string(check.euler));
  line("size", size_text(box_of(mesh).size(), mesh.unit));
  line("area", fmt::format("{:.9g}", check.area));
  line("volume", fmt::format("{:.9g}", check.volume));
  line("smallest angle", degrees_text(check.angles.smallest));
  line("largest angle", degrees_text(check.angles.largest));
  line("angles under 5 degrees", sharp_text(check.angles));
  line("unit", mesh.unit.empty() ? "not said: mm" : mesh.unit);
  line("space", mesh.space.empty() ? "not said" : mesh.space);
  if (mesh.offset != std::array<double, 3>{0, 0, 0}) {
    line("offset", fmt::format("{},{},{}", mesh.offset[0], mesh.offset[1], mesh.offset[2]));
  }
  line("digest", digest_text(check.digest));
  return text;
}

std::string self_intersections_text(const SelfIntersections& found) {
  std::string text;
  const auto line = [&](std::string_view name, std::uint64_t count) {
    text += fmt::format("{:<22}{:>18}\n", name, grouped(count));
  };
  line("self-intersections", found.pairs());
  line("  no common vertex", found.apart);
  line("  beyond a vertex", found.at_vertex);
  line("  beyond an edge", found.at_edge);
  line("triangles in them", found.triangles);
  line("triangles without area", found.without_area);
  if (found.first.empty()) return text;
  text += found.pairs() > found.first.size() ? "first pairs of triangles, numbered from 0:\n"
                                             : "pairs of triangles, numbered from 0:\n";
  for (const auto& [a, b] : found.first) text += fmt::format("  {} {}\n", a, b);
  return text;
}

// Reports the facts of the mesh beside its counts.
void tell_input(const CheckArguments& arguments, const InputMesh& input, const MeshCheck& check, Json& json) {
  std::vector<std::string> warnings = mesh_warnings(arguments.path, input.mesh);
  if (check.open_edges > 0 && !arguments.weld) {
    const std::uint64_t seam_edges = count_seam_edges(input.mesh);
    json["seam_edges"] = seam_edges;
    for (std::string& warning : seam_warnings(arguments.path, seam_edges)) warnings.push_back(std::move(warning));
  }
  if (arguments.weld) json["welded"] = input.welded;
  json["warnings"] = warnings;
  print_welded(arguments.path, arguments.weld, input.welded);
  for (const std::string& warning : warnings) print_note("warning: " + warning);
}

void run_check(const CheckArguments& arguments) {
  const int threads = parse_threads(arguments.threads);
  exit_on_signal();
  const InputMesh input = read_input_mesh(arguments.path, arguments.reading, arguments.weld);
  const TriangleMesh& mesh = input.mesh;
  const MeshCheck check = check_mesh(mesh);
  Json json = Json::parse(check_json(check, arguments.path));
  json.update(place_json(mesh));
  tell_input(arguments, input, check, json);
  std::string text = check_text(check, mesh, arguments.path);
  if (arguments.self_intersections) {
    const SelfIntersections found = count_self_intersections(mesh, kListedPairs, threads);
    json["self_intersections"] = Json::parse(self_intersections_json(found));
    text += self_intersections_text(found);
  }
  print_out(arguments.json ? json_text(json) : text);
}

}  // namespace

void add_check_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("check", "Show counts, size, defects and fingerprint of a mesh");
  const auto arguments = std::make_shared<CheckArguments>();
  verb->add_option("MESH", arguments->path, kMeshInputHelp)->required();
  add_weld_option(*verb, arguments->weld);
  verb->add_flag("--self-intersections", arguments->self_intersections,
                 "Count the pairs of triangles that meet beyond what they share, exactly");
  add_external_option(*verb, arguments->reading);
  verb->add_option("--threads", arguments->threads, "Threads, or all; never changes the result")->capture_default_str();
  verb->add_flag("--json", arguments->json, "Print JSON");
  verb->footer(kCheckExamples);
  verb->callback([arguments] { run_check(*arguments); });
}

}  // namespace isoweave::cli
