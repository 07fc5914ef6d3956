#include "pipeline/full_output.hpp"

#include <algorithm>
#include <span>

namespace isoweave {
namespace {

constexpr std::int64_t kBlock = 4096;

}  // namespace

void FullOutput::take(const SurfacePiece& piece) {
  const std::uint64_t first_number = output_.vertices();
  const std::uint32_t first_label = output_.add_vertices(
      piece.positions.size(), {!piece.normals.empty(), !piece.values.empty()},
      [&](std::size_t n) { return piece.positions[n]; }, [&](std::size_t n) { return piece.normals[n]; },
      [&](std::size_t n) { return piece.values[n]; });
  const std::span<const Point> points = output_.added_points();
  // Without a branch, as which vertices are inherited cannot be predicted: the first new one follows those in the list.
  front_.push_back({first_number, first_label, {}});
  const auto number = [&](std::uint32_t v) {
    const std::uint32_t n = std::min(v, piece.inherited);
    return front_[n].number + (v - n);
  };
  const auto vertex = [&](std::uint32_t v) {
    if (v < piece.inherited) return front_[v];
    const std::uint32_t n = v - piece.inherited;
    return OutputCorner{first_number + n, first_label + n, points[n]};
  };
  output_.add_triangles(
      piece.triangles.size(), [&](std::size_t n, std::size_t c) { return number(piece.triangles[n][c]); },
      [&](std::size_t n, std::size_t c) { return vertex(piece.triangles[n][c]); });
  std::vector<OutputCorner> front;
  front.reserve(piece.incomplete.size() + 1);
  front.resize(piece.incomplete.size());
  executor_.for_each(static_cast<std::int64_t>(front.size()), kBlock, [&](std::int64_t n) {
    const auto at = static_cast<std::size_t>(n);
    front[at] = vertex(piece.incomplete[at]);
  });
  front_ = std::move(front);
  forget_components();
  open_edges_ += piece.open_edges;
}

void FullOutput::forget_components() {
  if (output_.components().labels() == 0) return;
  std::vector<std::uint32_t*> labels;
  for (OutputCorner& corner : front_) labels.push_back(&corner.label);
  output_.components().compact(labels);
}

}  // namespace isoweave
