// isoweave collect: the mesh out of the tasks of isoweave plan.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "isoweave/error.hpp"
#include "options/files.hpp"
#include "options/levels.hpp"
#include "options/output_mesh.hpp"
#include "options/run.hpp"
#include "report/evidence.hpp"
#include "report/print.hpp"
#include "report/report.hpp"
#include "signals.hpp"
#include "verbs/mesh_options.hpp"
#include "verbs/task_folder.hpp"
#include "verbs/verbs.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kCollectExamples = R"(
Examples:
  isoweave collect tasks -o huge.ply --report huge.json

Every task must be done. The folder stays: remove it when the mesh is there.)";

struct CollectArguments {
  std::string folder, threads = "all", report;
  OutputOptions output;
  bool quiet = false, no_clobber = false, allow_empty = false;
};

RunOptions run_options(const CollectArguments& arguments) {
  RunOptions run;
  run.threads = arguments.threads;
  run.report = arguments.report;
  run.quiet = arguments.quiet;
  run.no_clobber = arguments.no_clobber;
  run.allow_empty = arguments.allow_empty;
  return run;
}

// Collects the tasks. Where they have gone too far for a number of triangles, the plan gets a lower error.
MeshReport collect(const PlannedMesh& plan, const LevelSinks& sinks, const RunControl& control) {
  try {
    return collect_tasks(plan.mesh, sinks.pointers(), control);
  } catch (const HeadStartTooHigh& found) {
    lower_head_start(plan.mesh.folder, found.lower());
    throw BadInput(fmt::format("{}: the plan has a lower error now: isoweave work {}, then collect again", found.what(),
                               plan.mesh.folder));
  }
}

void run_collect(const CollectArguments& arguments) {
  const RunOptions run = run_options(arguments);
  RunControl control = run_control(run);
  control.stop = borrow(stop_on_signal());
  PlannedMesh plan = read_plan(arguments.folder);
  plan.arguments.output = arguments.output;
  const std::vector<OutputOptions> outputs = level_outputs(arguments.output, plan.arguments.stop);
  for (const OutputOptions& output : outputs) {
    check_different({plan.arguments.input.path, output.path, arguments.report});
    check_absent(arguments.no_clobber, {output.path, arguments.report});
  }
  Evidence evidence(run, {});
  const std::vector<StopOptions> stops = stop_levels(plan.arguments.stop);
  const LevelSinks sinks(outputs, [&](std::size_t level) {
    return file_options(plan.arguments, stops[level], plan.mesh.options, plan.volume);
  });
  MeshReport report = collect(plan, sinks, control);
  sinks.tell_digests(report);
  Json json = run_json(report, volume_json(plan.volume, plan.arguments.input.path));
  json["output"] = outputs.back().name();
  if (!report.levels.empty()) json["levels"] = levels_json(report, outputs);
  evidence.write(std::move(json), control, {});
  if (arguments.quiet) return;
  for (const std::string& warning : report.warnings) print_note("warning: " + warning);
  print_levels(report, outputs);
  print_target(plan.arguments.stop, report, plan.mesh.options.error, plan.volume.geometry.unit);
  const double voxels = static_cast<double>(plan.volume.slice_samples()) * static_cast<double>(plan.volume.dims[2]);
  print_summary(report, outputs.back().name(), voxels);
}

}  // namespace

void add_collect_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("collect", "Make the mesh when all tasks are done");
  const auto arguments = std::make_shared<CollectArguments>();
  verb->add_option("FOLDER", arguments->folder, "Folder of isoweave plan")->required();
  add_output_options(*verb, arguments->output);
  verb->get_option("--output")->required();
  verb->add_option("--threads", arguments->threads, "Number of threads, or all")->capture_default_str();
  verb->add_option("--report", arguments->report, "Write the report of the run as JSON");
  add_clobber_option(*verb, arguments->no_clobber);
  verb->add_flag("--allow-empty", arguments->allow_empty, "Write a mesh without triangles, too");
  verb->add_flag("--quiet", arguments->quiet, "Print errors alone");
  verb->footer(kCollectExamples);
  verb->callback([arguments] { run_collect(*arguments); });
}

}  // namespace isoweave::cli
