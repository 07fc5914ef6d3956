#include "pipeline/device_back_end.hpp"

#include <stdexcept>

#include "pipeline/run_report.hpp"

namespace isoweave {

SlabCounts DeviceExtractor::extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                                    SurfacePiece& piece) {
  piece.clear();
  engine_.upload(window, layers);
  return engine_.extract(layers, most_vertices);
}

void DeviceExtractor::serialize(StateWriter&) { throw std::logic_error("what a device holds is not saved"); }

void DeviceExtractor::serialize(StateReader&) { throw std::logic_error("what a device holds is not saved"); }

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

void DeviceBackEnd::serialize(StateWriter&) { throw std::logic_error("what a device holds is not saved"); }

void DeviceBackEnd::serialize(StateReader&) { throw std::logic_error("what a device holds is not saved"); }

}  // namespace isoweave
