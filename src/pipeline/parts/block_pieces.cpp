#include "pipeline/parts/block_pieces.hpp"

#include <algorithm>
#include <utility>

#include "extract/make_extractor.hpp"
#include "isoweave/error.hpp"
#include "volume/smoothed_mask.hpp"

namespace isoweave {
namespace {

// The samples that the surface in a block depends on. Normals look one further than its corners, smoothing further.
Region samples_around(const CellBox& cells, const Task& task) {
  const std::int64_t margin = 1 + SmoothedMask::reach(task.surface.smooth);
  Region samples;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    samples.first[axis] = std::max<std::int64_t>(cells.first[axis] - margin, 0);
    samples.end[axis] = std::min(cells.end[axis] + 1 + margin, task.volume.dims[axis]);
  }
  return samples;
}

// The samples that are counted in a block: each in one of all blocks.
Region own_samples(const BlockSides& sides, const std::array<std::int64_t, 3>& dims) {
  Region own;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool last = sides.cells.end[axis] == sides.all.end[axis];
    own.first[axis] = std::max<std::int64_t>(sides.cells.first[axis], 0);
    own.end[axis] = last ? dims[axis] : sides.cells.end[axis];
  }
  return own;
}

std::unique_ptr<SliceSource> same_volume(std::unique_ptr<SliceSource> volume, const Task& task) {
  if (volume->info().dims == task.volume.dims && volume->info().type == task.volume.type) return volume;
  throw BadInput(task.volume.path +
                 ": the volume has changed: expected the size and type that it had when the run "
                 "began, found others");
}

CellBox moved(CellBox cells, const std::array<std::int64_t, 3>& to) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells.first[axis] -= to[axis];
    cells.end[axis] -= to[axis];
  }
  return cells;
}

}  // namespace

BlockPieces::BlockPieces(std::unique_ptr<SliceSource> volume, const Task& task, const BlockSides& sides,
                         const RunControl& control, const Executor& executor)
    : source_(same_volume(std::move(volume), task), samples_around(sides.cells, task),
              own_samples(sides, task.volume.dims)),
      task_(task),
      sides_(sides) {
  const std::array<std::int64_t, 3> first = samples_around(sides.cells, task).first;
  task_.volume = source_.info();
  field_.emplace(source_, task_.surface, executor, false);
  const ExtractOptions options{field_->rule(), task_.has_normals(), PartOfLattice{task.volume.dims, first},
                               moved(sides.cells, first)};
  extractor_ = make_extractor(task_.surface.extractor, field_->info(), options, executor);
  planner_.emplace(task_, control, field_->info(), *extractor_, executor.threads(), held_by_slices(source_));
  pieces_.emplace(task_, *field_, *extractor_, *planner_, executor);
  pieces_->open();
}

void BlockPieces::next(const Held& held, SurfacePiece& piece, MeshReport& report) {
  pieces_->read(held, report);
  pieces_->make(piece, report);
  const std::uint64_t foreign = sides_.foreign();
  sides_.apply(piece);
  report.vertices_extracted -= sides_.foreign() - foreign;
}

}  // namespace isoweave
