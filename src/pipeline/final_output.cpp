#include "pipeline/final_output.hpp"

#include <utility>

namespace isoweave {

void FinalOutput::take(Simplifier& simplifier) {
  Zone& zone = simplifier.zone();
  points_.clear();
  normals_.clear();
  triangles_.clear();
  const std::vector<Index> final_triangles = simplifier.final_triangles();
  for (const Index t : final_triangles) triangles_.push_back(write_triangle(zone, t));
  sink_.append(points_, normals_, triangles_);
  triangles_written_ += triangles_.size();
  simplifier.drop(final_triangles);
  if (components_.labels() > zone.vertices.size()) forget_components(zone);
}

std::array<std::uint64_t, 3> FinalOutput::write_triangle(Zone& zone, Index t) {
  std::array<std::uint64_t, 3> numbers;
  std::array<Point, 3> corners;
  for (Index c = 0; c < 3; ++c) {
    const Index h = half_edge(t, c);
    const Index v = zone.origin(h);
    Vertex& vertex = zone.vertices[v];
    corners[c] = world_.point(vertex.position);
    if (vertex.output == kNotWritten) {
      vertex.output = vertices_written_++;
      vertex.component = components_.add();
      points_.push_back(corners[c]);
      if (!zone.normals.empty()) normals_.push_back(world_.normal(zone.normals[v]));
    }
    numbers[c] = vertex.output;
    const Index twin = zone.twin(h);
    open_edges_ += twin == kNone;
    if (exists(twin)) zone.set_twin(twin, kWritten);
  }
  const Index first = zone.vertices[zone.origin(half_edge(t, 0))].component;
  components_.join(first, zone.vertices[zone.origin(half_edge(t, 1))].component);
  components_.join(first, zone.vertices[zone.origin(half_edge(t, 2))].component);
  if (world_.mirrors()) {
    std::swap(numbers[1], numbers[2]);
    std::swap(corners[1], corners[2]);
  }
  digest_ += triangle_digest(corners[0], corners[1], corners[2]);
  return numbers;
}

void FinalOutput::forget_components(Zone& zone) {
  std::vector<std::uint32_t*> labels;
  for (Vertex& vertex : zone.vertices) {
    if (vertex.output != kNotWritten) labels.push_back(&vertex.component);
  }
  components_.compact(labels);
}

void FinalOutput::report(MeshReport& report) const {
  report.vertices = vertices_written_;
  report.triangles = triangles_written_;
  report.open_edges = open_edges_;
  report.components = components_.count();
  const std::uint64_t edges = (3 * triangles_written_ + open_edges_) / 2;
  report.euler = static_cast<std::int64_t>(vertices_written_ + triangles_written_) - static_cast<std::int64_t>(edges);
  report.digest = digest_;
}

}  // namespace isoweave
