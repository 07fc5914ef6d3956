// Where and how a run computes, what it tells meanwhile, and how it is stopped and resumed. Nothing here changes the
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

#include "isoweave/mesh.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// A pointer for the options of a run to something that the caller owns, and keeps until the run is over.
template <class T>
std::shared_ptr<T> borrow(T& owned) {
  return {std::shared_ptr<T>(), &owned};
}

// Order in which edges are decided.
//   automatic  local
//   queue      one priority queue in one thread: the sequential reference
//   local      workers follow chains of keys to local minima: the fastest on a CPU, also with one thread
//   rounds     all local minima at a time, in passes over lists: the shape of a device's schedule
enum class Schedule : std::uint8_t { kAutomatic, kQueue, kLocal, kRounds };

// Where a run extracts and simplifies.
//   automatic  processors, until a device has been measured to be worth its start
//   cuda       a CUDA device; slabs and the undecided zone live in its memory. mesh_volume only
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
  std::string folder;  // an existing one; empty: nothing is saved. Finished runs leave no state in it
  std::shared_ptr<const CheckpointLock> lock{};  // of that folder; null: the run takes one for itself
  std::int64_t layers = 0;                       // save after at least so many layers; 0: by time
  double seconds = 300;                          // save after at least so long
  std::string note;                              // comes back with the state: what the caller needs to go on
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

struct RunControl {
  int threads = 0;  // 0: one per processor; at most 4096
  Schedule schedule = Schedule::kAutomatic;
  Device device = Device::kAutomatic;
  std::int64_t slab = 0;  // layers of a volume that are taken in at a time; 0: chosen from the size of a slice
  std::uint64_t piece =
      0;  // triangles of a mesh that are taken in at a time; 0: chosen. Not where distances are bounded
  std::shared_ptr<const std::atomic<bool>> stop{};  // set it, from a signal handler say: the run throws Interrupted
  std::function<void(const Progress&)> progress{};  // called after every slab, in the calling thread
  std::shared_ptr<SweepObserver> observer{};        // mesh_volume only, and not on a device
  // mesh_volume only: bytes that the process should stay below; 0: no cap. Slabs and read-ahead are chosen for it,
  // unless a slab is named. OverMemory is thrown when not even one layer more would fit.
  std::uint64_t memory = 0;
  std::uint64_t memory_elsewhere = 0;  // of them, what sinks and observers are going to hold
  CheckpointOptions checkpoint{};      // mesh_volume only. The sink must be able to give marks
  // mesh_volume only: go on from there, with the same volume and options and a sink opened at its mark.
  std::optional<Checkpoint> resume{};
  // Digest, components, non-manifold edges and vertices, and range of the samples: without it these stay empty in the
  // report.
  bool measure = true;
};

}  // namespace isoweave
#pragma GCC visibility pop
