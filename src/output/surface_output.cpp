#include "output/surface_output.hpp"

#include "parallel/touch.hpp"

namespace isoweave {

void SurfaceOutput::make_room(const MeshPieceSize& size) {
  if (sink_.has_room()) {
    room_ = sink_.room(size);
    touch(room_.vertices, executor_);
    touch(room_.normals, executor_);
    touch(room_.values, executor_);
    touch(room_.triangles, executor_);
    return;
  }
  const auto resized = [](auto& array, std::size_t count) {
    array.resize(count);
    return std::span(array.data(), count);
  };
  room_.vertices = resized(buffer().vertices, size.vertices);
  room_.normals = resized(buffer().normals, size.normals ? size.vertices : 0);
  room_.values = resized(buffer().values, size.values ? size.vertices : 0);
  buffer().triangles.resize(size.triangles);
}

void SurfaceOutput::hand_over() {
  const Buffer& full = buffer();
  overlapped_.append({.vertices = room_.vertices,
                      .normals = room_.normals,
                      .values = room_.values,
                      .triangles = {full.triangles.data(), full.triangles.size()}});
  next_ ^= 1;
}

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
