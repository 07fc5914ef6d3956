#include "pipeline/parts/block_worker.hpp"

#include <algorithm>
#include <utility>

#include "pipeline/loop.hpp"
#include "pipeline/run_report.hpp"

namespace isoweave {

BlockWorker::BlockWorker(const Task& task, const CellBox& all, const RunControl& control, const Executor& executor,
                         MeshReport& report, TakeFinal take_final)
    : task_(task),
      all_(all),
      control_(control),
      executor_(executor),
      report_(report),
      take_final_(std::move(take_final)) {
  totals_.defects.resize(task.simplify.level_costs.size() + 1);
}

ZonePart BlockWorker::extract(std::unique_ptr<SliceSource> volume, const CellBox& cells, std::uint64_t held,
                              SlabRecord& record) {
  const BlockSides sides{task_.simplify.zone.numbering, cells, all_};
  BlockPieces pieces(std::move(volume), task_, sides, control_, executor_);
  const auto simplifier = make_simplifier();
  const std::uint64_t before = report_.triangles_extracted;
  SurfacePiece piece;
  while (!pieces.complete()) {
    check_stop(control_);
    pieces.next({simplifier->live_triangles(), simplifier->zone().bytes(), 0}, piece, report_);
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

ZonePart BlockWorker::glue(std::vector<ZonePart> parts) {
  check_stop(control_);
  Stopwatch clock;
  const auto simplifier = make_simplifier();
  simplifier->put_part(glue_parts(std::move(parts), task_.simplify.zone.retire, executor_));
  totals_.triangles = simplifier->triangles();
  clock.lap(report_.seconds_simplify);
  decide(*simplifier);
  return rest_of(*simplifier, [](std::uint64_t, std::uint64_t) { return true; });
}

std::unique_ptr<Simplifier> BlockWorker::make_simplifier() const {
  const SimplifierOptions options{task_.simplify.zone, control_.schedule, task_.simplify.level_costs, control_.measure,
                                  true};
  return std::make_unique<Simplifier>(options, executor_, control_.stop.get());
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
  return simplifier.take_part(is_border);
}

}  // namespace isoweave
