#include "pipeline/full_output.hpp"

#include <span>

namespace isoweave {

void FullOutput::take(const SurfacePiece& piece) {
  const std::uint64_t first_number = output_.vertices();
  const std::uint32_t first_label = output_.add_vertices(
      piece.positions.size(), {!piece.normals.empty(), !piece.values.empty()},
      [&](std::size_t n) { return piece.positions[n]; }, [&](std::size_t n) { return piece.normals[n]; },
      [&](std::size_t n) { return piece.values[n]; });
  const std::span<const Point> points = output_.added_points();
  const auto vertex = [&](std::uint32_t v) {
    if (v < piece.inherited) return front_[v];
    const std::uint32_t n = v - piece.inherited;
    return OutputCorner{first_number + n, first_label + n, points[n]};
  };
  output_.add_triangles(
      piece.triangles.size(),
      [&](std::size_t n, std::size_t c) {
        const std::uint32_t v = piece.triangles[n][c];
        return v < piece.inherited ? front_[v].number : first_number + (v - piece.inherited);
      },
      [&](std::size_t n, std::size_t c) { return vertex(piece.triangles[n][c]); });
  std::vector<OutputCorner> front;
  front.reserve(piece.incomplete.size());
  for (const std::uint32_t v : piece.incomplete) front.push_back(vertex(v));
  front_ = std::move(front);
  std::vector<std::uint32_t*> labels;
  for (OutputCorner& corner : front_) labels.push_back(&corner.label);
  if (output_.components().labels() > 0) output_.components().compact(labels);
  open_edges_ += piece.open_edges;
}

}  // namespace isoweave
