#include "pipeline/surface_output.hpp"

namespace isoweave {

void SurfaceOutput::report(std::uint64_t open_edges, SurfaceReport& report) const {
  report.vertices = vertices_;
  report.triangles = triangles_;
  report.open_edges = open_edges;
  const std::uint64_t edges = (3 * triangles_ + open_edges) / 2;
  report.euler = static_cast<std::int64_t>(vertices_ + triangles_) - static_cast<std::int64_t>(edges);
  if (!measure_) return;
  report.components = components_.count();
  report.digest = digest_;
}

}  // namespace isoweave
