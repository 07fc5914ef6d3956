// isoweave index: the ranges of a volume's bricks, so that later runs read what they need.
#include "isoweave/index.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "isoweave/error.hpp"
#include "options/files.hpp"
#include "options/input_volume.hpp"
#include "report/print.hpp"
#include "signals.hpp"
#include "verbs/verbs.hpp"

namespace isoweave::cli {
namespace {

struct IndexArguments {
  InputOptions input;
  std::string output;
  bool quiet = false;
};

// Writes the index into the first of its places that can be written, the folder of the cache being made.
std::string write_in_place(const VolumeIndex& index, const VolumeInfo& volume) {
  const std::vector<std::string> places = index_places(volume);
  for (std::size_t n = 0; n + 1 < places.size(); ++n) {
    try {
      write_index(index, places[n]);
      return places[n];
    } catch (const CannotWrite&) {
      // The next place is for the folders that cannot be written.
    }
  }
  std::error_code ignored;
  std::filesystem::create_directories(std::filesystem::path(places.back()).parent_path(), ignored);
  write_index(index, places.back());
  return places.back();
}

void run_index(const IndexArguments& arguments) {
  if (arguments.input.path.empty()) throw CLI::RequiredError("VOLUME");
  if (!arguments.input.roi.empty() || !arguments.input.step.empty()) {
    throw std::invalid_argument("index: expected a whole volume, found --roi or --step");
  }
  check_different({arguments.input.path, arguments.output});
  const std::unique_ptr<SliceSource> volume = open_input(arguments.input);
  const VolumeInfo& info = volume->info();
  if (index_places(info).empty()) {
    throw BadInput(
        fmt::format("{}: expected a volume in files, which an index knows again, found none", arguments.input.path));
  }
  const std::shared_ptr<const VolumeIndex> index = build_index(*volume, &stop_on_signal());
  std::string path = arguments.output;
  if (path.empty()) {
    path = write_in_place(*index, info);
  } else {
    write_index(*index, path);
  }
  if (arguments.quiet) return;
  const IndexFacts facts = index_facts(*index);
  const std::uint64_t samples = info.slice_bytes() * static_cast<std::uint64_t>(info.dims[2]);
  print_note(fmt::format("{}: {} bricks of {} x {} x {} cells, {:.2g} % of the samples", path,
                         grouped(static_cast<std::uint64_t>(facts.bricks)), facts.brick, facts.brick, facts.brick,
                         100 * static_cast<double>(facts.bytes) / static_cast<double>(samples)));
}

}  // namespace

void add_index_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("index", "Index a volume, so that runs read less of it");
  const auto arguments = std::make_shared<IndexArguments>();
  add_input_options(*verb, arguments->input);
  verb->add_option("-o,--output", arguments->output,
                   "File of the index (default: VOLUME.minmax, or in ~/.cache/isoweave where that cannot be written)");
  verb->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  verb->callback([arguments] { run_index(*arguments); });
}

}  // namespace isoweave::cli
