// isoweave compare: distances between two meshes, both ways.
#include <memory>

#include "isoweave/error.hpp"
#include "isoweave/measure.hpp"
#include "options.hpp"
#include "output.hpp"
#include "report.hpp"
#include "signals.hpp"
#include "verbs.hpp"

namespace isoweave::cli {
namespace {

struct CompareArguments {
  std::string a, b, samples = "500000", threads = "all", voxel;
  bool json = false;
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

TriangleMesh read_surface(const std::string& path) {
  TriangleMesh mesh = read_mesh(path);
  if (mesh.triangles.empty()) throw BadInput(path + ": expected a mesh with triangles, found none");
  return mesh;
}

void run_compare(const CompareArguments& arguments) {
  DistanceOptions options;
  options.samples = static_cast<std::uint64_t>(parse_count("--samples", arguments.samples));
  options.threads = parse_threads(arguments.threads);
  const double voxel = arguments.voxel.empty() ? 0 : parse_number("--voxel", arguments.voxel);
  if (!arguments.voxel.empty() && !(voxel > 0)) wrong_value("--voxel", "a positive length", arguments.voxel);
  exit_on_signal();
  const MeshDistance distance = compare_meshes(read_surface(arguments.a), read_surface(arguments.b), options);
  if (!arguments.json) {
    std::string text = distances_text(distance, 1, "distance");
    if (voxel > 0) text += distances_text(distance, voxel, "in voxels");
    return print_out(text);
  }
  Json json = {{"version", ISOWEAVE_VERSION}, {"a", arguments.a}, {"b", arguments.b}, {"samples", options.samples}};
  json.update(distances_json(distance, 1));
  if (voxel > 0) {
    json["voxel"] = voxel;
    json["voxels"] = distances_json(distance, voxel);
  }
  print_out(json_text(json));
}

}  // namespace

void add_compare_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("compare", "Mean, RMS and largest distance between two meshes, both ways");
  const auto arguments = std::make_shared<CompareArguments>();
  verb->add_option("A", arguments->a, "Mesh")->required();
  verb->add_option("B", arguments->b, "Mesh")->required();
  verb->add_option("--samples", arguments->samples, "Points on each mesh")->capture_default_str();
  verb->add_option("--voxel", arguments->voxel, "Length of a voxel: prints distances in voxels, too");
  verb->add_option("--threads", arguments->threads, "Threads, or all; never changes the result")->capture_default_str();
  verb->add_flag("--json", arguments->json, "Print JSON");
  verb->callback([arguments] { run_compare(*arguments); });
}

}  // namespace isoweave::cli
