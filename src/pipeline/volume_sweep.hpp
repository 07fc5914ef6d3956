// The loop over a volume, for any extractor and back end.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "pipeline/loop.hpp"
#include "pipeline/slab_planner.hpp"
#include "pipeline/surface_field.hpp"
#include "pipeline/task.hpp"
#include "pipeline/volume_pieces.hpp"
#include "volume/indexed_source.hpp"

namespace isoweave {

class VolumeSweep {
 public:
  // All arguments must outlive the sweep.
  VolumeSweep(SliceSource& source, const Task& task, const RunControl& control, MeshReport& report);

  const Executor& executor() const { return executor_; }
  const SurfaceField& field() const { return field_; }

  // The task's extractor over the field.
  std::unique_ptr<Extractor> make_extractor() const;

  // Begins the loop with an extractor, stages and a back end, which may be null. All of them must outlive the sweep.
  // Must be called once.
  void begin(Extractor& extractor, std::vector<PieceStage*> stages, BackEnd* back_end);

  // Begins to read from the layer where the extractor is.
  void open() { pieces_->open(); }

  // Whether no slab is left that could have a surface.
  bool complete() const { return all_outside_ || loop_->complete(); }

  // Takes the next slab in, and reports it to the caller.
  void step();

  Loop& loop() { return *loop_; }
  const Loop& loop() const { return *loop_; }
  VolumePieces& pieces() { return *pieces_; }
  std::int64_t layers() const { return layers_; }
  std::int64_t layers_done() const { return layers_ - extractor_->layers_left(); }

  // Completes the report.
  void finish();

 private:
  void find_constant();
  void tell(const SlabRecord& record);

  SliceSource& source() { return indexed_ ? *indexed_ : source_; }

  SliceSource& source_;
  std::unique_ptr<IndexedSource> indexed_;  // the source where the run has an index
  const Task& task_;
  const RunControl& control_;
  MeshReport& report_;
  const std::uint64_t reader_bytes_;
  const Executor executor_;
  SurfaceField field_;
  Extractor* extractor_ = nullptr;
  std::optional<SlabPlanner> planner_;
  std::optional<VolumePieces> pieces_;
  std::optional<Loop> loop_;
  std::int64_t layers_ = 0;
  bool all_outside_ = false;  // known without reading a sample
};

}  // namespace isoweave
