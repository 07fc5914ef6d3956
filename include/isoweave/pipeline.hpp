// The main job: volume in, simplified surface out, in one sweep.
//
// The surface is extracted slab by slab and simplified while it grows. Final triangles leave memory for the sink at
// once. The result is, bit for bit, the mesh that a sequential greedy simplifier would make from the complete surface,
// whatever the slab thickness, the number of threads and the schedule.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "isoweave/components.hpp"
#include "isoweave/label.hpp"
#include "isoweave/mesh.hpp"
#include "isoweave/mesh_options.hpp"
#include "isoweave/report.hpp"
#include "isoweave/run.hpp"
#include "isoweave/simplify_options.hpp"
#include "isoweave/volume.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// Meshes a volume into a sink, and finishes the sink. An iso-value outside the range of the samples gives an empty mesh
// and a warning, or EmptySurface where the control says so. An iso-value below all samples gives the border of the
// volume alone, and a warning. With a checkpoint folder the state is saved before Interrupted is thrown, and before
// BadInput from a source that fails in the middle. A mesh file kept in parts is read back when it is opened again and
// when it is finished: its digest is that of the bytes in the file, or the run fails.
// @pre The volume has not been read. No other object reads it or writes to the sink meanwhile.
// @throws BadInput, CannotWrite from the source and the sink; BadInput also when the volume's file has another size or
//   time of change in the end than in the beginning, when components were chosen in another surface, and when a resumed
//   state was saved by another version, for another volume or with other options
// @throws std::invalid_argument for options out of range (a NaN iso, a negative error), options that do not go
//   together, and components chosen with other options
// @throws OverMemory, DeviceError, Interrupted
// @cost Memory: a slab and the undecided zone. With more than one thread, the volume and the sink are called from
//   threads of their own.
// @determinism The mesh does not depend on threads, schedule, slabs, nor on being interrupted and resumed.
MeshReport mesh_volume(SliceSource& volume, MeshSink& sink, const MeshOptions& options, const RunControl& control = {});

// Meshes a volume with levels: a sink for each level, in their order, and the last sink for the mesh with the largest
// error.
MeshReport mesh_volume(SliceSource& volume, std::span<MeshSink* const> sinks, const MeshOptions& options,
                       const RunControl& control = {});

// A label of a label map, and the sink of its mesh.
struct LabelSink {
  Label label;
  MeshSink* sink = nullptr;
  std::optional<Region> box{};  // a box with every sample of the label, as find_labels gives; none: the whole volume
};

struct LabelsReport {
  MeshReport total;                // sums over all labels; warnings are those of the volume
  std::vector<MeshReport> labels;  // one each, in their order; without threads, range, peak_bytes and sweep
};

// Meshes labels of a label map in one sweep, each into a sink of its own: bit for bit the mesh that mesh_volume makes
// of label_volume(label) at iso 0.5 with the same options. Every slice of the volume is read once, whatever the number
// of labels, and no label costs more than its box. A label that does not occur gives an empty mesh and a warning in its
// report. Surfaces of neighbouring labels are simplified independently: they do not share vertices, and may cross or
// leave gaps, within the error. iso and inside_above of the options are not used; a number or a share of triangles is
// one for each label.
//
// Labels are meshed side by side, those with large boxes one after the other by all threads, so sinks of different
// labels are called at the same time. No sink is finished before the sweep over all labels is done.
// @throws BadInput for a volume that label_volume refuses, and what mesh_volume throws
// @throws std::invalid_argument for a box that is not within the volume, for one sink given twice, and for options of
//   runs with one surface: levels, components to be dropped, values of another volume, a device, an observer, a memory
//   cap, checkpoints
// @cost Memory: two slabs of the volume's slices and 2 slices more, and with `smooth` 2 for each pass besides. For each
//   label whose box the sweep is in: a slab and 2 slices more (4 with normals) of its box, one byte per sample, and its
//   undecided zone; with `smooth` 4 bytes instead of one, and 24 more per pass for one slice's rows near the surface.
//   Without RunControl::slab, slabs are as thick as keeps the slices of all boxes within 64 MB, one layer at least.
//   To a number of triangles a label takes 140 bytes for each triangle that is left, until its box ends.
// @determinism As mesh_volume.
LabelsReport mesh_labels(SliceSource& volume, std::span<const LabelSink> labels, const MeshOptions& options,
                         const RunControl& control = {});

// Adds the report of another layer of labels: another map of the same volume.
void add_layer(LabelsReport& report, LabelsReport&& layer);

// An iso-value, and the sink of its mesh.
struct IsoSink {
  double iso = 0;  // as SurfaceOptions::iso
  MeshSink* sink = nullptr;
};

struct IsoValuesReport {
  MeshReport total;                // sums over all meshes; warnings are those of the volume
  std::vector<MeshReport> meshes;  // one each, in the order of the values; without threads, peak_bytes and sweep
};

// Meshes the surfaces of several iso-values in one sweep, each into a sink of its own: bit for bit the mesh that
// mesh_volume makes with that `iso` and the same options. Every slice of the volume is read once, whatever the number
// of values. `iso` of the options is not used; a number or a share of triangles is one for each mesh. Surfaces are
// simplified independently: neighbouring ones may cross, within the error.
//
// All threads work on one surface after the other, slab by slab. No sink is finished before the sweep is done.
// @throws what mesh_volume throws
// @throws std::invalid_argument for no values, one value given twice, one sink given twice, and for options of runs
//   with one surface: levels, components to be dropped, values of another volume, a device, an observer, a memory cap,
//   checkpoints
// @cost Memory: the slices of a slab once, and for each value its part of the slab and its undecided zone; with
//   `smooth` a smoothed field for each value besides. Slabs are as thick as in the run of the fullest surface. To a
//   number of triangles a surface takes 140 bytes for each triangle that is left, until the sweep ends.
// @determinism As mesh_volume.
IsoValuesReport mesh_iso_values(SliceSource& volume, std::span<const IsoSink> surfaces, const MeshOptions& options,
                                const RunControl& control = {});

// The number of triangles of the full surface, without dropped components, from a pass over the volume that keeps
// nothing.
// @throws what mesh_volume throws, and std::invalid_argument for a device
std::uint64_t count_triangles(SliceSource& volume, const SurfaceOptions& options, const RunControl& control = {});

// Finds the components of the volume's surface that a rule keeps, for SurfaceOptions::components, in a pass over the
// volume of its own: components are known in the end only. A source can be read once, so mesh_volume needs another
// opening of the volume. Of the options only `iso`, `inside_above`, `closed` and
// `extractor` count.
// @throws what mesh_volume throws; std::invalid_argument for a device; OverMemory at 2^32 seeds
// @cost About the time of extraction, and memory for a slab and 20 bytes for each place where a part of the surface
//   begins, seen along the slices.
// @determinism Does not depend on threads or slabs.
ComponentChoice choose_components(SliceSource& volume, const SurfaceOptions& options, const ComponentRule& rule,
                                  const RunControl& control = {});

// The diagonal of the volume, or of the box around the vertices of a mesh (0 where it has none), in its unit.
double box_diagonal(const VolumeInfo& volume);
double box_diagonal(const TriangleMesh& mesh);

// The largest error that keeps the shape of a surface: the bound for runs to a number of triangles that are given no
// error. It is a twentieth of box_diagonal().
double most_shape_error(const VolumeInfo& volume);
double most_shape_error(const TriangleMesh& mesh);

// Simplifies a mesh by the same rules, one piece of its triangles after the other. Vertices on non-manifold or badly
// oriented edges, and vertices whose triangles form more than one fan, are locked: they stay where they are. Triangles
// that repeat a vertex are left out with a warning. Normals of the input are not kept, values are.
// @throws std::invalid_argument for options out of range or that do not go together, a triangle that refers to a vertex
//   that the mesh does not have, and values of another number than the vertices
// @throws OverMemory for a mesh of 2^32 triangles or more; CannotWrite from the sink; Interrupted
// @cost Memory beside the mesh: the undecided zone, where triangles that share a vertex are near in the list; else a
//   zone of the whole mesh. To a number of triangles, all of the mesh that is left is held until the number is met, and
//   a large mesh is sampled first, unless RunControl::head_start is given.
// @determinism The mesh does not depend on threads, schedule, pieces or head start.
MeshReport simplify_mesh(const TriangleMesh& mesh, MeshSink& sink, const SimplifyOptions& options,
                         const RunControl& control = {});

// Simplifies a mesh with levels: sinks as for mesh_volume.
MeshReport simplify_mesh(const TriangleMesh& mesh, std::span<MeshSink* const> sinks, const SimplifyOptions& options,
                         const RunControl& control = {});

}  // namespace isoweave
#pragma GCC visibility pop
