// The mesh that mesh and simplify write.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "isoweave/mesh.hpp"
#include "isoweave/pipeline.hpp"
#include "options/cli_app.hpp"

namespace isoweave::cli {

inline constexpr const char* kMeshEndings = ".ply, .stl, .obj, .off, .glb, .vtp, .3mf or .precomputed";

// The size and place of the mesh in its file, as given.
struct PlacingOptions {
  std::string unit, scale;  // empty: not
  bool center = false, ground = false;

  bool given() const { return moves() || !unit.empty() || !scale.empty(); }
  bool moves() const { return center || ground; }
};

struct OutputOptions {
  std::string path;
  std::string to_stdout;  // "ply" or "stl" instead of a path
  bool compress = false;
  std::uint64_t segment = 1;
  bool one_file = false;  // for all levels of detail, iso-values or labels
  PlacingOptions placing;

  bool given() const { return !path.empty() || !to_stdout.empty(); }

  // The name of the output in messages and reports.
  std::string name() const { return to_stdout.empty() ? path : "standard output"; }
};

// The format of the output. Throws CannotWrite where the ending of its name tells none.
MeshFormat output_format(const OutputOptions& output);

void add_output_options(CLI::App& verb, OutputOptions& output);

// Adds the options of the command line.
MeshFileOptions mesh_file_options(const OutputOptions& output, MeshFileOptions options);

// Opens the file. `options` are those of the mesh as it comes, before it is placed.
std::unique_ptr<MeshSink> open_output(const OutputOptions& output, const MeshFileOptions& options);

// Adds --output-unit, --scale, --center and --ground.
void add_placing_options(CLI::App& verb, PlacingOptions& placing);

// Refuses options that a mesh which is placed does not go with. several: there is more than one mesh.
void check_placing(const OutputOptions& output, bool several);

// The digest of the mesh as it is in the file, where it was placed; else that of the run.
std::uint64_t file_digest(const MeshSink& sink, std::uint64_t of_run);

// Whether the output says how large its unit is, so that coordinates without one are taken for mm. Neuroglancer's
// meshes tell that themselves.
bool states_unit(const OutputOptions& output);

// mesh_file_bytes and mesh_file_memory for an output.
std::uint64_t output_bytes(const OutputOptions& output, std::uint64_t vertices, std::uint64_t triangles,
                           const MeshFileOptions& options);
std::uint64_t output_memory(const OutputOptions& output, std::uint64_t vertices, std::uint64_t triangles,
                            const MeshFileOptions& options);

// Prints the notes that the sink has on its mesh.
void print_notes(const MeshSink& sink);

}  // namespace isoweave::cli
