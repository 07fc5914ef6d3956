#include "pipeline/device_back_end.hpp"

#include "pipeline/run_report.hpp"

namespace isoweave {

SlabCounts DeviceExtractor::extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                                    SurfacePiece& piece) {
  piece.clear();
  engine_.upload(window, layers);
  return engine_.extract(layers, most_vertices);
}

void DeviceBackEnd::simplify(const SurfacePiece&, bool, SlabRecord& record) {
  engine_.append();
  record.live_triangles = engine_.live_triangles();
  record.bytes += engine_.bytes();
  engine_.decide();
}

void DeviceBackEnd::write(const SurfacePiece&, SlabRecord& record, MeshReport& report) {
  output_.take(engine_);
  output_.report(report);
  record.undecided_triangles = engine_.live_triangles();
}

void DeviceBackEnd::finish(MeshReport& report) const {
  report.schedule = Schedule::kRounds;
  const DecisionCounts& counts = engine_.decisions();
  report.collapses = counts.collapses;
  report.postponed = counts.postponed;
  report.rekeyed = counts.rekeyed;
  report.specks = counts.specks;
  report.rounds = engine_.rounds();
  if (output_.measures()) report_defects(engine_.defects(), report);
}

void DeviceBackEnd::serialize(StateWriter& state) const {
  state.value(std::uint8_t{1});
  output_.serialize(state);
  engine_.write_zone(state);
}

void DeviceBackEnd::serialize(StateReader& state) {
  require_kind(state, true);
  output_.serialize(state);
  PartShape shape = part_shape(task_);
  shape.ends.push_back(output_.end());
  engine_.read_zone(state, shape);
}

}  // namespace isoweave
