#include "options/run.hpp"

#include <CLI/CLI.hpp>

#include "options/files.hpp"
#include "options/values.hpp"

namespace isoweave::cli {

void add_run_options(CLI::App& verb, RunOptions& run) {
  verb.add_option("--threads", run.threads, "Threads, or all; never changes the result")->capture_default_str();
  verb.add_option("--device", run.device, "auto, cpu or cuda")->capture_default_str();
  verb.add_option("--schedule", run.schedule,
                  "auto, queue (one thread, the reference), local or rounds; never changes the result")
      ->capture_default_str();
  verb.add_option("--report", run.report, "Write what was done and measured to this JSON file");
  verb.add_option("--progress", run.progress, "auto (a bar on a terminal), always or never")->capture_default_str();
  verb.add_flag("--allow-empty", run.allow_empty, "Write a mesh without triangles too, instead of exit code 3");
  add_clobber_option(verb, run.no_clobber);
  verb.add_flag("--quiet", run.quiet, "Say nothing but errors");
}

RunControl run_control(const RunOptions& run) {
  RunControl control;
  control.threads = parse_threads(run.threads);
  control.schedule = parse_choice<Schedule>("--schedule", run.schedule,
                                            {{"auto", Schedule::kAutomatic},
                                             {"queue", Schedule::kQueue},
                                             {"local", Schedule::kLocal},
                                             {"rounds", Schedule::kRounds}});
  control.device = parse_choice<Device>("--device", run.device,
                                        {{"auto", Device::kAutomatic}, {"cpu", Device::kCpu}, {"cuda", Device::kCuda}});
  control.allow_empty = run.allow_empty;
  return control;
}

ProgressMode progress_mode(const std::string& progress, bool quiet) {
  const auto mode = parse_choice<ProgressMode>(
      "--progress", progress,
      {{"auto", ProgressMode::kAuto}, {"always", ProgressMode::kAlways}, {"never", ProgressMode::kNever}});
  return quiet ? ProgressMode::kNever : mode;
}

}  // namespace isoweave::cli
