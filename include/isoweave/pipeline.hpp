// The main job: volume in, simplified surface out, in one sweep.
//
// The surface is extracted slab by slab, simplified while it grows, and final triangles leave memory for the sink at
// once. The result is, bit for bit, the mesh that a sequential greedy simplifier would make from the complete
// surface, whatever the slab thickness, the number of threads and the schedule.
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

// What a run makes: the mesh of a volume, the meshes of labels, a choice of components, a mesh from a mesh.
enum class RunKind : std::uint8_t { kMesh, kLabels, kComponents, kSimplify };

// Throws std::invalid_argument, naming both, where two of the things that are asked for do not go together: one table
// for all runs, which ask it themselves. What depends on the volume is seen when the run begins.
void require_possible(RunKind kind, const MeshOptions& options, const RunControl& control);

// Meshes a volume into a sink, and finishes the sink. An iso-value outside the range of the samples gives an empty mesh
// and a warning. Throws BadInput, CannotWrite (from the source and the sink), OverMemory, DeviceError, Interrupted, and
// std::invalid_argument for options out of range (a NaN iso, a negative error); BadInput also when the volume's file
// has another size or time of change in the end than in the beginning, or when its surface is not the one that
// components were chosen in. Memory: slab plus undecided zone. With a checkpoint folder the state is saved before
// Interrupted is thrown, and before BadInput from a source that fails in the middle. Resuming gives the same mesh, for
// any threads, schedule and slab; throws BadInput when the state was saved by another version, for another volume or
// with other options. What a mesh file kept in its parts is read back when it is opened again and when it is finished:
// the digest is that of the bytes in the file, or the run fails.
MeshReport mesh_volume(SliceSource& volume, MeshSink& sink, const MeshOptions& options, const RunControl& control = {});

// The same with levels: a sink for each, in their order, and the last one for the mesh with the largest error.
MeshReport mesh_volume(SliceSource& volume, std::span<MeshSink* const> sinks, const MeshOptions& options,
                       const RunControl& control = {});

// A label of a label map, and where its mesh goes.
struct LabelSink {
  Label label;
  MeshSink* sink = nullptr;
  std::optional<Region> box{};  // that holds every sample of the label, as find_labels tells; none: the whole volume
};

struct LabelsReport {
  MeshReport total;                // sums over all labels; warnings are those of the volume
  std::vector<MeshReport> labels;  // one each, in their order; without threads, range, peak_bytes and sweep
};

// Meshes labels of a label map in one sweep, each into a sink of its own: bit for bit the mesh that mesh_volume makes
// of label_volume(label) at iso 0.5 with the same options. Every slice of the volume is read once, whatever the number
// of labels, and no label costs more than its box. A label that does not occur gives an empty mesh and a warning in its
// report. Surfaces of neighbouring labels are simplified each for itself: they do not share vertices, and may cross or
// leave gaps, within the error. iso and inside_above of the options play no part.
//
// Labels are worked on side by side, those with large boxes one after the other by all threads, so sinks of different
// labels are called at the same time. None is finished before the sweep over all of them is done.
//
// Memory: two slabs of the volume's slices and 2 more, with `smooth` 2 for each pass besides, and for each label whose
// box the sweep is in a slab and 2 slices more (4 with normals) of its box, one byte per sample, its undecided zone,
// and with `smooth` instead of a byte 4, and 24 more per pass for one slice's rows near the surface. Without
// RunControl::slab, slabs are as thick as keeps the slices of all boxes within 64 MB, one layer at least.
//
// Throws what mesh_volume throws, BadInput for a volume that label_volume refuses, and std::invalid_argument for a box
// that is not within the volume and for what takes one surface: a number of triangles, levels, components that are
// dropped, values of another volume, a device, an observer, a memory cap, checkpoints.
LabelsReport mesh_labels(SliceSource& volume, std::span<const LabelSink> labels, const MeshOptions& options,
                         const RunControl& control = {});

// Adds the report of another map of the same volume, a layer that lies on the first one.
void add_layer(LabelsReport& report, LabelsReport&& layer);

// Triangles of the full surface, without components that are not kept, in a pass over the volume that keeps nothing.
// Throws what mesh_volume throws, and std::invalid_argument for a device.
std::uint64_t count_triangles(SliceSource& volume, const SurfaceOptions& options, const RunControl& control = {});

// Which components of the volume's surface a rule keeps, for SurfaceOptions::components: a pass over the volume of its
// own, as they are known in the end only. A source can be read once: mesh_volume takes another opening of the volume.
// Of the options only `iso`, `inside_above` and `closed` count. Takes about as long as extraction, and memory
// for a slab and 20 bytes for each place where a part of the surface begins, seen along the slices. Does not depend on
// threads or slabs. Throws what mesh_volume throws, and std::invalid_argument for a device.
ComponentChoice choose_components(SliceSource& volume, const SurfaceOptions& options, const ComponentRule& rule,
                                  const RunControl& control = {});

// Beyond such an error what is left no longer has the shape of the surface: the bound for runs that are to leave a
// number of triangles and are given no error. A twentieth of the diagonal of the volume, or of the box around the mesh.
double most_shape_error(const VolumeInfo& volume);
double most_shape_error(const TriangleMesh& mesh);

// What a run will take, from a sample of the volume.
struct Forecast {
  std::uint64_t triangles_extracted = 0;
  std::uint64_t triangles = 0, vertices = 0;  // written
  std::uint64_t peak_bytes = 0;               // of the process
  std::uint64_t least_bytes = 0;              // the smallest RunControl::memory that should do
  double seconds = 0;                         // of mesh_volume on this machine, once the volume can be read fast enough
};

// Reads slices at up to 24 places, extracts what lies between and simplifies a part of that, in a small part of the
// time of the run. Components that are not kept are not known here: what is written is an upper bound then. A source
// can be read once only: this one is of no use afterwards. Where skipping slices means to decompress them, no more than
// the first half gigabyte is looked at. Deterministic but for `seconds`. Throws what mesh_volume throws.
Forecast forecast_mesh(SliceSource& volume, const MeshOptions& options, const RunControl& control = {});

// Simplifies a mesh with the same rules, a piece of its triangles after the other: beside the mesh that is given,
// memory is held for what is undecided, as with a volume, where triangles that share a vertex are near in the list, and
// else for all of it. Vertices on non-manifold or badly oriented edges, and vertices whose triangles form more than one
// fan, are locked: they stay where they are. Normals of the input are not kept, values are.
MeshReport simplify_mesh(const TriangleMesh& mesh, MeshSink& sink, const SimplifyOptions& options,
                         const RunControl& control = {});

// The same with levels, as mesh_volume.
MeshReport simplify_mesh(const TriangleMesh& mesh, std::span<MeshSink* const> sinks, const SimplifyOptions& options,
                         const RunControl& control = {});

}  // namespace isoweave
#pragma GCC visibility pop
