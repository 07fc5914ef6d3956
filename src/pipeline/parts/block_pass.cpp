#include "pipeline/parts/block_pass.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "pipeline/run_report.hpp"

namespace isoweave {

BlockPass::BlockPass(const Task& task, CostBits limit, const BlockStages& stages, PartStore& store,
                     const RunControl& control, const Executor& executor, MeshReport& report,
                     BlockWorker::TakeFinal take_final)
    : task_(task),
      stages_(stages),
      control_(control),
      report_(report),
      store_(store),
      worker_(task, limit, stages.all, control, executor, report, std::move(take_final)) {
  for (std::size_t stage = 0; stage < store_.stages(); ++stage) {
    next_layer_.push_back(store_.grid(stage).block_of(2, stages.all.first[2]));
  }
}

void BlockPass::extract(const VolumeOpener& open, const Tell& tell) {
  finish_all([&](std::int64_t layer) {
    SlabRecord record;
    extract_layer(open, layer, record);
    tell(record);
  });
}

void BlockPass::take_parts() {
  finish_all([&](std::int64_t layer) { take_layer(0, layer); });
}

void BlockPass::finish_all(const FirstLayer& first) {
  finish_layers(store_.stages() - 1, stages_.all.end[2] + 1, first);
  if (store_.triangles() > 0) {
    throw std::logic_error(std::to_string(store_.triangles()) + " triangles are left undecided");
  }
}

// Works on the layers of a stage that begin below a lattice plane, each after those of earlier stages below its end.
void BlockPass::finish_layers(std::size_t stage, std::int64_t plane, const FirstLayer& first) {
  const BlockGrid& grid = store_.grid(stage);
  while (grid.begin(2, next_layer_[stage]) < std::min(plane, stages_.all.end[2] + 1)) {
    if (stage > 0) finish_layers(stage - 1, grid.begin(2, next_layer_[stage] + 1), first);
    stage == 0 ? first(next_layer_[stage]) : take_layer(stage, next_layer_[stage]);
    store_.close_below(stage, ++next_layer_[stage]);
  }
}

void BlockPass::extract_layer(const VolumeOpener& open, std::int64_t layer, SlabRecord& record) {
  const BlockGrid& grid = store_.grid(0);
  for (std::int64_t y = grid.block_of(1, stages_.all.first[1]); grid.begin(1, y) < stages_.all.end[1]; ++y) {
    for (std::int64_t x = grid.block_of(0, stages_.all.first[0]); grid.begin(0, x) < stages_.all.end[0]; ++x) {
      const CellBox cells = grid.cells({x, y, layer}, stages_.all);
      if (stages_.may_have_surface(cells)) extract_block(open, cells, record);
    }
  }
  record.layer = std::min(grid.begin(2, layer + 1), stages_.all.end[2]) - stages_.all.first[2];
}

void BlockPass::extract_block(const VolumeOpener& open, const CellBox& cells, SlabRecord& record) {
  SlabRecord block;
  ZonePart rest = worker_.extract(open(), cells, store_.bytes(), block);
  record.live_triangles = std::max(record.live_triangles, block.live_triangles + store_.triangles());
  record.bytes = std::max(record.bytes, block.bytes);
  finish_block(0, std::move(rest));
}

void BlockPass::take_layer(std::size_t stage, std::int64_t layer) {
  for (const BlockIndex& block : store_.blocks(stage, layer)) {
    finish_block(stage, worker_.glue(store_.take(stage, block)));
  }
}

// Hands what is left of a block on to the next stage.
void BlockPass::finish_block(std::size_t stage, ZonePart rest) {
  check_memory_of_blocks(task_, control_, store_.grid(0).size);
  Stopwatch clock;
  report_.blocks[stage].blocks += static_cast<std::uint64_t>(worker_.totals().triangles > 0);
  report_.blocks[stage].triangles += worker_.totals().triangles;
  if (rest.triangles.size() > 0) store_.hand_on(std::move(rest), std::min(stage + 1, store_.stages() - 1));
  clock.lap(report_.seconds_simplify);
}

}  // namespace isoweave
