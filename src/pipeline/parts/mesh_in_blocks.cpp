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
#include "pipeline/loop.hpp"
#include "pipeline/parts/block_pieces.hpp"
#include "pipeline/parts/part_store.hpp"
#include "pipeline/run_identity.hpp"
#include "pipeline/run_report.hpp"
#include "system/process_memory.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kLeastBlock = 8;

// The final triangles of a block, where parts that wait have receipts as well.
class BlockSourceOfFinals final : public FinalSource {
 public:
  // level: of the meshes that come out; levels: before the last one.
  BlockSourceOfFinals(FinalSource& block, PartStore& store, std::size_t level, std::size_t levels)
      : block_(block), store_(store), level_(level), levels_(levels) {}

  void take_final(const Receipt& first, FinalPiece& piece) override { block_.take_final(first, piece); }
  std::size_t held_vertices() const override { return block_.held_vertices() + store_.vertices(); }
  void change_labels(const std::function<void(std::span<std::uint32_t*>)>& change) override {
    block_.change_labels([&](std::span<std::uint32_t*> here) {
      std::vector<std::uint32_t*> labels(here.begin(), here.end());
      store_.each_part([&](ZonePart& part) { list_labels(part, labels); });
      change(labels);
    });
  }

 private:
  void list_labels(ZonePart& part, std::vector<std::uint32_t*>& labels) const {
    for (Index v = 0; v < part.vertices.size(); ++v) {
      Vertex& last = part.vertices[v];
      const bool is_last = level_ == levels_;
      const std::uint64_t number = is_last ? last.number : part.levels[level_][v].number;
      if (number != kNotHandedOver) labels.push_back(is_last ? &last.label : &part.levels[level_][v].label);
    }
  }

  FinalSource& block_;
  PartStore& store_;
  const std::size_t level_, levels_;
};

const VolumeInfo& read_anywhere(const SliceSource& volume) {
  if (volume.skips()) return volume.info();
  throw BadInput(volume.info().path +
                 ": expected a volume that can be read anywhere, for blocks, found one that has to "
                 "be read from its beginning: unpack it first");
}

MeshOptions checked_options(const MeshOptions& options, const BlockOptions& blocks, const RunControl& control) {
  require_possible(RunKind::kBlocks, options, control);
  if (blocks.size < kLeastBlock) {
    throw std::invalid_argument("blocks: expected a size of " + std::to_string(kLeastBlock) + " or more, found " +
                                std::to_string(blocks.size));
  }
  return options;
}

class BlocksRun {
 public:
  BlocksRun(const VolumeOpener& open, std::span<MeshSink* const> sinks, const MeshOptions& options,
            const BlockOptions& blocks, const RunControl& control)
      : open_(open),
        control_(control),
        task_(resolve(read_anywhere(*open()), checked_options(options, blocks, control), control, common_offset(sinks),
                      RunKind::kBlocks)),
        identity_(identity_of(task_)),
        executor_(control.threads),
        world_(task_.volume.geometry, task_.space, task_.offset),
        sinks_(sinks.begin(), sinks.end()),
        all_(CellBox::of_volume(task_.volume.dims, task_.surface.closed)),
        store_(stage_grids(all_, blocks.size, blocks.first), task_.simplify.zone.numbering),
        defects_(sinks.size()) {
    report_.blocks.resize(store_.stages());
    for (std::size_t stage = 0; stage < store_.stages(); ++stage) {
      report_.blocks[stage].size = store_.grid(stage).size;
      next_layer_.push_back(store_.grid(stage).block_of(2, all_.first[2]));
    }
    for (MeshSink* sink : sinks_) {
      outputs_.push_back(std::make_unique<FinalOutput>(world_, *sink, executor_, control_.measure));
    }
  }

  MeshReport run() {
    Stopwatch total;
    start_report();
    finish_layers(store_.stages() - 1, all_.end[2] + 1);
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
    while (grid.begin(2, next_layer_[stage]) < std::min(plane, all_.end[2] + 1)) {
      if (stage > 0) finish_layers(stage - 1, grid.begin(2, next_layer_[stage] + 1));
      stage == 0 ? extract_layer(next_layer_[stage]) : take_layer(stage, next_layer_[stage]);
      store_.close_below(stage, ++next_layer_[stage]);
    }
  }

  void extract_layer(std::int64_t layer) {
    const BlockGrid& grid = store_.grid(0);
    SlabRecord record;
    for (std::int64_t y = grid.block_of(1, all_.first[1]); grid.begin(1, y) < all_.end[1]; ++y) {
      for (std::int64_t x = grid.block_of(0, all_.first[0]); grid.begin(0, x) < all_.end[0]; ++x) {
        extract_block(grid.cells({x, y, layer}, all_), record);
      }
    }
    record.layer = std::min(grid.begin(2, layer + 1), all_.end[2]) - all_.first[2];
    tell(record);
  }

  void extract_block(const CellBox& cells, SlabRecord& record) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (cells.first[axis] >= cells.end[axis]) return;
    }
    check_stop(control_);
    const BlockSides sides{task_.simplify.zone.numbering, cells, all_};
    BlockPieces pieces(open_(), task_, sides, control_, executor_);
    Simplifier simplifier = make_simplifier();
    const std::uint64_t extracted = report_.triangles_extracted;
    SurfacePiece piece;
    while (!pieces.complete()) {
      check_stop(control_);
      pieces.next({simplifier.live_triangles(), simplifier.zone().bytes(), store_.bytes()}, piece, report_);
      Stopwatch clock;
      simplifier.append(piece);
      record.live_triangles = std::max(record.live_triangles, simplifier.live_triangles() + store_.triangles());
      record.bytes = std::max(record.bytes, simplifier.zone().bytes() + pieces.bytes() + store_.bytes());
      clock.lap(report_.seconds_simplify);
      decide(simplifier);
    }
    range_.merge(pieces.range());
    count(report_.blocks[0], report_.triangles_extracted - extracted);
    hand_on(simplifier, 0, [&](std::uint64_t a, std::uint64_t b) { return sides.on_border(a, b); });
  }

  void take_layer(std::size_t stage, std::int64_t layer) {
    for (const BlockIndex& block : store_.blocks(stage, layer)) {
      check_stop(control_);
      Stopwatch clock;
      Simplifier simplifier = make_simplifier();
      simplifier.put_part(glue_parts(store_.take(stage, block), task_.simplify.zone.retire));
      count(report_.blocks[stage], simplifier.triangles());
      clock.lap(report_.seconds_simplify);
      decide(simplifier);
      hand_on(simplifier, stage, [](std::uint64_t, std::uint64_t) { return true; });
    }
  }

  static void count(BlockStage& stage, std::uint64_t triangles) {
    stage.blocks += triangles > 0 ? 1 : 0;
    stage.triangles += triangles;
  }

  Simplifier make_simplifier() const {
    return Simplifier({task_.simplify.zone, control_.schedule, task_.simplify.level_costs, control_.measure, true},
                      executor_, control_.stop.get());
  }

  // Decides all that can be decided, and writes what is final.
  void decide(Simplifier& simplifier) {
    Stopwatch clock;
    for (std::size_t level = 0; level < simplifier.levels(); ++level) {
      simplifier.decide(level);
      clock.lap(report_.seconds_simplify);
      BlockSourceOfFinals source(simplifier.final_source(level), store_, level, simplifier.levels() - 1);
      outputs_[level]->take(source);
      clock.lap(report_.seconds_write);
    }
  }

  // Hands what is left of a block on to the next stage.
  template <class IsBorder>
  void hand_on(Simplifier& simplifier, std::size_t stage, const IsBorder& is_border) {
    Stopwatch clock;
    counts_ += simplifier.counts();
    report_.rounds += simplifier.rounds();
    report_.schedule = simplifier.schedule();
    for (std::size_t level = 0; level < defects_.size(); ++level) defects_[level] += simplifier.defects(level);
    ZonePart rest = simplifier.take_part(is_border);
    if (rest.triangles.size() > 0) store_.hand_on(std::move(rest), std::min(stage + 1, store_.stages() - 1));
    clock.lap(report_.seconds_simplify);
  }

  void tell(SlabRecord& record) {
    outputs_.back()->report(report_);
    record.undecided_triangles = store_.triangles();
    record.final_triangles = report_.triangles;
    report_.sweep.push_back(record);
    if (!control_.progress) return;
    const std::int64_t slices = std::min(record.layer, task_.volume.dims[2]);
    const auto voxels = static_cast<std::uint64_t>(slices * task_.volume.slice_samples());
    control_.progress({record.layer, all_.end[2] - all_.first[2], voxels, record.live_triangles, record.final_triangles,
                       record.bytes});
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
      report_defects(defects_[level], mesh);
    }
    report_decisions(counts_, report_);
    report_samples(task_.volume, range_, report_);
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
  const CellBox all_;
  PartStore store_;
  std::vector<std::int64_t> next_layer_;               // per stage
  std::vector<std::unique_ptr<FinalOutput>> outputs_;  // per level
  MeshReport report_;
  SampleRange range_;
  DecisionCounts counts_;
  std::vector<SurfaceDefects> defects_;  // per level
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
