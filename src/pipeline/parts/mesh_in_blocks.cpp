// The main job in blocks: what is undecided in one goes on to those of the next grid.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "isoweave/blocks.hpp"
#include "output/final_output.hpp"
#include "output/world.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/parts/block_mesh.hpp"
#include "pipeline/parts/block_pass.hpp"
#include "pipeline/parts/blocks_to_number.hpp"
#include "pipeline/parts/mesh_box_in_blocks.hpp"
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
  bool has_more() const override { return block_.has_more(); }
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
            const BlockOptions& blocks, const RunControl& control, const std::optional<Region>& box)
      : open_(open),
        control_(control),
        task_(resolve_blocks(RunKind::kBlocks, *open(), options, blocks, control, common_offset(sinks))),
        identity_(identity_of(task_)),
        executor_(control.threads),
        world_(task_.volume.geometry, task_.space, task_.offset),
        stages_(task_, blocks),
        folder_(blocks.folder) {
    stages_.inside = box;
    report_.blocks.resize(stages_.grids.size());
    for (std::size_t stage = 0; stage < stages_.grids.size(); ++stage) {
      report_.blocks[stage].size = stages_.grids[stage].size;
    }
    for (MeshSink* sink : sinks) {
      outputs_.push_back(std::make_unique<FinalOutput>(world_, *sink, executor_, control_.measure));
    }
  }

  // The report; or the head start of the run that has to take the place of this one, as its own was too high.
  std::variant<MeshReport, CostBits> run(CostBits head_start) {
    start_report();
    if (task_.simplify.goal.given()) {
      if (const std::optional<CostBits> lower = take_to_number(head_start)) return *lower;
    } else {
      take_once();
    }
    finish_report();
    require_unchanged(task_, identity_);
    return std::move(report_);
  }

 private:
  // Hands triangles over as they become final.
  void take_once() {
    PartStore store(stages_.grids, task_.simplify.zone.numbering, cut_part_shape(task_.simplify), folder_);
    BlockPass pass(task_, task_.simplify.zone.retire, stages_, store, control_, executor_, report_,
                   [&](Simplifier& simplifier, std::size_t level) {
                     FinalOfBlock source(simplifier.final_source(level), store, level);
                     outputs_[level]->take(source);
                   });
    pass.extract(open_, [&](SlabRecord& record) {
      record.undecided_triangles = store.triangles();
      tell(record);
    });
    totals_ = pass.totals();
  }

  // Hands all triangles over once the number is met.
  std::optional<CostBits> take_to_number(CostBits head_start) {
    BlocksToNumber surface(task_, stages_, folder_, control_, executor_, report_);
    surface.extract(open_, head_start, [&](SlabRecord& record) {
      record.bytes += surface.kept_bytes();
      record.undecided_triangles = surface.kept();
      tell(record);
    });
    if (const std::optional<CostBits> lower = surface.thin()) return lower;
    const std::unique_ptr<Simplifier> simplifier = surface.finish();
    check_memory_of_blocks(task_, control_, stages_.grids[0].size);
    outputs_.back()->take(simplifier->final_source());
    totals_ = surface.totals();
    report_.target = surface.number();
    totals_.defects = {simplifier->defects()};
    return std::nullopt;
  }

  void tell(SlabRecord& record) {
    outputs_.back()->report(report_);
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
      report_defects(totals_.defects[level], mesh);
    }
    report_decisions(totals_.decisions, report_);
    report_.rounds = totals_.rounds;
    report_samples(task_.volume, totals_.range, report_);
    while (report_.blocks.size() > 1 && report_.blocks.back().blocks == 0) report_.blocks.pop_back();
    if (task_.simplify.goal.given()) report_target(totals_.decisions, task_.simplify, report_.target, report_);
    warn_of_border(task_, report_);
    warn_of_nothing(task_, control_.allow_empty, report_);
  }

  const VolumeOpener& open_;
  const RunControl& control_;
  const Task task_;
  const RunIdentity identity_;
  const Executor executor_;
  const World world_;
  BlockStages stages_;
  const std::string folder_;
  std::vector<std::unique_ptr<FinalOutput>> outputs_;  // per level
  MeshReport report_;
  BlockTotals totals_;
};

MeshReport run_blocks(const VolumeOpener& open, const std::optional<Region>& box, std::span<MeshSink* const> sinks,
                      const MeshOptions& options, const BlockOptions& blocks, const RunControl& control) {
  const StandardFloats floats;
  check_sinks(sinks, options.levels.size());
  const VolumeOpener surface = [&] { return box ? crop_volume(open(), *box) : open(); };
  std::variant<MeshReport, CostBits> made = CostBits{head_start_of(surface, options, control)};
  while (const CostBits* const head_start = std::get_if<CostBits>(&made)) {
    made = BlocksRun(open, sinks, options, blocks, control, box).run(*head_start);
  }
  return std::move(std::get<MeshReport>(made));
}

}  // namespace

MeshReport mesh_in_blocks(const VolumeOpener& open, MeshSink& sink, const MeshOptions& options,
                          const BlockOptions& blocks, const RunControl& control) {
  MeshSink* const sinks[] = {&sink};
  return mesh_in_blocks(open, sinks, options, blocks, control);
}

MeshReport mesh_in_blocks(const VolumeOpener& open, std::span<MeshSink* const> sinks, const MeshOptions& options,
                          const BlockOptions& blocks, const RunControl& control) {
  Stopwatch total;
  MeshReport report = run_blocks(open, std::nullopt, sinks, options, blocks, control);
  for (MeshSink* sink : sinks) sink->finish();
  total.lap(report.seconds_total);
  report.peak_bytes = system::peak_bytes();
  return report;
}

MeshReport mesh_box_in_blocks(const VolumeOpener& open, const Region& box, std::span<MeshSink* const> sinks,
                              const MeshOptions& options, const BlockOptions& blocks, const RunControl& control) {
  return run_blocks(open, box, sinks, options, blocks, control);
}

}  // namespace isoweave
