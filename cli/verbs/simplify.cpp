// isoweave simplify: the same simplifier on a mesh that exists already.
#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "isoweave/error.hpp"
#include "isoweave/weld.hpp"
#include "options/components.hpp"
#include "options/files.hpp"
#include "options/input_mesh.hpp"
#include "options/levels.hpp"
#include "options/output_mesh.hpp"
#include "options/possible.hpp"
#include "options/preview.hpp"
#include "options/run.hpp"
#include "options/stop.hpp"
#include "options/values.hpp"
#include "report/evidence.hpp"
#include "report/print.hpp"
#include "report/report.hpp"
#include "signals.hpp"
#include "verbs/verbs.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kSimplifyExamples = R"(
Examples:
  isoweave simplify scan.stl --error 0.1mm -o smaller.ply
  isoweave simplify brain.ply --ratio 10% --quality fine -o brain.obj
  isoweave simplify city.stl --preview=2mm -o look.ply

A vox is here the square root of twice the mean triangle area.)";

struct SimplifyArguments {
  ReadMeshOptions reading;
  std::string input, quality = "normal";
  StopOptions stop;
  PreviewChoice preview;
  ComponentOptions components;
  OutputOptions output;
  RunOptions run;
  PageOptions page;
  bool weld = false;
};

Json report_json(const MeshReport& report, const SimplifyArguments& arguments, const Json& place) {
  std::string format = std::filesystem::path(arguments.input).extension().string();
  if (format.starts_with('.')) format.erase(0, 1);
  Json input = {{"path", arguments.input},
                {"format", format},
                {"triangles", report.triangles_extracted},
                {"vertices", report.vertices_extracted}};
  input.update(place);
  Json json = run_json(report, std::move(input));
  if (!report.preview) json["quality"] = arguments.quality;
  json["output"] = level_outputs(arguments.output, arguments.stop).back().name();
  return json;
}

bool keeps_values(const SimplifyArguments& arguments) {
  return holds_values(output_format(arguments.output)) && !arguments.preview.given();
}

// The comment of a level's mesh file.
std::string how_text(const SimplifyArguments& arguments, std::size_t level) {
  if (arguments.preview.given()) return preview_text(arguments.preview);
  return fmt::format("simplified, {} quality {}", stop_text(stop_levels(arguments.stop)[level], ""), arguments.quality);
}

// The options of a level's mesh file.
MeshFileOptions file_options(const SimplifyArguments& arguments, const TriangleMesh& mesh, std::size_t level) {
  MeshFileOptions file;
  file.values = !mesh.values.empty() && keeps_values(arguments);
  file.unit = mesh.unit;
  file.space = mesh.space;
  file.offset = mesh.offset;
  file.comments = {"isoweave " ISOWEAVE_VERSION,
                   how_text(arguments, level) + component_text(component_rule(arguments.components))};
  return mesh_file_options(arguments.output, std::move(file));
}

std::string dropped_text(const DroppedComponents& dropped) {
  return fmt::format("nothing is left: each of {} components is dropped", dropped.components);
}

// Reports dropped components of the input as if they had been extracted and dropped.
void add_dropped(const DroppedComponents& dropped, MeshReport& report) {
  report.components_dropped = dropped.components;
  report.triangles_dropped = dropped.triangles;
  report.triangles_extracted += dropped.triangles;
  report.vertices_extracted += dropped.vertices;
  if (dropped.components == 0 || report.triangles_dropped < report.triangles_extracted) return;
  report.warnings.push_back(dropped_text(dropped));
}

// The refusal of an empty mesh with the name of the input, which the library does not know.
MeshReport simplify_named(const SimplifyArguments& arguments, const TriangleMesh& mesh, const LevelSinks& sinks,
                          const SimplifyOptions& options, const RunControl& control, const DroppedComponents& dropped) {
  try {
    if (arguments.preview.given()) {
      return preview_mesh(mesh, *sinks.pointers().front(), preview_cell(arguments.preview, length_basis(mesh)),
                          control);
    }
    return simplify_mesh(mesh, sinks.pointers(), options, control);
  } catch (const EmptySurface& empty) {
    std::string reason = empty.what();
    if (mesh.triangles.empty() && dropped.components > 0) {
      reason = dropped_text(dropped);
    } else if (mesh.triangles.empty() && !mesh.notes.empty()) {
      reason = mesh.notes.front();  // what the file has instead
    }
    throw EmptySurface(fmt::format("{}: {}", arguments.input, reason));
  }
}

// Warnings about parts of the input that the output will not have.
std::vector<std::string> input_warnings(const SimplifyArguments& arguments, const TriangleMesh& mesh) {
  std::vector<std::string> warnings = mesh_warnings(arguments.input, mesh);
  // A preview says so itself.
  if (!mesh.values.empty() && !keeps_values(arguments) && !arguments.preview.given()) {
    warnings.push_back(arguments.input + ": the values at its vertices are not kept, which needs .ply or .vtp");
  }
  return warnings;
}

// Reports seams: a border that stays may be a seam.
void add_seams(const SimplifyArguments& arguments, const TriangleMesh& mesh, MeshReport& report) {
  if (report.open_edges == 0 || arguments.weld || report.preview) return;
  for (std::string& warning : seam_warnings(arguments.input, count_seam_edges(mesh))) {
    report.warnings.push_back(std::move(warning));
  }
}

// The contents of the page: the mesh as it is in the file, beside the given mesh.
PageContents page_contents(const std::vector<OutputOptions>& outputs, TriangleMesh full) {
  PageContents contents{read_mesh(outputs.back().path)};
  contents.finer = read_finer(outputs);
  contents.full = std::move(full);
  return contents;
}

// The options, with lengths in the unit of the mesh.
SimplifyOptions simplify_options(const SimplifyArguments& arguments, const LengthBasis& basis) {
  SimplifyOptions options;
  if (!arguments.preview.given()) options.error = stop_error(arguments.stop, "", basis);
  options.quality = parse_quality(arguments.quality);
  options.max_distance = stop_distance(arguments.stop, basis);
  options.levels = finer_levels(arguments.stop, basis);
  options.drop_specks = drops_specks(arguments.stop);
  return options;
}

// Refuses options that do not go together, before any file is looked at.
void check_possible(const SimplifyArguments& arguments, const SimplifyOptions& options, const RunControl& control) {
  MeshOptions asked;
  static_cast<SimplifyOptions&>(asked) = options;
  const bool preview = arguments.preview.given();
  if (preview) preview_cell(arguments.preview, unknown_basis());  // finds errors in it now
  const RunKind kind = preview ? RunKind::kPreview : RunKind::kSimplify;
  const char* const name = preview ? "--preview" : "simplify";
  require_possible({kind, name, asked, control, arguments.stop, arguments.components});
}

std::vector<GivenLength> given_lengths(const SimplifyArguments& arguments) {
  std::vector<GivenLength> lengths = given_lengths(arguments.stop);
  lengths.push_back(given_cell(arguments.preview));
  return lengths;
}

void run_simplify(SimplifyArguments arguments) {
  if (!arguments.output.given()) arguments.output.path = usual_output(arguments.input, "_simplified", ".ply");
  const RunOptions& run = arguments.run;
  RunControl control = run_control(run);
  const ProgressMode mode = progress_mode(run.progress, run.quiet);
  if (!arguments.stop.given() && !arguments.preview.given()) throw CLI::RequiredError("--error");
  SimplifyOptions options = simplify_options(arguments, unknown_basis());  // finds errors in them now
  check_possible(arguments, options, control);
  const ComponentRule rule = component_rule(arguments.components);
  const std::vector<OutputOptions> outputs = level_outputs(arguments.output, arguments.stop);
  for (const OutputOptions& output : outputs) {
    check_different({arguments.input, output.path, run.report, arguments.page.path});
    check_absent(run.no_clobber, {output.path, run.report, arguments.page.path});
  }
  check_page(arguments.page, arguments.output);
  check_placing(arguments.output, outputs.size() > 1);

  exit_on_signal();
  Evidence evidence(run, arguments.page);
  try_levels(outputs);
  InputMesh input = read_input_mesh(arguments.input, arguments.reading, arguments.weld);
  TriangleMesh& mesh = input.mesh;
  const std::vector<std::string> warnings = input_warnings(arguments, mesh);
  const Json place = place_json(mesh);
  const LengthBasis basis = length_basis(mesh);
  options = simplify_options(arguments, basis);
  DroppedComponents dropped;
  if (!rule.keeps_all()) dropped = keep_components(mesh, rule);
  if (std::isinf(options.error.value) && arguments.stop.error.empty())
    options.error = Length::units(most_shape_error(mesh));
  set_number(arguments.stop, options);
  control.stop = borrow(stop_on_signal());
  const LevelSinks sinks(outputs, [&](std::size_t level) { return file_options(arguments, mesh, level); });
  ProgressPrinter printer(mode);
  control.progress = [&](const Progress& progress) { printer.show(progress); };
  MeshReport report = simplify_named(arguments, mesh, sinks, options, control, dropped);
  sinks.tell_digests(report);
  report.warnings.insert(report.warnings.begin(), warnings.begin(), warnings.end());
  add_seams(arguments, mesh, report);
  add_dropped(dropped, report);
  printer.finish();
  Json json = report_json(report, arguments, place);
  if (arguments.weld) json["input"]["welded"] = input.welded;
  if (!report.levels.empty()) json["levels"] = levels_json(report, outputs);
  json["notes"] = sinks.last().notes();
  evidence.write(std::move(json), control, [&](const RunControl&) { return page_contents(outputs, std::move(mesh)); });
  if (run.quiet) return;
  tell_lengths(arguments.input, given_lengths(arguments), states_unit(arguments.output), basis);
  print_welded(arguments.input, arguments.weld, input.welded);
  for (const std::string& warning : report.warnings) print_note("warning: " + warning);
  print_notes(sinks.last());
  print_dropped(report);
  print_levels(report, outputs);
  print_target(arguments.stop, report, options.error, basis.unit);
  if (report.preview) print_preview(report, basis.unit);
  print_summary(report, outputs.back().name(), 0);
}

}  // namespace

void add_simplify_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("simplify", "Simplify a triangle mesh");
  const auto arguments = std::make_shared<SimplifyArguments>();
  verb->add_option("MESH", arguments->input, kMeshInputHelp)->required();
  add_output_options(*verb, arguments->output);
  add_placing_options(*verb, arguments->output.placing);
  add_stop_options(*verb, arguments->stop);
  add_weld_option(*verb, arguments->weld);
  add_component_options(*verb, arguments->components, "mesh as it is given");
  verb->add_option("--quality", arguments->quality, "fast, normal or fine")->capture_default_str();
  add_run_options(*verb, arguments->run);
  add_page_options(*verb, arguments->page);
  add_preview_option(*verb, arguments->preview);
  verb->footer(kSimplifyExamples);
  add_external_option(*verb, arguments->reading);
  verb->callback([arguments] { run_simplify(*arguments); });
}

}  // namespace isoweave::cli
