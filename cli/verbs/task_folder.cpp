#include "verbs/task_folder.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <system_error>
#include <utility>

#include "isoweave/error.hpp"
#include "isoweave/forecast.hpp"
#include "isoweave/output_file.hpp"
#include "isoweave/ranks.hpp"
#include "options/input_volume.hpp"
#include "report/report.hpp"
#include "verbs/mesh_options.hpp"
#include "verbs/mesh_state.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kPlan = "plan.json";

void write_file(const std::string& path, const std::string& text) {
  OutputFile file(path);
  file.write(std::as_bytes(std::span(text)));
  file.commit();
}

void check_task_folder(const std::string& folder) {
  if (!std::filesystem::is_directory(folder) || std::filesystem::is_empty(folder)) return;
  throw CannotWrite(folder + ": expected a new or empty folder for the tasks, found files in it");
}

void make_task_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder)) throw CannotWrite(folder + ": cannot be made: " + error.message());
}

PlannedMesh planned(MeshArguments arguments, std::int64_t block, const std::string& folder) {
  PlannedMesh plan{std::move(arguments), {}, {}};
  plan.volume = open_input(plan.arguments.input)->info();
  MeshOptions options = mesh_options(plan.arguments);
  set_lengths(plan.arguments, plan.volume, options);
  set_number(plan.arguments.stop, options);
  BlockOptions blocks;
  blocks.size = block;
  plan.mesh = {folder, [input = plan.arguments.input] { return open_input(input); }, options, blocks};
  return plan;
}

// The error up to which tasks may decide everything; 0 where no number of triangles is to stop them.
double head_start_of(const PlannedMesh& plan, const RunControl& control) {
  if (!plan.arguments.stop.has_number()) return 0;
  return forecast_mesh(*plan.mesh.open(), plan.mesh.options, control).head_start;
}

Json read_json(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw BadInput(path + ": expected the plan of isoweave plan, found none");
  return Json::parse(std::string(std::istreambuf_iterator<char>(in), {}));
}

// Tasks that are done, and lengths in voxels, are of the volume that was planned.
void require_planned_volume(const PlannedMesh& plan, const std::string& path, const std::string& expected) {
  const std::string found = facts_of_volume(plan.volume);
  if (found == expected) return;
  throw BadInput(
      fmt::format("{}: changed since it was planned in {}: expected {}, found {}: plan it again, in a new folder",
                  plan.arguments.input.path, path, expected, found));
}

// A rule for make for the tasks of each stage. A pattern with two targets is run once for both files of a task.
std::string makefile(const TaskList& tasks) {
  std::string text =
      "# make -j8 -C FOLDER; then: isoweave collect FOLDER -o MESH\nISOWEAVE ?= isoweave\n"
      "THREADS ?= 1\n\nall:";
  std::string rules;
  for (std::size_t stage = 0; stage < tasks.stages.size(); ++stage) {
    const std::uint64_t first = tasks.first_of(stage);
    text += fmt::format(" stage-{}", stage);
    rules += fmt::format(
        "\nSTAGE{0} := $(foreach task,$(shell seq {1} {2}),$(task).final $(task).rest)\nstage-{0}: $(STAGE{0})\n",
        stage, first, first + tasks.stages[stage] - 1);
    if (stage > 0) rules += fmt::format("$(STAGE{}): | stage-{}\n", stage, stage - 1);
    rules += fmt::format(".PHONY: stage-{}\n", stage);
  }
  return text + "\n.PHONY: all\n" + rules +
         "\n%.final %.rest:\n\t$(ISOWEAVE) work . --task $* --threads $(THREADS) --quiet\n";
}

// An array of jobs for each stage.
std::string slurm_script(const TaskList& tasks) {
  std::string text =
      "#!/bin/sh\n# Run in this folder: one array of jobs for each stage, after that of the stage before.\n"
      "set -eu\nafter=\nfor range in";
  for (std::size_t stage = 0; stage < tasks.stages.size(); ++stage) {
    const std::uint64_t first = tasks.first_of(stage);
    text += fmt::format(" {}-{}", first, first + tasks.stages[stage] - 1);
  }
  return text +
         "; do\n  after=$(sbatch --parsable ${after:+--dependency=afterok:$after} --array=\"$range\" \"$@\" --wrap \\\n"
         "    \"${ISOWEAVE:-isoweave} work . --task \\$SLURM_ARRAY_TASK_ID --threads "
         "\\${SLURM_CPUS_PER_TASK:-1}\")\ndone\n";
}

}  // namespace

PlannedMesh make_plan(const MeshArguments& arguments, std::int64_t block, const std::string& folder,
                      const RunControl& control) {
  PlannedMesh plan = planned(arguments, block, folder);
  const TaskList tasks = list_tasks(plan.mesh);
  check_task_folder(folder);
  plan.mesh.head_start = head_start_of(plan, control);
  make_task_folder(folder);
  const Json json = {{"version", ISOWEAVE_VERSION},
                     {"blocks", block},
                     {"stages", tasks.stages},
                     {"head_start", plan.mesh.head_start},
                     {"volume", facts_of_volume(plan.volume)},
                     {"mesh", task_json(plan.arguments, plan.mesh.options)}};
  write_job_files(folder, tasks);
  write_file(folder + "/" + kPlan, json.dump(2) + "\n");
  return plan;
}

void lower_head_start(const std::string& folder, double lower) {
  const std::string path = folder + "/" + kPlan;
  Json json = read_json(path);
  json["head_start"] = lower;
  remove_results(folder);
  write_file(path, json.dump(2) + "\n");
}

PlannedMesh read_plan(const std::string& folder) {
  const std::string path = folder + "/" + kPlan;
  try {
    const Json json = read_json(path);
    if (json.at("version") != ISOWEAVE_VERSION) {
      throw BadInput(path + ": expected a plan of isoweave " ISOWEAVE_VERSION ", found one of " +
                     json.at("version").get<std::string>());
    }
    MeshArguments arguments;
    set_task(arguments, arguments, json.at("mesh"));
    PlannedMesh plan = planned(std::move(arguments), json.at("blocks"), folder);
    plan.mesh.head_start = json.at("head_start");
    require_planned_volume(plan, path, json.at("volume"));
    return plan;
  } catch (const Json::exception&) {
    throw BadInput(path + ": expected the plan of isoweave plan, found another text");
  }
}

void write_job_files(const std::string& folder, const TaskList& tasks) {
  write_file(folder + "/Makefile", makefile(tasks));
  write_file(folder + "/slurm.sh", slurm_script(tasks));
}

}  // namespace isoweave::cli
