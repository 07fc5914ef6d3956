#include "options/output_mesh.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <utility>

#include "isoweave/placed_sink.hpp"
#include "options/values.hpp"
#include "report/print.hpp"

namespace isoweave::cli {
namespace {

// A path that names the format, as formats are told by endings.
std::string format_path(const OutputOptions& output) {
  return output.to_stdout.empty() ? output.path : "standard output." + output.to_stdout;
}

void check(const OutputOptions& output) {
  if (output.to_stdout.empty()) return;
  parse_choice<bool>("--to-stdout", output.to_stdout, {{"ply", true}, {"stl", true}});
  if (::isatty(STDOUT_FILENO) != 0) wrong_value("--to-stdout", "a pipe or a file as standard output", "a terminal");
}

MeshPlacing parse_placing(const PlacingOptions& options, const std::string& unit) {
  MeshPlacing placing{1, options.center, options.ground};
  if (!options.unit.empty()) placing.scale = unit_ratio(unit, options.unit);
  if (options.scale.empty()) return placing;
  const double scale = parse_share("--scale", options.scale);
  if (!(scale > 0)) wrong_value("--scale", "a number above 0", options.scale);
  placing.scale *= scale;
  return placing;
}

}  // namespace

MeshFormat output_format(const OutputOptions& output) {
  check(output);
  return mesh_format(format_path(output));
}

void add_output_options(CLI::App& verb, OutputOptions& output) {
  CLI::Option* path = verb.add_option("-o,--output", output.path, std::string("Mesh to write: ") + kMeshEndings);
  verb.add_option("--to-stdout", output.to_stdout, "Write the mesh to standard output when it is done: ply or stl")
      ->excludes(path);
  verb.add_flag(
      "--compress", output.compress,
      "Pack .glb (EXT_meshopt_compression) or .precomputed (multi-resolution, sharded, Draco), with rounding");
  verb.add_flag("--one-file", output.one_file,
                "All levels of --lods in one .glb (MSFT_lod), or .precomputed with --compress; all iso-values or "
                "labels, as parts with names and colours, in one .glb or .vtp")
      ->excludes("--to-stdout");
  verb.add_option("--segment", output.segment, "Segment ID in .precomputed")->capture_default_str();
}

MeshFileOptions mesh_file_options(const OutputOptions& output, MeshFileOptions options) {
  options.compress = output.compress;
  options.segment = output.segment;
  return options;
}

std::unique_ptr<MeshSink> open_output(const OutputOptions& output, const MeshFileOptions& options) {
  check(output);
  const MeshPlacing placing = parse_placing(output.placing, options.unit);
  MeshFileOptions placed = options;
  if (!output.placing.unit.empty()) placed.unit = output.placing.unit;
  placed.offset = placed_offset(options.offset, placing);
  std::unique_ptr<MeshSink> file = output.to_stdout.empty()
                                       ? open_mesh_file(output.path, placed)
                                       : open_mesh_stream(STDOUT_FILENO, output.name(), output.to_stdout, placed);
  if (!placing.given()) return file;
  return std::make_unique<PlacedSink>(std::move(file), options.offset, placing);
}

void add_placing_options(CLI::App& verb, PlacingOptions& placing) {
  verb.add_option("--output-unit", placing.unit, "Unit of the coordinates in the file: mm, um, nm, m or in");
  verb.add_option("--scale", placing.scale, "Factor of all coordinates, such as 0.5 or 50%");
  verb.add_flag("--center", placing.center, "Put the middle of the mesh at the origin");
  verb.add_flag("--ground", placing.ground, "Put the lowest point at z = 0, as on a printer's plate");
}

void check_placing(const OutputOptions& output, bool several) {
  const PlacingOptions& placing = output.placing;
  if (!placing.given()) return;
  if (output.one_file)
    throw std::invalid_argument("--one-file does not go with --output-unit, --scale, --center and --ground");
  if (several && placing.moves()) {
    throw std::invalid_argument("--center and --ground: expected one mesh, as several would be moved apart");
  }
  parse_placing(placing, "");
}

std::uint64_t file_digest(const MeshSink& sink, std::uint64_t of_run) {
  const auto* const placed = dynamic_cast<const PlacedSink*>(&sink);
  return placed != nullptr ? placed->digest() : of_run;
}

bool states_unit(const OutputOptions& output) {
  const MeshFormat format = output_format(output);
  return !output.placing.unit.empty() || format == MeshFormat::kGlb || format == MeshFormat::k3mf;
}

std::uint64_t output_bytes(const OutputOptions& output, std::uint64_t vertices, std::uint64_t triangles,
                           const MeshFileOptions& options) {
  check(output);
  return mesh_file_bytes(format_path(output), vertices, triangles, options);
}

std::uint64_t output_memory(const OutputOptions& output, std::uint64_t vertices, std::uint64_t triangles,
                            const MeshFileOptions& options) {
  check(output);
  constexpr std::uint64_t kItemBytes = 12;  // of a vertex or triangle that waits to be placed
  const std::uint64_t waiting = output.placing.given() ? kItemBytes * (2 * vertices + triangles) : 0;
  return waiting + mesh_file_memory(format_path(output), vertices, triangles, options);
}

void print_notes(const MeshSink& sink) {
  for (const std::string& line : sink.notes()) print_note(line);
}

}  // namespace isoweave::cli
