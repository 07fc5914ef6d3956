// The main job in blocks: what is undecided in one goes on to those of the next grid.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "isoweave/blocks.hpp"
#include "isoweave/error.hpp"
#include "output/final_output.hpp"
#include "output/world.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/parts/block_mesh.hpp"
#include "pipeline/parts/block_worker.hpp"
#include "pipeline/parts/part_store.hpp"
#include "pipeline/run_identity.hpp"
#include "pipeline/run_report.hpp"
#include "system/process_memory.hpp"

namespace isoweave {
namespace {

// The final triangles of a block, where parts that wait have receipts as well.
class FinalOfBlock final : public FinalSource {
 public:
  FinalOfBlock(FinalSource& block, PartStore& store, std::size_t level) : block_(block), store_(store), level_(level) {}

  void take_final(const Receipt& first, FinalPiece& piece) override { block_.take_final(first, piece); }
  std::size_t held_vertices() const override { return block_.held_vertices() + store_.vertices(); }
  void change_labels(const std::function<void(std::span<std::uint32_t*>)>& change) override {
    block_.change_labels([&](std::span<std::uint32_t*> here) {
      std::vector<std::uint32_t*> labels(here.begin(), here.end());
      store_.list_labels(level_, labels);
      change(labels);
    });
  }

 private:
  FinalSource& block_;
  PartStore& store_;
  const std::size_t level_;
};

class BlocksRun {
 public:
  BlocksRun(const VolumeOpener& open, std::span<MeshSink* const> sinks, const MeshOptions& options,
            const BlockOptions& blocks, const RunControl& control)
      : open_(open),
        control_(control),
        task_(resolve_blocks(*open(), options, blocks, control, common_offset(sinks))),
        identity_(identity_of(task_)),
        executor_(control.threads),
        world_(task_.volume.geometry, task_.space, task_.offset),
        sinks_(sinks.begin(), sinks.end()),
        stages_(task_, blocks),
        store_(stages_.grids, task_.simplify.zone.numbering, cut_part_shape(task_.simplify), blocks.folder),
        worker_(task_, stages_.all, control_, executor_, report_,
                [this](Simplifier& simplifier, std::size_t level) { write_final(simplifier, level); }) {
    report_.blocks.resize(store_.stages());
    for (std::size_t stage = 0; stage < store_.stages(); ++stage) {
      report_.blocks[stage].size = store_.grid(stage).size;
      next_layer_.push_back(store_.grid(stage).block_of(2, stages_.all.first[2]));
    }
    for (MeshSink* sink : sinks_) {
      outputs_.push_back(std::make_unique<FinalOutput>(world_, *sink, executor_, control_.measure));
    }
  }

  MeshReport run() {
    Stopwatch total;
    start_report();
    finish_layers(store_.stages() - 1, stages_.all.end[2] + 1);
    if (store_.triangles() > 0) {
      throw std::logic_error(std::to_string(store_.triangles()) + " triangles are left undecided");
    }
    finish_report();
    require_unchanged(task_, identity_);
    for (MeshSink* sink : sinks_) sink->finish();
    total.lap(report_.seconds_total);
    report_.peak_bytes = system::peak_bytes();
    return std::move(report_);
  }

 private:
  // Works on the layers of a stage that begin below a lattice plane, each after those of earlier stages below its end.
  void finish_layers(std::size_t stage, std::int64_t plane) {
    const BlockGrid& grid = store_.grid(stage);
    while (grid.begin(2, next_layer_[stage]) < std::min(plane, stages_.all.end[2] + 1)) {
      if (stage > 0) finish_layers(stage - 1, grid.begin(2, next_layer_[stage] + 1));
      stage == 0 ? extract_layer(next_layer_[stage]) : take_layer(stage, next_layer_[stage]);
      store_.close_below(stage, ++next_layer_[stage]);
    }
  }

  void extract_layer(std::int64_t layer) {
    const BlockGrid& grid = store_.grid(0);
    SlabRecord record;
    for (std::int64_t y = grid.block_of(1, stages_.all.first[1]); grid.begin(1, y) < stages_.all.end[1]; ++y) {
      for (std::int64_t x = grid.block_of(0, stages_.all.first[0]); grid.begin(0, x) < stages_.all.end[0]; ++x) {
        extract_block(grid.cells({x, y, layer}, stages_.all), record);
      }
    }
    record.layer = std::min(grid.begin(2, layer + 1), stages_.all.end[2]) - stages_.all.first[2];
    tell(record);
  }

  void extract_block(const CellBox& cells, SlabRecord& record) {
    if (cells.empty()) return;
    SlabRecord block;
    ZonePart rest = worker_.extract(open_(), cells, store_.bytes(), block);
    record.live_triangles = std::max(record.live_triangles, block.live_triangles + store_.triangles());
    record.bytes = std::max(record.bytes, block.bytes);
    finish_block(0, std::move(rest));
  }

  void take_layer(std::size_t stage, std::int64_t layer) {
    for (const BlockIndex& block : store_.blocks(stage, layer)) {
      finish_block(stage, worker_.glue(store_.take(stage, block)));
    }
  }

  // Hands what is left of a block on to the next stage.
  void finish_block(std::size_t stage, ZonePart rest) {
    check_memory();
    Stopwatch clock;
    report_.blocks[stage].blocks += static_cast<std::uint64_t>(worker_.totals().triangles > 0);
    report_.blocks[stage].triangles += worker_.totals().triangles;
    if (rest.triangles.size() > 0) store_.hand_on(std::move(rest), std::min(stage + 1, store_.stages() - 1));
    clock.lap(report_.seconds_simplify);
  }

  void write_final(Simplifier& simplifier, std::size_t level) {
    FinalOfBlock source(simplifier.final_source(level), store_, level);
    outputs_[level]->take(source);
  }

  // Ends a run that has gone beyond its cap. Slabs are chosen for it, but a block of a later stage is as large as it
  // is.
  void check_memory() const {
    const std::uint64_t found = control_.memory > 0 ? system::resident_bytes() : 0;
    if (found <= control_.memory) return;
    throw OverMemory(task_.volume.path + ": expected the process to stay below " + std::to_string(control_.memory) +
                     " bytes, found " + std::to_string(found) + ": blocks of " + std::to_string(store_.grid(0).size) +
                     " cells take more here");
  }

  void tell(SlabRecord& record) {
    outputs_.back()->report(report_);
    record.undecided_triangles = store_.triangles();
    record.final_triangles = report_.triangles;
    report_.sweep.push_back(record);
    if (!control_.progress) return;
    const std::int64_t slices = std::min(record.layer, task_.volume.dims[2]);
    const auto voxels = static_cast<std::uint64_t>(slices * task_.volume.slice_samples());
    control_.progress({record.layer, stages_.all.end[2] - stages_.all.first[2], voxels, record.live_triangles,
                       record.final_triangles, record.bytes});
  }

  void start_report() {
    report_.threads = executor_.threads();
    report_.slab = control_.slab;
    report_errors(task_.simplify, report_);
    warn_of_space(task_, report_);
    warn_of_rounding(task_, report_);
  }

  void finish_report() {
    for (const auto& output : outputs_) output->wait();
    for (std::size_t level = 0; level < outputs_.size(); ++level) {
      SurfaceReport& mesh = level + 1 == outputs_.size() ? report_ : report_.levels[level];
      outputs_[level]->report(mesh);
      report_defects(worker_.totals().defects[level], mesh);
    }
    report_decisions(worker_.totals().decisions, report_);
    report_.rounds = worker_.totals().rounds;
    report_samples(task_.volume, worker_.totals().range, report_);
    while (report_.blocks.size() > 1 && report_.blocks.back().blocks == 0) report_.blocks.pop_back();
    warn_of_border(task_, report_);
    warn_of_nothing(task_, control_.allow_empty, report_);
  }

  const VolumeOpener& open_;
  const RunControl& control_;
  const Task task_;
  const RunIdentity identity_;
  const Executor executor_;
  const World world_;
  const std::vector<MeshSink*> sinks_;
  const BlockStages stages_;
  PartStore store_;
  std::vector<std::int64_t> next_layer_;               // per stage
  std::vector<std::unique_ptr<FinalOutput>> outputs_;  // per level
  MeshReport report_;
  BlockWorker worker_;
};

}  // namespace

MeshReport mesh_in_blocks(const VolumeOpener& open, MeshSink& sink, const MeshOptions& options,
                          const BlockOptions& blocks, const RunControl& control) {
  MeshSink* const sinks[] = {&sink};
  return mesh_in_blocks(open, sinks, options, blocks, control);
}

MeshReport mesh_in_blocks(const VolumeOpener& open, std::span<MeshSink* const> sinks, const MeshOptions& options,
                          const BlockOptions& blocks, const RunControl& control) {
  const StandardFloats floats;
  check_sinks(sinks, options.levels.size());
  return BlocksRun(open, sinks, options, blocks, control).run();
}

}  // namespace isoweave
