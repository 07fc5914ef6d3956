// The contents of a report: times, warnings, counters of the simplifier.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "extract/extractor.hpp"
#include "isoweave/pipeline.hpp"
#include "pipeline/task.hpp"
#include "simplify/simplifier.hpp"
#include "volume/row_source.hpp"
#include "volume/samples.hpp"

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

// Fills in the errors of the mesh and of its finer levels.
void report_errors(const SimplifyTask& task, MeshReport& report);

// Warns when coordinates cannot be turned into the space that is asked for.
void warn_of_space(const Task& task, MeshReport& report);

// Warns where rounding moves vertices by more than it should: the sinks have no offset, or 64 bits are too few.
void warn_of_rounding(const Task& task, MeshReport& report);

// Warns where a volume of values lies elsewhere than the volume.
void warn_of_values(const Task& task, MeshReport& report);

// Reports the range of the samples, as values, and warns of NaN.
void report_samples(const VolumeInfo& volume, const SampleRange& range, MeshReport& report);

// The range of a volume whose samples are all the same.
SampleRange range_of_constant(const SampleBytes& sample, const VolumeInfo& volume);

// Warns of a mesh without triangles, with the reason. Throws EmptySurface instead where the run must not have one.
void warn_of_nothing(const Task& task, bool allow_empty, MeshReport& report);

// The same for any reason, in one line.
void report_nothing(const std::string& reason, bool allow_empty, MeshReport& report);

// Warns of a surface that is the border of the volume and nothing else, as all samples are inside.
void warn_of_border(const Task& task, MeshReport& report);

// Begins the report of one mesh of several: what holds for it while it has no triangles.
void report_no_triangles(const SimplifyTask& task, MeshReport& mesh);

// Reports the outcome of a run to a number of triangles, and that number: `report.error`, the error that was asked for,
// becomes the largest error of a collapse. Where more triangles are left, a warning says why. Must be called when all
// else is in the report.
void report_target(const DecisionCounts& counts, const SimplifyTask& task, std::uint64_t number, MeshReport& report);

// Adds the counts of a slab.
void add_extracted(const SlabCounts& slab, MeshReport& report);

// Copies the simplifier's counters.
void report_decisions(const DecisionCounts& counts, MeshReport& report);
void report_simplifier(const Simplifier& simplifier, MeshReport& report);
void report_defects(const SurfaceDefects& defects, SurfaceReport& report);

}  // namespace isoweave
