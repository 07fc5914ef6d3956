#include "pipeline/parts/blocks_to_number.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "isoweave/forecast.hpp"
#include "pipeline/run_report.hpp"
#include "simplify/count_target.hpp"
#include "simplify/part_algebra.hpp"

namespace isoweave {

CostBits head_start_of(const VolumeOpener& open, const MeshOptions& options, const RunControl& control) {
  if (!goal_of(options).given()) return kUnknownCost;
  const std::unique_ptr<SliceSource> volume = open();
  std::optional<double> error = control.head_start;
  if (!error) {
    RunControl uncapped = control;  // slabs may not fit, and are not taken
    uncapped.memory = 0;
    error = forecast_mesh(*volume, options, uncapped).head_start;
  }
  return head_start_cost(*error, volume->info());
}

BlocksToNumber::BlocksToNumber(const Task& task, const BlockStages& stages, const std::string& folder,
                               const RunControl& control, const Executor& executor, MeshReport& report)
    : task_(task),
      stages_(stages),
      folder_(folder),
      control_(control),
      executor_(executor),
      report_(report),
      kept_(make_store()) {}

std::unique_ptr<PartStore> BlocksToNumber::make_store() const {
  return std::make_unique<PartStore>(stages_.grids, task_.simplify.zone.numbering, cut_part_shape(task_.simplify),
                                     folder_);
}

void BlocksToNumber::extract(const VolumeOpener& open, CostBits limit, const BlockPass::Tell& tell) {
  pass(std::min(limit, task_.simplify.zone.retire), [&](BlockPass& pass) { pass.extract(open, tell); });
}

void BlocksToNumber::keep(KeptTriangles kept) {
  least_.merge(kept.least);
  totals_.removed.merge(kept.removed);
  for (ZonePart& part : kept.parts) kept_->hand_on(std::move(part), 0);
}

std::optional<CostBits> BlocksToNumber::thin() {
  number_ = task_.simplify.goal.of(kept() + totals_.decisions.removed);
  while (!has_overshot() && kept() > most_together(number_)) {
    const CostBits higher = std::min(least_.highest_with_beyond(number_), task_.simplify.zone.retire);
    if (higher <= limit_) break;
    pass(higher, [](BlockPass& pass) { pass.take_parts(); });
  }
  if (has_overshot()) return safe_limit();
  return std::nullopt;
}

// Passes with a limit, and keeps what has no edge within it any more.
void BlocksToNumber::pass(CostBits limit, const std::function<void(BlockPass& pass)>& run) {
  limit_ = limit;
  least_ = {};
  const std::unique_ptr<PartStore> waiting = std::exchange(kept_, make_store());
  BlockPass pass(task_, limit, stages_, *waiting, control_, executor_, report_,
                 [&](Simplifier& simplifier, std::size_t) {
                   ZonePart part = simplifier.take_settled(least_);
                   if (part.triangles.size() > 0) kept_->hand_on(std::move(part), 0);
                 });
  run(pass);
  totals_ += pass.totals();
}

// Whether a limit may have gone beyond the collapse that meets the number.
bool BlocksToNumber::has_overshot() const { return kept() <= number_ && totals_.decisions.removed > 0; }

CostBits BlocksToNumber::safe_limit() const {
  const std::uint64_t all = kept() + totals_.decisions.removed;
  if (all <= number_) return kUnknownCost;
  return totals_.removed.highest_with_below(all - number_ - 1);
}

std::unique_ptr<Simplifier> BlocksToNumber::finish() {
  Stopwatch clock;
  auto simplifier = std::make_unique<Simplifier>(
      SimplifierOptions{task_.simplify.zone, control_.schedule, {}, control_.measure}, executor_, control_.stop.get());
  CountTarget target(*simplifier, executor_, TriangleGoal{number_}, HeadStart{limit_});
  simplifier->put_part(glue_parts(kept_->take_all(), task_.simplify.zone.retire, executor_));
  target.finish();
  totals_.decisions += simplifier->counts();
  totals_.rounds += simplifier->rounds();
  report_.schedule = simplifier->schedule();
  clock.lap(report_.seconds_simplify);
  return simplifier;
}

}  // namespace isoweave
