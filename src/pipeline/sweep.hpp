// What the sweeps over volumes and over meshes share: clock, memory, error, checks of options.
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "extract/cube_rules.hpp"
#include "isoweave/pipeline.hpp"
#include "pipeline/memory_model.hpp"
#include "simplify/count_target.hpp"
#include "simplify/simplifier.hpp"
#include "volume/row_source.hpp"

namespace isoweave {

// Adds the time since the last lap to one of the report's stages.
class Stopwatch {
 public:
  void lap(double& stage) {
    const auto now = std::chrono::steady_clock::now();
    stage += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

// Cube root by Newton's method: additions, multiplications and divisions only, so equal on every machine.
double cube_root(double x);

// Mean side of a voxel.
double mean_voxel(const Geometry& geometry);

// A length of the options in the volume's unit.
double length_in(const VolumeInfo& volume, const Length& length);

// Throws BadInput when a volume has more samples than can be numbered.
const VolumeInfo& checked_volume(const VolumeInfo& volume);

// The surface in stored sample units; a negative slope turns inside and outside around. Throws std::invalid_argument
// for an iso-value that is not finite.
IsoRule stored_rule(const VolumeInfo& volume, const MeshOptions& options);

// Whether a sample of that type lies inside.
bool is_inside(const SampleBytes& sample, SampleType type, const IsoRule& rule);

// The cost, in units of a0, above which edges are retired. Throws std::invalid_argument for a negative error or NaN,
// and for an infinite one where no number of triangles stops the run.
CostBits retire_cost(double error, double a0, std::uint64_t triangles = 0);

// Whether the surface goes through the simplifier. An open volume of one sample along an axis has crossings and no
// triangles, which only the simplifier can stand.
bool simplifies(const VolumeInfo& volume, const MeshOptions& options);

// What the simplifier has to know of a volume and of the error asked for.
ZoneOptions zone_options(const VolumeInfo& volume, const MeshOptions& options);

// A warning when coordinates cannot be turned into the space that is asked for.
void warn_of_space(const VolumeInfo& volume, const MeshOptions& options, MeshReport& report);

// Where rounding moves vertices by more than it should: the sinks have no offset, or 64 bits are too few.
void warn_of_rounding(const VolumeInfo& volume, const MeshOptions& options, const std::array<double, 3>& offset,
                      MeshReport& report);

// That of all sinks. Throws std::invalid_argument where they have several.
std::array<double, 3> common_offset(std::span<MeshSink* const> sinks);

void check_stop(const RunControl& control);

// Bytes that a run holds for a vertex beside its place.
VertexExtras vertex_extras(const MeshOptions& options);

// The outcome of a run to `asked` triangles: `report.error`, which is the error that was asked for, becomes the largest
// of a collapse, and where more triangles are left a warning says why. `side` is the root of a0. To be called when all
// else is in the report. The warning gives lengths in `unit`, if it has a name.
void report_target(const Simplifier& simplifier, std::uint64_t asked, double side, std::string_view unit,
                   MeshReport& report);

// Copies the simplifier's counters.
void report_simplifier(const Simplifier& simplifier, MeshReport& report);
void report_defects(const SurfaceDefects& defects, SurfaceReport& report);

// The distance that is guaranteed, as a length; 0: none. Throws std::invalid_argument for a negative or infinite one.
double most_distance(const Length& length, double voxel);

// The errors of finer levels as lengths. Throws std::invalid_argument when they do not ascend up to `error`, or beside
// a number of triangles.
std::vector<double> level_errors(std::span<const Length> levels, double error, double voxel, std::uint64_t triangles);

// Their costs, in units of a0.
std::vector<CostBits> level_costs(std::span<const double> errors, double a0);

// Throws BadInput: the surface is not the one that components were chosen in.
[[noreturn]] void refuse_components(const std::string& path);

// Throws std::invalid_argument where a mesh has no sink, or one sink would get two meshes.
void require_different(std::span<MeshSink* const> sinks);

// Throws std::invalid_argument unless there is a sink for each level and one more, all different.
void check_sinks(std::span<MeshSink* const> sinks, std::size_t levels);

}  // namespace isoweave
