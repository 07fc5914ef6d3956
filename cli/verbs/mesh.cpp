// isoweave mesh: volume in, simplified surface out.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "isoweave/checkpoint_folder.hpp"
#include "options/files.hpp"
#include "options/preview.hpp"
#include "ranks.hpp"
#include "report/print.hpp"
#include "verbs/mesh_arguments.hpp"
#include "verbs/mesh_job.hpp"
#include "verbs/mesh_ranks.hpp"
#include "verbs/mesh_state.hpp"
#include "verbs/mesh_task_options.hpp"
#include "verbs/verbs.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kMeshExamples = R"(
Examples:
  isoweave mesh ct.nii.gz --iso bone -o bone.ply
  isoweave mesh foot_256x256x256_uint8.raw --iso auto --error 0.5vox -o foot.stl
  isoweave mesh brain.nii.gz --iso 40 --triangles 200k -o brain.glb
  isoweave mesh scan.raw --raw 512x512x300:int16 --spacing 0.7,0.7,1.5 \
    --iso 226 --error 0.1mm -o scan.obj
  isoweave mesh mask.nii.gz --iso 0.5 --smooth --center --ground -o print.stl
  isoweave mesh segmentation.nii.gz --labels all --smooth -o seg.ply
  isoweave mesh ct.nii.gz --iso -300,200 --one-file -o skin-and-bone.glb
  isoweave mesh huge.zarr --iso 100 --preview -o look.ply
  isoweave mesh huge.zarr --iso 100 --memory 2G --checkpoint run -o huge.ply
  isoweave mesh --resume run

Without an option of Simplification the error is 0.2vox. --threads, --schedule,
--slab and --blocks never change the result.)";

void run_mesh(MeshArguments arguments) {
  if (arguments.resume.empty()) {
    if (arguments.input.path.empty()) throw CLI::RequiredError("VOLUME");
    if (arguments.iso.empty() && arguments.labels.empty()) throw CLI::RequiredError("--iso");
    if (!arguments.output.given()) arguments.output.path = usual_output(arguments.input.path, "", ".ply");
    if (arguments.slab.empty()) arguments.slab = "auto";
    if (rank_link() != nullptr) return run_mesh_in_ranks(std::move(arguments), *rank_link());
    if (!arguments.every.empty() && arguments.checkpoint.empty()) {
      throw std::invalid_argument("--every: expected --checkpoint as well, as it says how often that saves");
    }
    if (arguments.every.empty()) arguments.every = "5min";
    // Labels are neither resampled nor averaged, as a value between two labels is no label.
    arguments.input.holds_labels = !arguments.labels.empty();
    const bool file = arguments.input.holds_labels && !generated_input(arguments.input);
    if (file && arguments.input.even_spacing.empty()) arguments.input.even_spacing = "refuse";
    return run_mesh_job(arguments, std::nullopt, nullptr);
  }
  if (rank_link() != nullptr) {
    throw std::invalid_argument("--resume: the same isoweave-mpi command goes on from its --checkpoint");
  }
  // A path that is no folder cannot be locked and holds no state.
  std::shared_ptr<const CheckpointLock> lock;
  if (std::filesystem::is_directory(arguments.resume)) lock = lock_checkpoint_folder(arguments.resume);
  const Checkpoint checkpoint = read_checkpoint(arguments.resume);
  arguments = resumed_arguments(arguments, checkpoint);
  if (!arguments.run.quiet) print_note(fmt::format("resumed at layer {} of {}", checkpoint.layer, checkpoint.layers));
  run_mesh_job(arguments, checkpoint, std::move(lock));
}

void add_label_options(CLI::App& verb, MeshArguments& arguments) {
  verb.add_option(
      "--labels", arguments.labels,
      "Labels of a label map by number or name, such as 1,2,5, or all: one surface each, in a file of its own, or all "
      "in one with --one-file");
  verb.add_option("--label-names", arguments.label_names,
                  "Names of labels for files and reports: a FreeSurfer, ITK-SNAP or BIDS table")
      ->needs("--labels");
  verb.add_option("--min-label", arguments.min_label, "Leave out labels of fewer samples (with --labels all)")
      ->needs("--labels");
}

// The options of the task, which a saved state holds.
void add_task_options(CLI::App& verb, MeshArguments& arguments) {
  add_input_options(verb, arguments.input);
  add_output_options(verb, arguments.output);
  add_placing_options(verb, arguments.output.placing);
  add_surface_options(verb, arguments);
  add_component_options(verb, arguments.components, "full surface; a volume is read twice");
  add_simplification_options(verb, arguments);
  verb.add_option("--color-by", arguments.color_by,
                  "Volume of the same size whose values the vertices get: 'quality' in PLY, 'value' in VTP");
  add_label_options(verb, arguments);
  verb.add_flag("--dry-run", arguments.dry_run, "Say what the run would take, from a sample of the volume");
  verb.add_option("--checkpoint", arguments.checkpoint,
                  "Save the state of the run in this folder; --resume continues it")
      ->excludes("--to-stdout", "--output-unit", "--scale", "--center", "--ground");
}

// The options of the way to run, which may change when a run is resumed.
void add_way_options(CLI::App& verb, MeshArguments& arguments) {
  verb.add_option("--slab", arguments.slab, "Layers per slab: a number, auto or whole; never changes the result")
      ->default_str("auto");
  verb.add_option(
          "--blocks", arguments.blocks,
          "Cells along each side of the blocks in which the volume is taken; auto: blocks where slabs do not fit "
          "into --memory; or off. Never changes the result")
      ->default_str("auto");
  verb.add_option("--memory", arguments.memory, "Cap on the memory of the process, such as 800M or 2G");
  verb.add_option("--every", arguments.every, "How often --checkpoint saves: 16layers, 90s, 5min, 2h")
      ->default_str("5min");
  add_index_option(verb, arguments.index);
  add_run_options(verb, arguments.run);
  add_page_options(verb, arguments.page);
  add_watch_option(verb, arguments.watch);
}

// Excludes what only the command line knows of and labels do not have. The library refuses the rest: see
// require_possible.
void exclude_from_labels(CLI::App& verb) {
  verb.get_option("--labels")
      ->excludes("--iso", "--inside", "--to-stdout", "--dry-run", "--every", "--html", "--page-triangles");
}

// Excludes what only the command line knows of and a preview does not have, beside what any preview excludes.
void exclude_from_preview(CLI::App& verb) {
  verb.get_option("--preview")->excludes("--labels", "--normals", "--dry-run", "--blocks");
}

}  // namespace

void add_mesh_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("mesh", "Turn a volume into a simplified surface");
  const auto arguments = std::make_shared<MeshArguments>();
  add_task_options(*verb, *arguments);
  const std::vector<CLI::Option*> task = verb->get_options();
  add_way_options(*verb, *arguments);
  exclude_from_labels(*verb);
  add_preview_option(*verb, arguments->preview);
  exclude_from_preview(*verb);
  CLI::Option* resume =
      verb->add_option("--resume", arguments->resume, "Continue the run whose state is in this folder");
  resume->excludes("--preview");
  for (CLI::Option* option : task) {
    if (option != verb->get_help_ptr()) resume->excludes(option);
  }
  verb->footer(kMeshExamples);
  verb->callback([arguments, verb] {
    arguments->numbered = verb->count("--segment") > 0;
    run_mesh(*arguments);
  });
}

}  // namespace isoweave::cli
