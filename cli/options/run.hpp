// The way that mesh and simplify carry out a run. generate has its progress in common with them.
#pragma once

#include <string>

#include "isoweave/run.hpp"
#include "options/cli_app.hpp"
#include "report/progress.hpp"

namespace isoweave::cli {

// The way a run is carried out, and its output.
struct RunOptions {
  std::string threads = "all", device = "auto", schedule = "auto";
  std::string report;
  std::string progress = "auto";
  bool quiet = false, allow_empty = false, no_clobber = false;
};

void add_run_options(CLI::App& verb, RunOptions& run);

// The part of RunControl that options decide. Throws DeviceError when the device asked for is not there.
RunControl run_control(const RunOptions& run);
ProgressMode progress_mode(const std::string& progress, bool quiet);

}  // namespace isoweave::cli
