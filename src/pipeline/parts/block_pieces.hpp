// The pieces of the surface inside a block.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "extract/extractor.hpp"
#include "pipeline/parts/block_source.hpp"
#include "pipeline/parts/cut_sides.hpp"
#include "pipeline/slab_planner.hpp"
#include "pipeline/surface_field.hpp"
#include "pipeline/volume_pieces.hpp"

namespace isoweave {

class BlockPieces {
 public:
  // volume: opened for this block. task: of the whole volume. All other arguments must outlive the pieces.
  BlockPieces(std::unique_ptr<SliceSource> volume, const Task& task, const BlockSides& sides, const RunControl& control,
              const Executor& executor);

  bool complete() const { return pieces_->complete(); }

  // Makes the next piece, beside what is held. The vertices in planes between blocks stay incomplete.
  void next(const Held& held, SurfacePiece& piece, MeshReport& report);

  std::uint64_t bytes() const { return pieces_->bytes(); }

  // The range of the samples that are counted in this block, once it is complete.
  const SampleRange& range() const { return pieces_->range(); }

 private:
  BlockSource source_;
  Task task_;  // of the block
  std::optional<SurfaceField> field_;
  std::unique_ptr<Extractor> extractor_;
  std::optional<SlabPlanner> planner_;
  std::optional<VolumePieces> pieces_;
  CutSides sides_;
};

}  // namespace isoweave
