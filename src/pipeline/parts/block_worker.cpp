#include "pipeline/parts/block_worker.hpp"

#include <algorithm>
#include <utility>

#include "pipeline/loop.hpp"
#include "pipeline/run_report.hpp"
#include "volume/row_source.hpp"

namespace isoweave {

void BlockTotals::operator+=(const BlockTotals& other) {
  decisions += other.decisions;
  rounds += other.rounds;
  defects.resize(std::max(defects.size(), other.defects.size()));
  for (std::size_t level = 0; level < other.defects.size(); ++level) defects[level] += other.defects[level];
  range.merge(other.range);
  removed.merge(other.removed);
}

BlockWorker::BlockWorker(const Task& task, CostBits limit, const CellBox& all, const RunControl& control,
                         const Executor& executor, MeshReport& report, TakeFinal take_final)
    : task_(task),
      limit_(limit),
      all_(all),
      control_(control),
      executor_(executor),
      report_(report),
      take_final_(std::move(take_final)) {
  totals_.defects.resize(task.simplify.level_costs.size() + 1);
}

ZonePart BlockWorker::extract(std::unique_ptr<SliceSource> volume, const CellBox& cells, std::uint64_t held,
                              SlabRecord& record) {
  totals_.triangles = 0;
  if (is_without_surface(*volume, cells)) return {};
  const BlockSides sides{task_.simplify.zone.numbering, cells, all_};
  BlockPieces pieces(std::move(volume), task_, sides, control_, executor_);
  const auto simplifier = make_simplifier();
  const std::uint64_t before = report_.triangles_extracted;
  SurfacePiece piece;
  while (!pieces.complete()) {
    check_stop(control_);
    pieces.next({simplifier->live_triangles(), simplifier->zone().bytes()}, piece, report_);
    Stopwatch clock;
    simplifier->append(piece);
    record.live_triangles = std::max(record.live_triangles, simplifier->live_triangles());
    record.bytes = std::max(record.bytes, simplifier->zone().bytes() + pieces.bytes() + held);
    clock.lap(report_.seconds_simplify);
    decide(*simplifier);
  }
  totals_.triangles = report_.triangles_extracted - before;
  totals_.range.merge(pieces.range());
  return rest_of(*simplifier, [&](std::uint64_t a, std::uint64_t b) { return sides.on_border(a, b); });
}

// Whether a block has no surface as all samples of the volume are the same: none is read then. Their range is counted.
bool BlockWorker::is_without_surface(const SliceSource& volume, const CellBox& cells) {
  const std::optional<SampleBytes> sample = constant_sample(volume);
  if (!sample) return false;
  const SampleRange range = range_of_constant(*sample, task_.volume);
  if (range.empty()) return false;  // NaN are counted one by one
  const bool caps = task_.surface.closed && is_inside(*sample, task_.volume.type, task_.rule);
  for (std::size_t axis = 0; caps && axis < 3; ++axis) {
    if (cells.first[axis] == all_.first[axis] || cells.end[axis] == all_.end[axis]) return false;
  }
  totals_.range.merge(range);
  return true;
}

ZonePart BlockWorker::glue(std::vector<ZonePart> parts) {
  check_stop(control_);
  Stopwatch clock;
  const auto simplifier = make_simplifier();
  simplifier->put_part(glue_parts(std::move(parts), limit_, executor_));
  totals_.triangles = simplifier->triangles();
  clock.lap(report_.seconds_simplify);
  decide(*simplifier);
  return rest_of(*simplifier, [](std::uint64_t, std::uint64_t) { return true; });
}

std::unique_ptr<Simplifier> BlockWorker::make_simplifier() const {
  // Of a run to a number of triangles nothing is final before the end.
  const bool inspects = control_.measure && !task_.simplify.goal.given();
  const SimplifierOptions options{task_.simplify.zone, control_.schedule, task_.simplify.level_costs, inspects, true};
  auto simplifier = std::make_unique<Simplifier>(options, executor_, control_.stop.get());
  simplifier->zone().limit = limit_;
  if (task_.simplify.goal.given()) simplifier->count_removed();
  return simplifier;
}

// Decides all that can be decided, level by level.
void BlockWorker::decide(Simplifier& simplifier) {
  Stopwatch clock;
  for (std::size_t level = 0; level < simplifier.levels(); ++level) {
    simplifier.decide(level);
    clock.lap(report_.seconds_simplify);
    take_final_(simplifier, level);
    clock.lap(report_.seconds_write);
  }
}

template <class IsBorder>
ZonePart BlockWorker::rest_of(Simplifier& simplifier, const IsBorder& is_border) {
  totals_.decisions += simplifier.counts();
  totals_.rounds += simplifier.rounds();
  report_.schedule = simplifier.schedule();
  for (std::size_t level = 0; level < totals_.defects.size(); ++level) {
    totals_.defects[level] += simplifier.defects(level);
  }
  if (task_.simplify.goal.given()) totals_.removed.merge(simplifier.removed_by_key());
  return simplifier.take_part(is_border);
}

}  // namespace isoweave
