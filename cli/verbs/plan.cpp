// isoweave plan: the tasks of a mesh that many processes make.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "options/files.hpp"
#include "options/possible.hpp"
#include "options/values.hpp"
#include "report/print.hpp"
#include "signals.hpp"
#include "verbs/mesh_blocks.hpp"
#include "verbs/mesh_isos.hpp"
#include "verbs/mesh_options.hpp"
#include "verbs/mesh_task_options.hpp"
#include "verbs/task_folder.hpp"
#include "verbs/verbs.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kPlanExamples = R"(
Examples:
  isoweave plan huge.zarr --iso 100 --blocks 512 -o tasks
  isoweave work tasks          (in as many shells as there are, on any machine)
  isoweave status tasks
  isoweave collect tasks -o huge.ply

The mesh is that of isoweave mesh with the same options.)";

void run_plan(MeshArguments arguments, const std::string& folder, bool quiet) {
  const std::int64_t block = asked_blocks(arguments).value_or(256);
  if (has_several_isos(arguments)) wrong_value("--iso", "one value", arguments.iso);
  if (is_read_once(arguments.input.path))
    throw std::invalid_argument("plan: expected a volume that every task can read");
  refuse_secrets(arguments, "plan");
  if (arguments.iso == "auto") {
    arguments.iso = fmt::format("{}", automatic_iso(arguments.input, *borrow(stop_on_signal())).iso);
    if (!quiet) print_note("--iso " + arguments.iso + " (Otsu's threshold)");
  }
  const MeshOptions asked = mesh_options(arguments);
  require_possible({RunKind::kBlocks, "plan", asked, {}, arguments.stop, arguments.components});
  RunControl control;
  control.stop = borrow(stop_on_signal());
  const PlannedMesh plan = make_plan(arguments, block, folder, control);
  const TaskList tasks = list_tasks(plan.mesh);
  if (quiet) return;
  tell_lengths(arguments, plan.volume);
  print_note(fmt::format("{}: {} tasks in {} stages, {} of them to read the volume: isoweave work {}", folder,
                         grouped(tasks.count()), tasks.stages.size(), grouped(tasks.stages.front()), folder));
}

}  // namespace

void add_plan_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("plan", "Plan a mesh that many processes make");
  const auto arguments = std::make_shared<MeshArguments>();
  const auto folder = std::make_shared<std::string>();
  const auto quiet = std::make_shared<bool>(false);
  add_input_options(*verb, arguments->input);
  add_surface_options(*verb, *arguments);
  add_simplification_options(*verb, *arguments);
  verb->add_option("-o,--output", *folder, "Folder of the tasks, which is made")->required();
  verb->add_option("--blocks", arguments->blocks, "Cells along each side of a task's block")->default_str("256");
  verb->add_flag("--quiet", *quiet, "Print errors alone");
  verb->footer(kPlanExamples);
  verb->callback([arguments, folder, quiet] {
    if (arguments->input.path.empty()) throw CLI::RequiredError("VOLUME");
    if (arguments->iso.empty()) throw CLI::RequiredError("--iso");
    arguments->slab = "auto";
    arguments->every = "5min";
    run_plan(*arguments, *folder, *quiet);
  });
}

}  // namespace isoweave::cli
