// isoweave compare: distances between two meshes, both ways.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "isoweave/error.hpp"
#include "isoweave/length.hpp"
#include "isoweave/measure.hpp"
#include "isoweave/mesh.hpp"
#include "options/files.hpp"
#include "options/input_mesh.hpp"
#include "options/values.hpp"
#include "report/print.hpp"
#include "report/report.hpp"
#include "signals.hpp"
#include "verbs/verbs.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kCompareExamples = R"(
Examples:
  isoweave compare bone.ply full.ply
  isoweave compare bone.ply full.ply --distances colours.ply --histogram 20

Distances are measured from random points of one mesh to the other. max is the
largest of these: between them a mesh may be farther away.)";

constexpr std::int64_t kMostBins = 1'000'000;

struct CompareArguments {
  ReadMeshOptions reading;
  std::string a, b, samples = "500000", threads = "all", voxel, histogram, distances;
  bool json = false, no_clobber = false;
};

std::string distances_text(const MeshDistance& distance, double unit, std::string_view name) {
  std::string text = fmt::format("{:<18}{:>14}{:>14}{:>14}\n", name, "mean", "RMS", "max");
  const auto line = [&](std::string_view way, double mean, double rms, double max) {
    text += fmt::format("{:<18}{:>14.6g}{:>14.6g}{:>14.6g}\n", way, mean / unit, rms / unit, max / unit);
  };
  line("A to B", distance.a_to_b.mean, distance.a_to_b.rms, distance.a_to_b.max);
  line("B to A", distance.b_to_a.mean, distance.b_to_a.rms, distance.b_to_a.max);
  line("both", distance.mean, distance.rms, distance.max);
  return text;
}

// The histogram of one way. Bars for both ways side by side would be too wide.
std::string histogram_text(const OneWayDistance& way, double max, std::string_view name) {
  constexpr double kWidest = 40;
  if (max == 0) return fmt::format("{}: all distances are 0\n", name);
  const std::uint64_t most = std::ranges::max(way.histogram);
  std::string text = fmt::format("{} (bars: square roots of the counts)\n", name);
  for (std::size_t n = 0; n < way.histogram.size(); ++n) {
    const double low = max * static_cast<double>(n) / static_cast<double>(way.histogram.size());
    const double part = std::sqrt(static_cast<double>(way.histogram[n]) / static_cast<double>(most));
    text += fmt::format("  from {:>12.6g} {:>16} {}\n", low, grouped(way.histogram[n]),
                        std::string(static_cast<std::size_t>(std::ceil(kWidest * part)), '#'));
  }
  return text;
}

MeshFileOptions distances_file() {
  MeshFileOptions options;
  options.values = true;
  options.comments = {"isoweave " ISOWEAVE_VERSION, "quality: distance to the other mesh"};
  return options;
}

// Writes the distances from A's vertices to B, as colours of A.
void write_distances(const CompareArguments& arguments, TriangleMesh& a, const TriangleMesh& b, int threads) {
  a.values = vertex_distances(a, b, threads);
  write_mesh(arguments.distances, a, distances_file());
}

TriangleMesh read_surface(const std::string& path, const ReadMeshOptions& options) {
  TriangleMesh mesh = read_named_mesh(path, options);
  if (mesh.triangles.empty()) throw BadInput(path + ": expected a mesh with triangles, found none");
  print_mesh_warnings(path, mesh);
  return mesh;
}

// Brings B to the place of A, and reports that.
std::vector<std::string> match(TriangleMesh& b, const TriangleMesh& a, const CompareArguments& arguments) {
  try {
    std::vector<std::string> notes = match_place(b, a);
    for (std::string& note : notes) {
      note.insert(0, arguments.b + ": ");
      print_note(note);
    }
    return notes;
  } catch (const std::invalid_argument& error) {
    throw BadInput(fmt::format("{}: cannot be compared with {}: {}", arguments.b, arguments.a, error.what()));
  }
}

// The length of a voxel in a mesh's unit; 0: none was given.
double voxel_length(const CompareArguments& arguments, const std::string& unit) {
  if (arguments.voxel.empty()) return 0;
  try {
    const Length voxel = parse_length(arguments.voxel, unit);
    if (!voxel.in_voxels && voxel.value > 0) return voxel.value;
  } catch (const std::invalid_argument&) {
    // The library does not know which option the text came from.
  }
  wrong_value("--voxel", "a length above 0 such as 0.5, 0.5mm or 30um", arguments.voxel);
}

void run_compare(const CompareArguments& arguments) {
  DistanceOptions options;
  options.samples = static_cast<std::uint64_t>(parse_count("--samples", arguments.samples));
  options.threads = parse_threads(arguments.threads);
  voxel_length(arguments, "");  // finds an error in it now
  if (!arguments.histogram.empty()) {
    options.bins = static_cast<std::size_t>(parse_count("--histogram", arguments.histogram, "100"));
    if (options.bins > kMostBins) wrong_value("--histogram", fmt::format("at most {}", kMostBins), arguments.histogram);
  }
  check_different({arguments.a, arguments.distances});
  check_different({arguments.b, arguments.distances});
  check_absent(arguments.no_clobber, {arguments.distances});
  exit_on_signal();
  // The file is discarded: an error that would keep it from being written is found now.
  if (!arguments.distances.empty()) open_mesh_file(arguments.distances, distances_file());
  TriangleMesh a = read_surface(arguments.a, arguments.reading);
  TriangleMesh b = read_surface(arguments.b, arguments.reading);
  const std::vector<std::string> notes = match(b, a, arguments);
  const double voxel = voxel_length(arguments, a.unit);
  const MeshDistance distance = compare_meshes(a, b, options);
  if (!arguments.distances.empty()) write_distances(arguments, a, b, options.threads);
  if (!arguments.json) {
    std::string text = distances_text(distance, 1, a.unit.empty() ? "distance" : "distance in " + a.unit);
    if (voxel > 0) text += distances_text(distance, voxel, "in voxels");
    text += fmt::format("max: of {} random points on each mesh\n", grouped(options.samples));
    if (options.bins > 0) {
      text += histogram_text(distance.a_to_b, distance.max, "A to B");
      text += histogram_text(distance.b_to_a, distance.max, "B to A");
    }
    return print_out(text);
  }
  Json json = {{"version", ISOWEAVE_VERSION}, {"a", arguments.a}, {"b", arguments.b}, {"samples", options.samples}};
  json.update(place_json(a));
  json["notes"] = notes;
  json.update(Json::parse(distances_json(distance)));
  if (voxel > 0) {
    json["voxel"] = voxel;
    json["voxels"] = Json::parse(distances_json(distance, voxel));
  }
  if (options.bins > 0) {
    json["histogram"] = {{"low", 0},
                         {"high", distance.max},
                         {"a_to_b", distance.a_to_b.histogram},
                         {"b_to_a", distance.b_to_a.histogram}};
  }
  print_out(json_text(json));
}

}  // namespace

void add_compare_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("compare", "Measure the distances between two meshes");
  const auto arguments = std::make_shared<CompareArguments>();
  verb->add_option("A", arguments->a, "Mesh")->required();
  verb->add_option("B", arguments->b, "Mesh")->required();
  verb->add_option("--samples", arguments->samples, "Random points on each mesh")->capture_default_str();
  verb->add_option("--voxel", arguments->voxel,
                   "Length of a voxel, in the unit of A or in mm, um, ...: prints distances in voxels, too");
  verb->add_option("--histogram", arguments->histogram, "Counts the distances in so many equal parts, both ways");
  verb->add_option("--distances", arguments->distances,
                   "Write A as PLY with the distance to B at each vertex, as the property quality");
  add_external_option(*verb, arguments->reading);
  verb->add_option("--threads", arguments->threads, "Threads, or all; never changes the result")->capture_default_str();
  add_clobber_option(*verb, arguments->no_clobber);
  verb->add_flag("--json", arguments->json, "Print JSON");
  verb->footer(kCompareExamples);
  verb->callback([arguments] { run_compare(*arguments); });
}

}  // namespace isoweave::cli
