// The task of a run: everything that its result depends on, resolved and checked once, before anything is read. Lengths
// are in the unit of the volume or mesh, costs in units of a0, iso-values those of samples as they are stored.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "extract/cube_rules.hpp"
#include "isoweave/pipeline.hpp"
#include "isoweave/possible_runs.hpp"
#include "simplify/simplifier.hpp"
#include "simplify/triangle_goal.hpp"
#include "volume/row_source.hpp"

namespace isoweave {

// How a surface is simplified.
struct SimplifyTask {
  double side = 1;                   // the root of a0, in which Length::voxels counts
  std::string unit;                  // of lengths; may be empty
  double error = 0;                  // root of the largest cost of a collapse
  std::vector<double> level_errors;  // of finer meshes, ascending, below `error`
  TriangleGoal goal;                 // to stop at
  bool needed = true;                // whether the surface goes through the simplifier at all
  ZoneOptions zone;
  std::vector<CostBits> level_costs;
  bool normals = false, values = false;  // carried by vertices, and saved with them
};

// The facts about a surface that the simplifier needs, beside the options.
struct SurfaceMeasure {
  double a0 = 1;  // a mean face, length squared
  double side = 1;
  VertexNumbering numbering{};
  Vec3 cell{};     // lengths of a box that holds a few triangles
  Vec3 largest{};  // lengths of a box that no triangle exceeds
  std::string unit;
};

// The number of triangles, or the share of all, at which a run is to stop. Throws std::invalid_argument for a share
// that is none, and for both.
TriangleGoal goal_of(const SimplifyOptions& options);

// Throws std::invalid_argument for an error or a distance that is negative or no number, for an infinite error where no
// number of triangles stops the run, for levels that do not ascend up to the error, for levels beside a number, and
// what goal_of() throws.
SimplifyTask resolve_simplification(const SimplifyOptions& options, const SurfaceMeasure& measure);

// The mesh of a volume.
struct Task {
  VolumeInfo volume;
  SurfaceOptions surface;
  AttributeOptions attributes;
  OutputSpace space = OutputSpace::kAsVolume;
  std::array<double, 3> offset{0, 0, 0};  // of the output
  IsoRule rule;
  SimplifyTask simplify;
  bool measured = true;  // as RunControl::measure

  bool has_normals() const { return attributes.normals != Normals::kAbsent; }
};

// Resolves the task of a run. Throws std::invalid_argument for options out of range and for options that do not go
// together, and BadInput for a volume with more samples than can be numbered and for a volume of values of another
// size.
Task resolve(const VolumeInfo& volume, const MeshOptions& options, const RunControl& control,
             const std::array<double, 3>& offset = {0, 0, 0}, RunKind kind = RunKind::kMesh);

// Throws BadInput when a volume has more samples than an extractor can number.
const VolumeInfo& checked_volume(const VolumeInfo& volume, ExtractorKind extractor);

// The surface in stored sample units; a negative slope turns inside and outside around. Throws std::invalid_argument
// for an iso-value that is not finite.
IsoRule stored_rule(const VolumeInfo& volume, const SurfaceOptions& options);

// The volume without the parts that an index shows to be missed by the surface; null without an index. The volume must
// outlive it.
class IndexedSource;
std::unique_ptr<IndexedSource> indexed(SliceSource& volume, std::shared_ptr<const VolumeIndex> index,
                                       const SurfaceOptions& surface, bool has_normals);

// Whether a sample of that type lies inside.
bool is_inside(const SampleBytes& sample, SampleType type, const IsoRule& rule);

// The error of a run, in the unit of the surface. `side`: that of a voxel.
double error_of(const SimplifyOptions& options, double side);

// The cost, in units of a0, above which edges are retired. to_number: whether a number of triangles may stop the run
// before.
CostBits retire_cost(double error, double a0, bool to_number = false);

// Whether a run to a number of triangles may sweep the volume twice.
bool can_repeat(const SliceSource& volume, const MeshOptions& options, const RunControl& control);

// RunControl::head_start as a cost, in units of a0. Throws std::invalid_argument for one that is negative or no number.
CostBits head_start_cost(double error, double a0);
CostBits head_start_cost(double error, const VolumeInfo& volume);

// A head start whose cost is not above one that is known: the largest such error, or nearly that.
double head_start_within(CostBits cost, const VolumeInfo& volume);

// Throws std::invalid_argument where a mesh has no sink, or one sink would get two meshes.
void require_different(std::span<MeshSink* const> sinks);

// Throws std::invalid_argument unless there is a sink for each level and one more, all different.
void check_sinks(std::span<MeshSink* const> sinks, std::size_t levels);

// The offset of all sinks. Throws std::invalid_argument where they differ.
std::array<double, 3> common_offset(std::span<MeshSink* const> sinks);

}  // namespace isoweave
