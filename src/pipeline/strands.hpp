// One sweep for several surfaces: each slice of the volume is read once, and every strand that may need it takes it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "isoweave/pipeline.hpp"
#include "parallel/parallel.hpp"
#include "pipeline/run_identity.hpp"
#include "pipeline/strand.hpp"
#include "pipeline/task.hpp"
#include "volume/row_source.hpp"
#include "volume/samples.hpp"
#include "volume/slice_window.hpp"

namespace isoweave {

// Adds the counts and times of one mesh to those of all.
void add_to(MeshReport& total, const MeshReport& mesh);

// A strand on its way through the sweep.
struct StrandState {
  std::int64_t first = 0, end = 0;  // slices of the volume that the strand needs; none: its mesh is empty
  bool large = false;               // worth all threads
  bool done = false;
  std::unique_ptr<Strand> strand;      // from the first slab that it needs to the last one
  std::uint64_t recent_triangles = 0;  // extracted from the last slab
  std::uint64_t undecided = 0;         // triangles that it holds
  MeshReport report;
};

// The slices of the next slab.
struct NextSlices {
  std::int64_t kept = 0;  // the first slice that is held besides
  std::int64_t count = 0;
  std::int64_t ahead = 0;  // to be read while the slab is worked on
};

// The choices that differ between labels and iso-values.
class StrandGuide {
 public:
  StrandGuide() = default;
  StrandGuide(const StrandGuide&) = delete;
  StrandGuide& operator=(const StrandGuide&) = delete;
  virtual ~StrandGuide() = default;

  // Begins strand n, which takes its slices from the window.
  virtual std::unique_ptr<Strand> begin(std::size_t n, const SliceWindow& window, const Executor& executor) const = 0;

  // Chooses the next slab: at least one slice, and no more than are left after the first `done`.
  virtual NextSlices next(std::int64_t done) const = 0;
};

class StrandsSweep {
 public:
  // volume: that of the task, or a box of it. All arguments must outlive the sweep. total: gets the sums over all
  // strands.
  StrandsSweep(SliceSource& volume, const Task& task, const RunControl& control, const StrandGuide& guide,
               MeshReport& total);

  const Executor& executor() const { return executor_; }
  std::vector<StrandState>& strands() { return strands_; }
  const std::vector<StrandState>& strands() const { return strands_; }
  std::int64_t recent_layers() const { return recent_layers_; }  // of the last slab
  const SampleRange& range() const { return range_; }            // of the samples, where they are measured

  // Sweeps the whole volume. Afterwards all strands are done, and no sink is finished.
  void run();

  // Takes the whole volume for swept: each sample is this one, and no strand has a surface.
  void skip(const SampleBytes& sample);

  // Adds the reports of all strands to the total.
  void add_up();

 private:
  void start_report();
  void read_slab();
  void sweep_slab();
  void sweep(std::size_t n, const Executor& executor);
  void record_slab();
  void record(StrandState& state, SlabRecord& record) const;

  const VolumeInfo& slices_;
  const Task& task_;
  const RunControl& control_;
  const StrandGuide& guide_;
  MeshReport& total_;
  const RunIdentity identity_;
  const Executor executor_;
  SliceWindow window_;
  std::vector<StrandState> strands_;
  SampleRange range_;
  std::int64_t done_ = 0;  // slices that all strands have taken
  std::int64_t recent_layers_ = 0;
};

}  // namespace isoweave
