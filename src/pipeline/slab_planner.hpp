// How many layers of a volume a slab takes in: the choice changes memory and speed, never the result.
#pragma once

#include <cstdint>
#include <string>

#include "extract/extractor.hpp"
#include "pipeline/memory_model.hpp"
#include "pipeline/piece_source.hpp"
#include "pipeline/slab_plan.hpp"
#include "pipeline/task.hpp"

namespace isoweave {

// The plan of a slab: its layers, the slices to be read ahead, and the most vertices that it may hold.
struct SlabPlan {
  std::int64_t layers = 0;
  std::int64_t ahead = 0;
  std::uint64_t most_vertices = 0;
};

class SlabPlanner {
 public:
  // field: the field that is extracted. reader_bytes: the most that the source may hold. All arguments but the control
  // must outlive the planner.
  SlabPlanner(const Task& task, const RunControl& control, const VolumeInfo& field, const Extractor& extractor,
              int threads, std::uint64_t reader_bytes);

  // The plan of the next slab, beside what is held and a ring with room for `ring` slices. Throws OverMemory when there
  // is no room for one layer.
  SlabPlan next(const Held& held, std::int64_t ring) const;

  // Notes a slab that has been extracted: the next one is expected to be like it.
  void note_extracted(const SlabCounts& slab);

  // Notes how much memory the zone took with a slab.
  void weigh_zone(const SlabRecord& record, const Held& held);

  // The counts of the last slab: written to a state, and read from it. Throws BadInput.
  void serialize(StateWriter& state) const;
  void serialize(StateReader& state);

 private:
  double per_layer() const;
  MemoryModel memory_model(const Held& held, double heavier) const;
  void fit_into_cap(SlabPlan& plan, const Held& held, double ring) const;
  bool is_too_thick(const SlabPlan& plan) const;
  double room(const MemoryModel& model, double part, const SlabPlan& plan, const Held& held, double ring) const;
  [[noreturn]] void refuse_layer(const MemoryModel& model, const Held& held, double ring) const;

  const Task& task_;
  const VolumeInfo& field_;
  const Extractor& extractor_;
  const int threads_;
  const bool on_device_;
  const std::int64_t asked_;  // layers; 0: none are
  const std::uint64_t cap_;   // bytes; 0: none
  const std::uint64_t elsewhere_;
  const std::uint64_t resident_;
  const std::uint64_t reader_;
  const std::string folder_;  // of states; empty: none are saved
  const std::int64_t layers_;
  double heavier_ = 1;           // MemoryModel's
  std::uint64_t most_held_ = 0;  // triangles
  std::int64_t recent_layers_ = 0;
  std::uint64_t recent_triangles_ = 0;
};

}  // namespace isoweave
