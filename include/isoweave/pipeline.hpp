// The main job: volume in, simplified surface out, in one sweep.
//
// The surface is extracted slab by slab, simplified while it grows, and final triangles leave memory for the sink at
// once. The result is, bit for bit, the mesh that a sequential greedy simplifier would make from the complete
// surface, whatever the slab thickness, the number of threads and the schedule.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "isoweave/components.hpp"
#include "isoweave/measure.hpp"
#include "isoweave/mesh.hpp"
#include "isoweave/simplify_options.hpp"
#include "isoweave/volume.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// A length: in mean voxels, or in the volume's own unit.
struct Length {
  double value = 0;
  bool voxels = false;
};

// Parses "0.2vox", "0.05mm", "30um", "500nm", "0.01in" or "0.05" (the volume's own unit). Units are spelled in any way
// that volumes spell them. Their lengths are converted to `unit` ("mm" where the volume does not say). Throws
// std::invalid_argument naming the text.
Length parse_length(std::string_view text, std::string_view unit);

// Coordinates of the output: as the volume's own world, in a named convention (x and y change sign between the two), or
// index * spacing without origin and direction.
enum class OutputSpace : std::uint8_t { kAsVolume, kLps, kRas, kIndex };

// The offset with which to open a sink for a mesh of this volume (MeshFileOptions::offset, MeshInMemory). All 0 unless
// the volume lies so far from the origin that rounding to 32 bits would move vertices by more than a thousandth of the
// smallest spacing: then the place of its first sample, so that coordinates are those of the same volume at the origin.
std::array<double, 3> mesh_offset(const VolumeInfo& volume, OutputSpace space);

// Normals of the vertices: none; gradients of the samples, which merge as vertices do; or gradients that the
// simplification keeps as well: an edge collapses where the error of position and normal is least, and only as long as
// that is within the error (Hoppe, 1999), where a normal of unit length that is off by 1 counts as half a mean voxel.
enum class Normals : std::uint8_t { kAbsent, kGradient, kQuadric };

// Where a run extracts and simplifies. It never changes the result.
//   automatic  processors, until a device has been measured to be worth its start
//   cuda       a CUDA device; slabs and the undecided zone live in its memory. mesh_volume only, without a number of
//              triangles and without checkpoints
enum class Device : std::uint8_t { kAutomatic, kCpu, kCuda };

// What a run can tell while it goes on.
struct Progress {
  std::int64_t layer = 0;    // done
  std::int64_t layers = 0;   // in all
  std::uint64_t voxels = 0;  // read so far
  std::uint64_t live_triangles = 0;
  std::uint64_t final_triangles = 0;
  std::uint64_t bytes = 0;  // held by the slab and the undecided zone
};

// Holds a folder of saved states against all other processes and runs, by the file `lock` in it. The system lets go of
// it however the process ends. To be held from before the state is read, and before sinks are opened in the folder,
// until the run is over. Throws CannotWrite when somebody else holds it, with the number of the process; when there is
// no such folder; and where files cannot be locked.
class CheckpointLock {
 public:
  explicit CheckpointLock(const std::string& folder);
  ~CheckpointLock();
  CheckpointLock(CheckpointLock&& other) noexcept;
  CheckpointLock& operator=(CheckpointLock&&) = delete;

 private:
  std::string path_;
  int fd_ = -1;
};

// How the state of a run is saved, to go on with after whatever ends the process.
struct CheckpointOptions {
  std::string folder;                    // an existing one; empty: nothing is saved. Finished runs leave no state in it
  const CheckpointLock* lock = nullptr;  // of that folder, held by the caller; null: held while mesh_volume runs
  std::int64_t layers = 0;               // save after at least so many layers; 0: by time
  double seconds = 300;                  // save after at least so long
  std::string note;                      // comes back with the state: what the caller needs to go on
};

// A saved state.
struct Checkpoint {
  std::string path;  // of its file
  std::string note;
  std::vector<std::string> marks;  // of the sinks
  std::int64_t layer = 0, layers = 0;
};

// The newest state in a folder that is whole. Throws BadInput when there is none.
Checkpoint read_checkpoint(const std::string& folder);

class SweepObserver;

struct RunControl {
  int threads = 0;  // 0: one per processor; at most 4096
  Schedule schedule = Schedule::kAutomatic;
  Device device = Device::kAutomatic;
  const std::atomic<bool>* stop = nullptr;        // set it, from a signal handler say, and the run throws Interrupted
  std::function<void(const Progress&)> progress;  // called after every slab, in the calling thread
  SweepObserver* observer = nullptr;              // mesh_volume only, and not on a device
  // mesh_volume only: bytes that the process should stay below; 0: no cap. Slabs and read-ahead are chosen for it,
  // unless MeshOptions name the slab. OverMemory is thrown when not even one layer more would fit.
  std::uint64_t memory = 0;
  std::uint64_t memory_elsewhere = 0;  // of them, what sinks and observers are going to hold
  CheckpointOptions checkpoint{};      // mesh_volume only. The sink must be able to give marks
  const Checkpoint* resume =
      nullptr;  // go on from there, with the same volume and options and a sink opened at its mark
  // Digest, components, non-manifold edges and vertices, and range of the samples: without it these stay empty in the
  // report.
  bool measure = true;
};

struct MeshOptions {
  double iso = 0;            // a value: slope and intercept of the volume are accounted for
  bool inside_above = true;  // inside is value >= iso; else value <= iso. NaN is outside
  bool closed = true;        // caps at the volume's border; else the surface ends there
  // Passes of smooth_mask: the surface of a mask, a label map say, without its staircase. 0: the surface of the
  // samples. No vertex leaves its edge of the lattice; min, max and nan of the report are those of the samples.
  int smooth = 0;
  Length error{0.2, true};  // root of the largest quadric error of a collapse; 0: no simplification
  // No point of the result is farther than this from the extracted surface; 0: no such guarantee. The other way round
  // nothing is promised. Costs time, and memory for the extracted surface around what is undecided.
  Length max_distance{};
  // Stop at the first collapse that leaves no more triangles than this, if the error does not stop it before; 0: no
  // such number. The error may be infinite then, and shapes be lost where the number is out of reach, as each closed
  // component keeps 4 triangles: most_shape_error() is a bound. Between two slabs a quarter more triangles than that
  // and 50,000 are held, or as many as it takes to be sure of the result.
  std::uint64_t triangles = 0;
  Quality quality = Quality::kNormal;
  // A closed component that has shrunk to a tetrahedron goes when half its longest edge is no longer than the error.
  // Else every component stays, and topology with it.
  bool drop_specks = false;
  // Errors of finer meshes that come out of the same sweep, ascending, all below `error`; each is the mesh of a run
  // with that error. Not with a number of triangles.
  std::vector<Length> levels{};
  // The components that are kept, found by choose_components in this volume with these `iso`, `inside_above` and
  // `closed`; null: all. The result is the mesh of a surface that never had the others: errors, numbers of triangles
  // and distances refer to what is kept. Costs a second union-find over the triangles of each slab. Not on a device.
  const ComponentChoice* components = nullptr;
  std::int64_t slab = 0;  // layers per slab; 0: chosen from the size of a slice. Changes memory and speed only
  Normals normals = Normals::kAbsent;  // unit length, outwards; zero where there is no direction
  // Another volume of as many samples, whose values the vertices get: interpolated where a vertex is extracted, and
  // along the edge when it collapses. Slope and intercept are accounted for. Read beside the first one, and not owned.
  SliceSource* values = nullptr;
  OutputSpace space = OutputSpace::kAsVolume;
};

struct SlabRecord {
  std::int64_t layer = 0;                 // done after this slab
  std::uint64_t live_triangles = 0;       // when the slab was appended
  std::uint64_t undecided_triangles = 0;  // held over to the next slab
  std::uint64_t final_triangles = 0;      // written so far
  std::uint64_t bytes = 0;                // held by the slab and the zone
};

// A triangle by its corners: coordinates of the output, counter-clockwise seen from outside.
using TriangleCorners = std::array<Point, 3>;

// Looks at the surface while it is swept. Called in the thread that called mesh_volume, between two slabs; what is
// handed over is there during the call only. It changes nothing but the time of the run and 5 MB of memory. What it
// throws ends the run, as what the sink throws does.
class SweepObserver {
 public:
  using Visitor = std::function<void(std::span<const TriangleCorners>)>;

  virtual ~SweepObserver() = default;

  // Triangles that have become final, in the order of the output, in blocks. Each triangle of the mesh comes once, but
  // those that were written before the run was resumed.
  virtual void add_final(std::span<const TriangleCorners> triangles) = 0;

  // After each slab. visit_undecided(visitor) hands over what is held and not final, in blocks and in no promised
  // order: a pass over the zone, which is for the observer to ask for or not. Where nothing is simplified nothing is
  // undecided.
  virtual void end_slab(const Progress& progress, const SlabRecord& slab,
                        const std::function<void(const Visitor&)>& visit_undecided) = 0;
};

// A surface as it was written.
struct SurfaceReport {
  // In the volume's unit: as asked for; where a number of triangles was asked for, the largest of a collapse as it was
  // made, 0 if there was none.
  double error = 0;
  std::uint64_t triangles = 0, vertices = 0;
  // Non-manifold: seen around vertices that have become final. An unsimplified volume's surface has none by
  // construction and is not looked at.
  std::uint64_t open_edges = 0, nonmanifold_edges = 0, nonmanifold_vertices = 0, components = 0;
  std::int64_t euler = 0;
  std::uint64_t digest = 0;
};

// Of the run, and of the mesh with the largest error.
struct MeshReport : SurfaceReport {
  int threads = 0;
  std::int64_t slab = 0;
  Schedule schedule = Schedule::kQueue;
  Device device = Device::kCpu;
  double min = 0, max = 0;  // values read; min > max when all were NaN
  std::uint64_t nan = 0;    // samples
  std::uint64_t cells_crossed = 0, triangles_extracted = 0, vertices_extracted = 0;
  std::uint64_t collapses = 0, postponed = 0, rekeyed = 0, rounds = 0;
  std::uint64_t specks = 0;  // components dropped
  // By MeshOptions::components; their triangles are among those extracted. `specks` are others.
  std::uint64_t components_dropped = 0, triangles_dropped = 0;
  std::vector<SurfaceReport> levels;  // finer meshes, as MeshOptions::levels
  std::uint64_t locked_vertices = 0;  // simplify_mesh only: left in place, non-manifold or badly oriented
  std::int64_t resumed_at = 0;        // layers that an earlier process has done
  // Finer levels are handed to their sinks while simplifying.
  double seconds_read = 0, seconds_extract = 0, seconds_simplify = 0, seconds_write = 0, seconds_total = 0;
  std::uint64_t peak_bytes = 0;  // of the process, as the system counts it
  std::vector<SlabRecord> sweep;
  std::vector<std::string> warnings;  // one line each
};

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
// MeshOptions::slab, slabs are as thick as keeps the slices of all boxes within 64 MB, one layer at least.
//
// Throws what mesh_volume throws, BadInput for a volume that label_volume refuses, and std::invalid_argument for a box
// that is not within the volume and for what takes one surface: a number of triangles, levels, components that are
// dropped, values of another volume, a device, an observer, a memory cap, checkpoints.
LabelsReport mesh_labels(SliceSource& volume, std::span<const LabelSink> labels, const MeshOptions& options,
                         const RunControl& control = {});

// Triangles of the full surface, without components that are not kept, in a pass over the volume that keeps nothing.
// Throws what mesh_volume throws.
std::uint64_t count_triangles(SliceSource& volume, const MeshOptions& options, const RunControl& control = {});

// Which components of the volume's surface a rule keeps, for MeshOptions::components: a pass over the volume of its
// own, as they are known in the end only. A source can be read once: mesh_volume takes another opening of the volume.
// Of the options only `iso`, `inside_above`, `closed` and `slab` count. Takes about as long as extraction, and memory
// for a slab and 20 bytes for each place where a part of the surface begins, seen along the slices. Does not depend on
// threads or slabs. Throws what mesh_volume throws, and std::invalid_argument for a device.
ComponentChoice choose_components(SliceSource& volume, const MeshOptions& options, const ComponentRule& rule,
                                  const RunControl& control = {});

struct SimplifyOptions {
  Length error{0, false};  // in the mesh's unit; voxels: square roots of twice the mean triangle area
  Quality quality = Quality::kNormal;
  std::uint64_t triangles = 0;   // as in MeshOptions
  bool drop_specks = false;      // as in MeshOptions
  std::vector<Length> levels{};  // as in MeshOptions
  Length max_distance{};         // as in MeshOptions: from the mesh that is given

  // Triangles taken in at a time; 0: chosen. A matter of memory and speed, never of the result. Not heeded where a
  // distance is bounded.
  std::uint64_t piece = 0;
};

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
