#include "pipeline/device_back_end.hpp"

#include <array>
#include <span>
#include <stdexcept>

#include "pipeline/run_report.hpp"

namespace isoweave {

SlabCounts DeviceExtractor::extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                                    SurfacePiece& piece) {
  piece.clear();
  engine_.upload(window, layers);
  return engine_.extract(layers, most_vertices);
}

void DeviceExtractor::exchange(StateWriter&) { throw std::logic_error("what a device holds is not saved"); }

void DeviceExtractor::exchange(StateReader&) { throw std::logic_error("what a device holds is not saved"); }

void DeviceBackEnd::simplify(const SurfacePiece&, bool, SlabRecord& record) {
  engine_.append();
  record.live_triangles = engine_.live_triangles();
  record.bytes += engine_.bytes();
  engine_.decide();
}

void DeviceBackEnd::write(const SurfacePiece&, SlabRecord& record, MeshReport& report) {
  const std::uint64_t first = output_.vertices();
  const std::size_t added = engine_.name_final();
  const std::uint32_t label = output_.next_label();
  engine_.take_final(first, label, piece_);
  output_.add_vertices(
      {.vertices = added, .triangles = piece_.triangles.size(), .normals = normals_},
      [&](std::size_t n) { return piece_.vertices[n].position; }, [&](std::size_t n) { return piece_.normals[n]; },
      [](std::size_t) { return 0.0F; });
  const auto corner = [&](std::size_t n, std::size_t c) {
    const std::uint32_t v = piece_.triangles[n][c];
    const FinalVertex& vertex = piece_.vertices[v];
    const Point point = output_.point(vertex.position);
    return v < added ? OutputCorner{first + v, label + v, point} : OutputCorner{vertex.output, vertex.component, point};
  };
  const auto number = [&]<class Index>(std::size_t n, std::span<std::array<Index, 3>> out) {
    for (auto& triangle : out) {
      for (std::size_t c = 0; c < 3; ++c) triangle[c] = static_cast<Index>(corner(n, c).number);
      ++n;
    }
  };
  output_.add_triangles(number, corner);
  if (output_.components().labels() > engine_.held_vertices()) {
    engine_.change_components([&](std::span<std::uint32_t*> labels) { output_.components().compact(labels); });
  }
  output_.report(engine_.open_edges(), report);
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

void DeviceBackEnd::exchange(StateWriter&) { throw std::logic_error("what a device holds is not saved"); }

void DeviceBackEnd::exchange(StateReader&) { throw std::logic_error("what a device holds is not saved"); }

}  // namespace isoweave
