#include "options/output_mesh.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>

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

}  // namespace

MeshFormat output_format(const OutputOptions& output) {
  check(output);
  return mesh_format(format_path(output));
}

void add_output_options(CLI::App& verb, OutputOptions& output) {
  CLI::Option* path = verb.add_option("-o,--output", output.path, std::string("Mesh to write: ") + kMeshEndings);
  verb.add_option("--to-stdout", output.to_stdout, "Write the mesh to standard output when it is done: ply or stl")
      ->excludes(path);
  verb.add_flag("--compress", output.compress,
                "Pack .glb (EXT_meshopt_compression) or .precomputed (multi-resolution, Draco), with rounding");
  verb.add_flag("--one-file", output.one_file,
                "All levels of --lods in one .glb (MSFT_lod), or .precomputed with --compress")
      ->excludes("--to-stdout");
  verb.add_option("--segment", output.segment, "Number of the object in .precomputed")->capture_default_str();
}

MeshFileOptions mesh_file_options(const OutputOptions& output, MeshFileOptions options) {
  options.compress = output.compress;
  options.segment = output.segment;
  return options;
}

std::unique_ptr<MeshSink> open_output(const OutputOptions& output, const MeshFileOptions& options) {
  check(output);
  if (output.to_stdout.empty()) return open_mesh_file(output.path, options);
  return open_mesh_stream(STDOUT_FILENO, output.name(), output.to_stdout, options);
}

std::uint64_t output_bytes(const OutputOptions& output, std::uint64_t vertices, std::uint64_t triangles,
                           const MeshFileOptions& options) {
  check(output);
  return mesh_file_bytes(format_path(output), vertices, triangles, options);
}

std::uint64_t output_memory(const OutputOptions& output, std::uint64_t vertices, std::uint64_t triangles,
                            const MeshFileOptions& options) {
  check(output);
  return mesh_file_memory(format_path(output), vertices, triangles, options);
}

std::string space_text(const Geometry& geometry, OutputSpace space) {
  if (space == OutputSpace::kIndex) return "index";
  if (geometry.space == Space::kUnknown) return "";  // coordinates are those of the volume, whatever was asked for
  const bool as_lps = space == OutputSpace::kLps || (space == OutputSpace::kAsVolume && geometry.space == Space::kLps);
  return as_lps ? "LPS" : "RAS";
}

void print_notes(const MeshSink& sink) {
  for (const std::string& line : sink.notes()) print_note(line);
}

}  // namespace isoweave::cli
