// isoweave work: works on the tasks of a plan. isoweave status: how far they are.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include "isoweave/error.hpp"
#include "options/run.hpp"
#include "options/values.hpp"
#include "report/print.hpp"
#include "report/report.hpp"
#include "signals.hpp"
#include "verbs/task_folder.hpp"
#include "verbs/verbs.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kWorkExamples = R"(
Examples:
  isoweave work tasks                all tasks that no other process works on
  isoweave work tasks --task 12      one task, for a scheduler
  make -j8 -C tasks                  the same for all tasks

Any number of processes may work on a folder, on any machines that share it. A
task whose process was killed is done again by another one.)";

constexpr std::chrono::milliseconds kPause{200};

struct WorkArguments {
  std::string folder, task, threads = "all";
  bool quiet = false, wait = false;
};

// Works on one task; on one that another process works on, once that process has ended.
TaskEnd work_or_wait(const TaskMesh& mesh, std::uint64_t task, const RunControl& control) {
  while (true) {
    const TaskEnd end = do_task(mesh, task, control);
    if (end != TaskEnd::kElsewhere) return end;
    if (control.stop->load()) throw Interrupted("interrupted while another process works on the task");
    std::this_thread::sleep_for(kPause);
  }
}

// Works on one task, and says what stands in its way.
void work_on(const PlannedMesh& plan, const TaskList& tasks, std::uint64_t task, const RunControl& control, bool wait) {
  switch (wait ? work_or_wait(plan.mesh, task, control) : do_task(plan.mesh, task, control)) {
    case TaskEnd::kTooEarly:
      throw BadInput(fmt::format("{}: task {} takes what stage {} leaves: expected all tasks of that stage to be done",
                                 plan.mesh.folder, task, tasks.stage_of(task) - 1));
    case TaskEnd::kElsewhere:
      throw CannotWrite(fmt::format("{}: another process works on task {}", plan.mesh.folder, task));
    case TaskEnd::kDone:
    case TaskEnd::kDoneBefore:
      break;
  }
}

// Works on all tasks of a stage that nobody else works on. Returns how many.
std::uint64_t work_on_stage(const PlannedMesh& plan, const TaskList& tasks, std::size_t stage,
                            const RunControl& control) {
  std::uint64_t done = 0;
  const std::uint64_t first = tasks.first_of(stage);
  for (std::uint64_t task = first; task < first + tasks.stages[stage]; ++task) {
    if (!is_done(plan.mesh, task) && do_task(plan.mesh, task, control) == TaskEnd::kDone) ++done;
  }
  return done;
}

std::uint64_t count_done(const PlannedMesh& plan, const TaskList& tasks, std::size_t stage) {
  std::uint64_t done = 0;
  const std::uint64_t first = tasks.first_of(stage);
  for (std::uint64_t task = first; task < first + tasks.stages[stage]; ++task)
    done += is_done(plan.mesh, task) ? 1U : 0U;
  return done;
}

// Works on the stages, one after the other. Throws Interrupted.
void work_on_stages(const PlannedMesh& plan, const TaskList& tasks, const RunControl& control, bool quiet) {
  for (std::size_t stage = 0; stage < tasks.stages.size(); ++stage) {
    std::uint64_t done = 0;
    while (count_done(plan, tasks, stage) < tasks.stages[stage]) {
      const std::uint64_t more = work_on_stage(plan, tasks, stage, control);
      done += more;
      if (control.stop->load()) throw Interrupted("interrupted between two tasks");
      if (more == 0) std::this_thread::sleep_for(kPause);
    }
    if (!quiet)
      print_note(fmt::format("stage {}: {} of {} tasks here", stage, grouped(done), grouped(tasks.stages[stage])));
  }
}

void work_on_all(const PlannedMesh& plan, const TaskList& tasks, const RunControl& control, bool quiet) {
  try {
    work_on_stages(plan, tasks, control, quiet);
  } catch (const Interrupted&) {
    throw Interrupted(fmt::format(
        "interrupted: tasks that are done stay done, and isoweave work {} goes on with the others", plan.mesh.folder));
  }
  if (!quiet) print_note(fmt::format("all tasks are done: isoweave collect {} -o MESH", plan.mesh.folder));
}

void run_work(const WorkArguments& arguments) {
  RunOptions run;
  run.threads = arguments.threads;
  RunControl control = run_control(run);
  control.stop = borrow(stop_on_signal());
  const PlannedMesh plan = read_plan(arguments.folder);
  const TaskList tasks = list_tasks(plan.mesh);
  if (arguments.task.empty()) return work_on_all(plan, tasks, control, arguments.quiet);
  const std::optional<std::uint64_t> task = to_number<std::uint64_t>(arguments.task);
  if (!task || *task >= tasks.count()) {
    wrong_value("--task", fmt::format("a number below {}", tasks.count()), arguments.task);
  }
  work_on(plan, tasks, *task, control, arguments.wait);
}

void run_status(const std::string& folder, bool json) {
  const PlannedMesh plan = read_plan(folder);
  const TaskList tasks = list_tasks(plan.mesh);
  Json stages = Json::array();
  std::string text;
  for (std::size_t stage = 0; stage < tasks.stages.size(); ++stage) {
    const std::uint64_t done = count_done(plan, tasks, stage);
    stages.push_back({{"tasks", tasks.stages[stage]}, {"done", done}});
    text += fmt::format("stage {}  {} of {} tasks done\n", stage, grouped(done), grouped(tasks.stages[stage]));
  }
  json ? print_out(Json{{"stages", stages}}.dump(2) + "\n") : print_to_reader(text);
}

}  // namespace

void add_work_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("work", "Work on the tasks of a plan");
  const auto arguments = std::make_shared<WorkArguments>();
  verb->add_option("FOLDER", arguments->folder, "Folder of isoweave plan")->required();
  CLI::Option* task = verb->add_option("--task", arguments->task, "Work on this task alone, by its number from 0");
  verb->add_flag("--wait", arguments->wait, "Where another process works on that task, wait until it ends")
      ->needs(task);
  verb->add_option("--threads", arguments->threads, "Number of threads, or all")->capture_default_str();
  verb->add_flag("--quiet", arguments->quiet, "Print errors alone");
  verb->footer(kWorkExamples);
  verb->callback([arguments] { run_work(*arguments); });
}

void add_status_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("status", "Tell how many tasks of a plan are done");
  const auto folder = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  verb->add_option("FOLDER", *folder, "Folder of isoweave plan")->required();
  verb->add_flag("--json", *json, "Print JSON");
  verb->footer("\nExamples:\n  isoweave status tasks\n  isoweave status tasks --json");
  verb->callback([folder, json] { run_status(*folder, *json); });
}

}  // namespace isoweave::cli
