// Facts about volumes, meshes and runs, as JSON and as text.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "isoweave/measure.hpp"
#include "isoweave/output_file.hpp"
#include "isoweave/pipeline.hpp"
#include "isoweave/report_json.hpp"
#include "isoweave/volume.hpp"

namespace isoweave::cli {

using Json = nlohmann::ordered_json;

// The `input` part: the facts of the header. `path` is the path that the user gave.
Json volume_json(const VolumeInfo& info, const std::string& path);

// Prints the notes of a volume as warnings, and its remarks.
void print_volume_notes(const VolumeInfo& info);

// Adds min, max and nan; null where there is no value at all.
void add_range(Json& input, double min, double max, std::uint64_t nan);

// A label as a number.
Json label_json(const Label& label);

// The common part of the reports of all runs. `input` is the first part that differs between runs on volumes and on
// meshes.
Json run_json(const MeshReport& report, Json input);

// The amounts that a run with the index `path` has not read.
Json left_out_json(const LeftOutReport& left_out, const std::string& path);

struct Box {
  std::array<double, 3> low{0, 0, 0}, high{0, 0, 0};

  std::array<double, 3> size() const { return {high[0] - low[0], high[1] - low[1], high[2] - low[2]}; }
};

// The box of the vertices that triangles have.
Box box_of(const TriangleMesh& mesh);

// The place of a mesh: its unit and space, empty where they are not said, its offset and its box.
Json place_json(const TriangleMesh& mesh);

// JSON text that ends with a line feed. Names that are not UTF-8 do not stop it.
std::string json_text(const Json& json);

// Writes the report into a file that was opened before the run, so that nothing is computed in vain.
void write_report(OutputFile& file, const Json& json);

// "closed, manifold", or the properties that a surface lacks.
std::string state_text(std::uint64_t open_edges, std::uint64_t nonmanifold_edges, std::uint64_t nonmanifold_vertices);

// A line on standard error about a surface that has been written.
void print_surface(const SurfaceReport& surface, const std::string& output);

// A line about the use of the index `path`, if the run had one.
void print_left_out(const MeshReport& report, const std::string& path);

// Two lines about a run that is done: the mesh, and what it took.
void print_summary(const MeshReport& report, const std::string& output, double voxels);

}  // namespace isoweave::cli
