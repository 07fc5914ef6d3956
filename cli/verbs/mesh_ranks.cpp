#include "verbs/mesh_ranks.hpp"

#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "isoweave/error.hpp"
#include "options/files.hpp"
#include "options/levels.hpp"
#include "options/values.hpp"
#include "ranks.hpp"
#include "report/evidence.hpp"
#include "report/print.hpp"
#include "report/report.hpp"
#include "signals.hpp"
#include "verbs/mesh_blocks.hpp"
#include "verbs/mesh_isos.hpp"
#include "verbs/mesh_options.hpp"
#include "verbs/mesh_possible.hpp"
#include "verbs/mesh_report.hpp"

namespace isoweave::cli {
namespace {

void refuse(bool given, const char* option) {
  if (given) throw std::invalid_argument(fmt::format("isoweave-mpi: expected a run without {}", option));
}

// Refuses what ranks do not have beside what the library refuses them.
void check(const MeshArguments& arguments, const MeshOptions& options, const RunControl& control) {
  refuse(!arguments.labels.empty(), "--labels");
  refuse(has_several_isos(arguments), "several iso-values");
  refuse(arguments.dry_run, "--dry-run, which foresees slabs");
  refuse(!arguments.page.path.empty(), "--html: isoweave view shows its mesh");
  refuse(!arguments.every.empty(), "--every: each block is saved when it is done");
  refuse(arguments.blocks == "off", "--blocks off, as ranks take blocks");
  if (is_read_once(arguments.input.path)) {
    throw std::invalid_argument("isoweave-mpi: expected a volume that every rank can read, found a pipe");
  }
  check_possible(arguments, options, control, std::nullopt);
}

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder)) throw CannotWrite(folder + ": cannot be made: " + error.message());
}

class RanksJob {
 public:
  // Makes everything ready: what fails, fails here, before any rank works.
  RanksJob(const MeshArguments& arguments, RankLink& link)
      : arguments_(arguments),
        link_(link),
        outputs_(level_outputs(arguments.output, arguments.stop)),
        options_(mesh_options(arguments)),
        control_(run_control(arguments.run)) {
    if (!arguments.memory.empty()) control_.memory = parse_bytes("--memory", arguments.memory);
    set_number(arguments.stop, options_);
    check(arguments, options_, control_);
    for (const OutputOptions& output : outputs_) {
      check_different({arguments.input.path, output.path, arguments.run.report});
      if (speaks()) check_absent(arguments.run.no_clobber, {output.path, arguments.run.report});
    }
    open();
    set_ranks();
    if (!speaks()) return;
    evidence_.emplace(arguments.run, arguments.page);
    const std::vector<StopOptions> stops = stop_levels(arguments.stop);
    sinks_.emplace(outputs_,
                   [&](std::size_t level) { return file_options(arguments_, stops[level], options_, info_); });
  }

  // Makes the mesh and writes it, as the first rank.
  void lead() {
    ProgressPrinter printer(progress_mode(arguments_.run.progress, arguments_.run.quiet));
    control_.progress = [&](const Progress& progress) { printer.show(progress); };
    MeshReport report = mesh(sinks_->pointers());
    sinks_->tell_digests(report);
    printer.finish();
    if (!ranks_.results.empty()) remove_results(ranks_.results);
    const MeshFileOptions file = file_options(arguments_, stop_levels(arguments_.stop).back(), options_, info_);
    evidence_->write(mesh_report_json(report, info_, arguments_, options_, file, std::nullopt), control_, {});
    if (!arguments_.run.quiet) print_result(report);
  }

  // Works on its share, as another rank.
  void follow() { mesh({}); }

 private:
  void open() {
    control_.stop = borrow(stop_on_signal());
    info_ = open_input(arguments_.input)->info();
    if (arguments_.iso == "auto") {
      options_.iso = automatic_iso(arguments_.input, *control_.stop).iso;
      if (!arguments_.run.quiet) print_note(fmt::format("--iso {} (Otsu's threshold)", options_.iso));
    }
    set_automatic_normals(arguments_, options_);
    set_lengths(arguments_, info_, options_);
    control_.slab = parse_slab(arguments_.slab, info_.dims[2]);
  }

  void set_ranks() {
    if (control_.memory > 0) ranks_.blocks.folder = folder_beside(arguments_.output);
    ranks_.results = arguments_.checkpoint;
    if (!ranks_.results.empty()) make_folder(ranks_.results);
    const std::optional<std::int64_t> before = block_size_of_results(ranks_.results);
    ranks_.blocks.size = asked_blocks(arguments_).value_or(before.value_or(block_size_for_ranks(info_, link_.ranks())));
  }

  MeshReport mesh(std::span<MeshSink* const> sinks) const {
    const auto open = [input = arguments_.input] { return open_input(input); };
    try {
      return mesh_in_ranks(open, sinks, options_, ranks_, link_, control_);
    } catch (const Interrupted&) {
      if (ranks_.results.empty()) throw;
      throw Interrupted("interrupted: the same command goes on with what is in " + ranks_.results);
    }
  }

  void print_result(const MeshReport& report) const {
    tell_lengths(arguments_, info_);
    print_volume_notes(info_);
    for (const std::string& warning : report.warnings) print_note("warning: " + warning);
    print_notes(sinks_->last());
    print_levels(report, outputs_);
    print_target(arguments_.stop, report, options_.error, info_.geometry.unit);
    const double voxels = static_cast<double>(info_.slice_samples()) * static_cast<double>(info_.dims[2]);
    print_summary(report, outputs_.back().name(), voxels);
  }

  const MeshArguments& arguments_;
  RankLink& link_;
  const std::vector<OutputOptions> outputs_;
  MeshOptions options_;
  RunControl control_;
  VolumeInfo info_;
  RankOptions ranks_;
  std::optional<Evidence> evidence_;  // of the first rank
  std::optional<LevelSinks> sinks_;
};

}  // namespace

void run_mesh_in_ranks(MeshArguments arguments, RankLink& link) {
  if (!speaks()) arguments.run.report.clear();
  std::optional<RanksJob> job;
  try {
    job.emplace(arguments, link);
  } catch (const std::exception& error) {
    end_ranks(link, error);
  }
  speaks() ? job->lead() : job->follow();
}

}  // namespace isoweave::cli
