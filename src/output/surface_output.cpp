#include "output/surface_output.hpp"

#include <algorithm>
#include <utility>

#include "output/sweep_view.hpp"
#include "parallel/touch.hpp"

namespace isoweave {
namespace {

using Triangles = std::span<const std::array<std::uint32_t, 3>>;

constexpr std::size_t kFew = 128;  // triangles that are looked at together

std::int64_t signed_count(std::size_t count) { return static_cast<std::int64_t>(count); }

// The least vertex that triangles name; the largest number where there are no triangles.
std::uint32_t least_corner(Triangles triangles) {
  std::uint32_t least = ~std::uint32_t{0};
  for (const auto& triangle : triangles) {
    for (const std::uint32_t corner : triangle) least = std::min(least, corner);
  }
  return least;
}

// Writes triangles with the numbers of their vertices in the output. The last written vertex is the first new one, so
// that a number is looked up without a branch: which vertices are new cannot be predicted.
template <class Index>
void number_corners(Triangles triangles, std::span<const OutputCorner> written, std::array<Index, 3>* out) {
  const auto first_new = static_cast<std::uint32_t>(written.size() - 1);
  if (least_corner(triangles) >= first_new) {
    const auto before = static_cast<Index>(written.back().number - first_new);
    for (std::size_t n = 0; n < triangles.size(); ++n) {
      for (std::size_t c = 0; c < 3; ++c) out[n][c] = before + triangles[n][c];
    }
    return;
  }
  for (std::size_t n = 0; n < triangles.size(); ++n) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = triangles[n][c];
      const std::uint32_t at = std::min(v, first_new);
      out[n][c] = static_cast<Index>(written[at].number + (v - at));
    }
  }
}

}  // namespace

OutputCorner SurfaceOutput::take(const OutputPiece& piece, std::vector<OutputCorner>& written) {
  make_room({piece.positions.size(), piece.triangles.size(), !piece.normals.empty(), !piece.values.empty()});
  const OutputCorner first{vertices_, add_vertices(piece), {}};
  written.push_back(first);
  if (sink_.has_room()) {
    add_triangles(piece.triangles, written, room_.triangles);
  } else {
    auto& triangles = buffer().triangles;
    add_triangles(piece.triangles, written, std::span(triangles.begin(), triangles.end()));
  }
  vertices_ += piece.positions.size();
  triangles_ += piece.triangles.size();
  if (measure_) measure(piece.triangles, written);
  if (observer_ != nullptr) show(piece.triangles, written);
  if (!sink_.has_room()) hand_over();
  return first;
}

// Writes new vertices, and returns the label of the first of them.
std::uint32_t SurfaceOutput::add_vertices(const OutputPiece& piece) {
  executor_.for_each(signed_count(piece.positions.size()), kBlock, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    room_.vertices[n] = world_.point(piece.positions[n]);
    if (!piece.normals.empty()) room_.normals[n] = world_.normal(piece.normals[n]);
    if (!piece.values.empty()) room_.values[n] = piece.values[n];
  });
  return measure_ ? components_.add(piece.positions.size()) : 0;
}

template <class Index>
void SurfaceOutput::add_triangles(Triangles from, std::span<const OutputCorner> written,
                                  std::span<std::array<Index, 3>> out) {
  executor_.for_blocks(signed_count(from.size()), kBlock, [&](std::int64_t begin, std::int64_t end) {
    for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); n += kFew) {
      number_corners(from.subspan(n, std::min(kFew, static_cast<std::size_t>(end) - n)), written, &out[n]);
    }
    if (!world_.mirrors()) return;
    for (std::int64_t n = begin; n < end; ++n) {
      auto& triangle = out[static_cast<std::size_t>(n)];
      std::swap(triangle[1], triangle[2]);
    }
  });
}

OutputCorner SurfaceOutput::corner(std::uint32_t v, std::span<const OutputCorner> written) const {
  const auto first_new = static_cast<std::uint32_t>(written.size() - 1);
  if (v < first_new) return written[v];
  const std::uint32_t n = v - first_new;
  return {written.back().number + n, written.back().label + n, room_.vertices[n]};
}

// Adds triangles to the digest, and joins the components that they connect.
void SurfaceOutput::measure(Triangles triangles, std::span<const OutputCorner> written) {
  const std::array<std::size_t, 3> order = turn();
  executor_.for_blocks(signed_count(triangles.size()), kBlock, [&](std::int64_t begin, std::int64_t end) {
    std::uint64_t digest = 0;
    std::uint64_t joins = 0;
    for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
      std::array<OutputCorner, 3> corners;
      for (std::size_t c = 0; c < 3; ++c) corners[c] = corner(triangles[n][order[c]], written);
      digest += triangle_digest(corners[0].point, corners[1].point, corners[2].point, world_.offset());
      for (std::size_t c = 1; c < 3; ++c) joins += components_.join(corners[0].label, corners[c].label) ? 1U : 0U;
    }
    digest_.fetch_add(digest, std::memory_order_relaxed);
    components_.count_joins(joins);
  });
}

void SurfaceOutput::show(Triangles triangles, std::span<const OutputCorner> written) const {
  const std::array<std::size_t, 3> order = turn();
  view_triangles(
      triangles.size(), [&](std::size_t n, std::size_t c) { return corner(triangles[n][order.at(c)], written).point; },
      executor_, [&](std::span<const TriangleCorners> block) { observer_->add_final(block); });
}

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

void SurfaceOutput::serialize(StateWriter& state) const {
  state.value(vertices_);
  state.value(triangles_);
  state.value(digest_.load());
  components_.serialize(state);
}

void SurfaceOutput::serialize(StateReader& state) {
  std::uint64_t digest = 0;
  state.value(vertices_);
  state.value(triangles_);
  state.value(digest);
  components_.serialize(state);
  digest_ = digest;
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
