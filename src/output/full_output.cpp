#include "output/full_output.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace isoweave {
namespace {

constexpr std::int64_t kFullBlock = 4096;

}  // namespace

void FullOutput::take(const SurfacePiece& piece) {
  const OutputCorner first =
      output_.take(OutputPiece{piece.positions, piece.normals, piece.values, piece.triangles}, front_);
  const std::span<const Point> points = output_.added_points();
  std::vector<OutputCorner> front;
  front.reserve(piece.incomplete.size() + 1);
  front.resize(piece.incomplete.size());
  executor_.for_each(static_cast<std::int64_t>(front.size()), kFullBlock, [&](std::int64_t n) {
    const auto at = static_cast<std::size_t>(n);
    const std::uint32_t v = piece.incomplete[at];
    const std::uint32_t added = v - piece.inherited;
    front[at] =
        v < piece.inherited ? front_[v] : OutputCorner{first.number + added, first.label + added, points[added]};
  });
  front_ = std::move(front);
  forget_components();
  open_edges_ += piece.open_edges;
}

void FullOutput::serialize(StateWriter& state) const {
  state.value(open_edges_);
  output_.serialize(state);
  state.list(front_);
}

void FullOutput::serialize(StateReader& state) {
  state.value(open_edges_);
  output_.serialize(state);
  state.list(front_);
  for (const OutputCorner& corner : front_) {
    const bool written = corner.number < output_.next_number();
    const bool labelled = corner.label < std::max<std::uint32_t>(output_.next_label(), 1);
    state.require(written && labelled, "a front of vertices that have been written");
  }
}

void FullOutput::forget_components() {
  if (output_.components().labels() == 0) return;
  std::vector<std::uint32_t*> labels;
  for (OutputCorner& corner : front_) labels.push_back(&corner.label);
  output_.components().compact(labels);
}

}  // namespace isoweave
