#include "output/full_output.hpp"

#include <algorithm>
#include <span>

namespace isoweave {
namespace {

constexpr std::int64_t kBlock = 4096;
constexpr std::size_t kFew = 128;  // triangles that are looked at together

// The least vertex that triangles name; the largest number where there are no triangles.
std::uint32_t least_corner(std::span<const std::array<std::uint32_t, 3>> triangles) {
  std::uint32_t least = ~std::uint32_t{0};
  for (const auto& triangle : triangles) {
    for (const std::uint32_t corner : triangle) least = std::min(least, corner);
  }
  return least;
}

}  // namespace

void FullOutput::take(const SurfacePiece& piece) {
  const std::uint64_t first_number = output_.vertices();
  const std::uint32_t first_label = output_.add_vertices(
      {piece.positions.size(), piece.triangles.size(), !piece.normals.empty(), !piece.values.empty()},
      [&](std::size_t n) { return piece.positions[n]; }, [&](std::size_t n) { return piece.normals[n]; },
      [&](std::size_t n) { return piece.values[n]; });
  const std::span<const Point> points = output_.added_points();
  // Appends the first new vertex as well, so that a number is looked up without a branch: which vertices are inherited
  // cannot be predicted.
  front_.push_back({first_number, first_label, {}});
  const auto number = [&](std::uint32_t v) {
    const std::uint32_t n = std::min(v, piece.inherited);
    return front_[n].number + (v - n);
  };
  const auto number_all = [&]<class Index>(std::size_t first, std::span<std::array<Index, 3>> out) {
    for (std::size_t begin = 0; begin < out.size(); begin += kFew) {
      const std::span few = out.subspan(begin, std::min(kFew, out.size() - begin));
      const auto* const corners = piece.triangles.data() + first + begin;
      if (least_corner({corners, few.size()}) < piece.inherited) {
        for (std::size_t n = 0; n < few.size(); ++n) {
          for (std::size_t c = 0; c < 3; ++c) few[n][c] = static_cast<Index>(number(corners[n][c]));
        }
      } else {
        const auto before = static_cast<Index>(first_number - piece.inherited);
        for (std::size_t n = 0; n < few.size(); ++n) {
          for (std::size_t c = 0; c < 3; ++c) few[n][c] = before + corners[n][c];
        }
      }
    }
  };
  const auto vertex = [&](std::uint32_t v) {
    if (v < piece.inherited) return front_[v];
    const std::uint32_t n = v - piece.inherited;
    return OutputCorner{first_number + n, first_label + n, points[n]};
  };
  output_.add_triangles(number_all, [&](std::size_t n, std::size_t c) { return vertex(piece.triangles[n][c]); });
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
