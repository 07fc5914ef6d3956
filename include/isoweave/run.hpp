// Where and how a run computes, its messages meanwhile, and how it is stopped and resumed. Nothing here changes the
// result.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "isoweave/index.hpp"
#include "isoweave/mesh.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// A pointer, for the options of a run, to an object that the caller owns.
// @pre The object must outlive the run.
template <class T>
std::shared_ptr<T> borrow(T& owned) {
  return {std::shared_ptr<T>(), &owned};
}

// The order in which edges are decided.
//   automatic  local
//   queue      one priority queue in one thread: the sequential reference
//   local      workers follow chains of keys to local minima: the fastest on a CPU, also with one thread
//   rounds     all local minima at a time, in passes over lists: the shape of a device's schedule
enum class Schedule : std::uint8_t { kAutomatic, kQueue, kLocal, kRounds };

// The processor on which a run extracts and simplifies.
//   automatic  processors, until a device has been measured to be worth its start
//   cuda       a CUDA device; slabs and the undecided zone live in its memory. mesh_volume only
enum class Device : std::uint8_t { kAutomatic, kCpu, kCuda };

// The progress of a run.
struct Progress {
  std::int64_t layer = 0;    // done
  std::int64_t layers = 0;   // in all
  std::uint64_t voxels = 0;  // read so far
  std::uint64_t live_triangles = 0;
  std::uint64_t final_triangles = 0;
  std::uint64_t bytes = 0;  // held by the slab and the undecided zone
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

// Looks at the surface while it is swept. Its members are called in the thread that called mesh_volume, between two
// slabs. Spans are valid during the call only. An observer changes nothing but the time of the run and 5 MB of memory.
// An exception from it ends the run, as one from the sink does.
class SweepObserver {
 public:
  using Visitor = std::function<void(std::span<const TriangleCorners>)>;

  virtual ~SweepObserver() = default;

  // Takes triangles that have become final, in the order of the output, in blocks. Each triangle of the mesh comes
  // once, except triangles that were written before the run was resumed.
  virtual void add_final(std::span<const TriangleCorners> triangles) = 0;

  // Called after each slab. visit_undecided(visitor) hands over the triangles that are held and not final, in blocks
  // and in no promised order. It is a pass over the zone, which the observer may ask for or not. Where nothing is
  // simplified nothing is undecided.
  virtual void end_slab(const Progress& progress, const SlabRecord& slab,
                        const std::function<void(const Visitor&)>& visit_undecided) = 0;
};

// Locks a folder of saved states against all other processes and runs, by the file `lock` in it. The system releases
// the lock however the process ends. It must be held from before the state is read, and before sinks are opened in the
// folder, until the run is over.
// @throws CannotWrite when another run holds the lock, with the number of its process; when there is no such folder;
//   and where files cannot be locked
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

// How the state of a run is saved, so that the run can be resumed after the process has ended in any way.
struct CheckpointOptions {
  std::string folder;  // an existing one; empty: nothing is saved. A finished run leaves no state in it
  std::shared_ptr<const CheckpointLock> lock{};  // of that folder; null: the run takes one for itself
  std::int64_t layers = 0;                       // save after at least so many layers; 0: by time
  double seconds = 300;                          // save after at least so long
  std::string note;                              // comes back with the state: data that the caller needs to resume
};

// A saved state.
struct Checkpoint {
  std::string path;  // of its file
  std::string note;
  std::vector<std::string> marks;  // of the sinks
  std::int64_t layer = 0, layers = 0;
};

// The newest whole state in a folder.
// @throws BadInput when there is none
Checkpoint read_checkpoint(const std::string& folder);

struct RunControl {
  int threads = 0;  // 0: one per processor; at most 4096
  Schedule schedule = Schedule::kAutomatic;
  Device device = Device::kAutomatic;
  std::int64_t slab = 0;    // layers of a volume taken in at a time; 0: chosen from the size of a slice
  std::uint64_t piece = 0;  // triangles of a mesh taken in at a time; 0: chosen. Not where distances are bounded
  std::shared_ptr<const std::atomic<bool>> stop{};  // set it, from a signal handler say: the run throws Interrupted
  std::function<void(const Progress&)> progress{};  // called after every slab, in the calling thread
  std::shared_ptr<SweepObserver> observer{};        // mesh_volume only, and not on a device
  // mesh_volume only: bytes that the process should stay below; 0: no cap. Slabs and read-ahead are chosen for it,
  // unless a slab is named.
  // @throws OverMemory from the run when not even one layer more fits
  std::uint64_t memory = 0;
  std::uint64_t memory_elsewhere = 0;  // the part of them that sinks and observers will hold
  CheckpointOptions checkpoint{};      // mesh_volume only. The sink must be able to give marks
  // mesh_volume only: the state to resume, with the same volume and options and a sink opened at its mark.
  std::optional<Checkpoint> resume{};
  // The index of the volume (read_index, build_index): parts that the surface misses are not read, and min, max and nan
  // of the report come from the index. Null: everything is read. Not for labels. A volume that is held in memory is not
  // read anyway.
  // @throws std::invalid_argument from the run for the index of a volume of another size or type
  std::shared_ptr<const VolumeIndex> index{};
  // mesh_volume to a number of triangles only: opens the volume once more. With it such a run takes little longer than
  // one to the error that leaves as many: it decides from the beginning up to `head_start`. Where that leaves no more
  // triangles than the number, nothing has been handed to the sinks yet, the volume is swept once more, and progress
  // begins again. A volume that is held in memory needs no opening. Null: the volume can be read once only. A resumed
  // run needs it where the run before it had it.
  std::function<std::unique_ptr<SliceSource>()> reopen{};
  // An error, in the unit of the volume or mesh, that is expected to leave clearly more triangles than the number
  // (Forecast::head_start); 0: no such error is known. Without a value a run without a cap on memory makes a forecast
  // of its own, where the volume or mesh is large. Whatever the value is, the result is the same.
  // @throws std::invalid_argument from the run for one that is negative or not finite
  std::optional<double> head_start{};
  // mesh_volume to a number of triangles only: sweeps the volume once to count how many triangles each error leaves,
  // and once more for the mesh. That takes about twice the time, and the memory of a run to the error that leaves as
  // many, where one sweep holds all triangles until the number is met. The result is the same. Where no head start is
  // given, a run with a cap on memory counts first if the cap is too small for one sweep. Has no effect on a volume
  // that can be read once only.
  bool count_first = false;
  // Whether to find the digest, the components, non-manifold edges and vertices, and the range of the samples. Without
  // it these stay empty in the report.
  bool measure = true;
  // Whether a mesh without triangles is a result, with a warning. False for programs that would replace a good mesh by
  // it.
  // @throws EmptySurface from the run, before a sink is finished; no state is left in a checkpoint folder
  bool allow_empty = true;
};

}  // namespace isoweave
#pragma GCC visibility pop
