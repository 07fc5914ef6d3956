#include "cluster/clusters.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "parallel/collect.hpp"
#include "parallel/vertex_owners.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kClusterBlock = 4096;
constexpr std::size_t kFewTriangles = std::size_t{1} << 16;

// The corners in the same direction, from the least one on.
std::array<std::uint32_t, 3> from_least(const std::array<std::uint32_t, 3>& t) {
  if (t[1] < t[0] && t[1] < t[2]) return {t[1], t[2], t[0]};
  if (t[2] < t[0] && t[2] < t[1]) return {t[2], t[0], t[1]};
  return t;
}

}  // namespace

void Clusters::apply(SurfacePiece& piece) {
  find_cells(piece);
  sum_planes(piece);
  keep_triangles();
  list_front(piece);
}

// Finds the cells of the vertices and corners of the piece. Neighbours are mostly in one cell.
void Clusters::find_cells(const SurfacePiece& piece) {
  const std::size_t inherited = piece.inherited;
  const std::size_t added = piece.positions.size();
  positions_.resize(inherited + added);
  cells_.resize(inherited + added);
  keys_.resize(added);
  executor_.for_each(static_cast<std::int64_t>(added), kClusterBlock, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    positions_[inherited + n] = piece.positions[n];
    keys_[n] = grid_.key(piece.positions[n]);
  });
  for (std::size_t n = 0; n < added; ++n) {
    const bool same = n > 0 && keys_[n] == keys_[n - 1];
    cells_[inherited + n] = same ? cells_[inherited + n - 1] : table_.number(keys_[n]);
  }
  corners_.resize(piece.triangles.size());
  executor_.for_each(static_cast<std::int64_t>(corners_.size()), kClusterBlock, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    for (std::size_t c = 0; c < 3; ++c) corners_[n][c] = cells_[piece.triangles[n][c]];
  });
}

// Every thread has cells of its own, and adds the triangles in their order: sums are the same for any threads and
// pieces.
void Clusters::sum_planes(const SurfacePiece& piece) {
  const std::size_t before = sums_.size();
  sums_.resize(table_.keys().size());
  std::fill(sums_.begin() + before, sums_.end(), CellSum{});
  const VertexOwners owners(executor_, {corners_.data(), corners_.size()});
  owners.for_parts(sums_.size(), [&](const VertexOwners::Part& part) {
    part.each_triangle([&](std::size_t n) {
      const Corners& cells = corners_[n];
      if (!part.has(cells[0]) && !part.has(cells[1]) && !part.has(cells[2])) return;
      const auto& t = piece.triangles[n];
      const std::array<Vec3, 3> corners{positions_[t[0]], positions_[t[1]], positions_[t[2]]};
      const WeighedPlane plane(corners);
      for (std::size_t c = 0; c < 3; ++c) {
        if (part.has(cells[c])) sums_[cells[c]].add(plane, corners[c] - grid_.middle(table_.keys()[cells[c]]));
      }
    });
  });
}

void Clusters::keep_triangles() {
  collect(
      executor_, static_cast<std::int64_t>(corners_.size()), kClusterBlock,
      [&](std::int64_t begin, std::int64_t end, std::vector<Corners>& list) {
        for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
          const Corners& cells = corners_[n];
          if (cells[0] == cells[1] || cells[1] == cells[2] || cells[2] == cells[0]) continue;
          list.push_back(from_least(cells));
        }
      },
      kept_);
  collapsed_ += corners_.size() - kept_.size();
  triangles_.insert(triangles_.end(), kept_.begin(), kept_.end());
  if (triangles_.size() > 2 * different_ + kFewTriangles) drop_repeated();
}

// Drops triangles that have the same corners in the same direction as another one. Those in the other direction stay:
// they are the other side of a sheet that is thinner than a cell.
void Clusters::drop_repeated() {
  std::sort(triangles_.begin(), triangles_.end());
  const auto end = std::unique(triangles_.begin(), triangles_.end());
  repeated_ += static_cast<std::uint64_t>(triangles_.end() - end);
  triangles_.erase(end, triangles_.end());
  different_ = triangles_.size();
}

void Clusters::list_front(const SurfacePiece& piece) {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> cells;
  for (const std::uint32_t v : piece.incomplete) {
    positions.push_back(positions_[v]);
    cells.push_back(cells_[v]);
  }
  positions_ = std::move(positions);
  cells_ = std::move(cells);
}

// The cells that have triangles, in the order in which the surface met them.
std::vector<std::uint32_t> Clusters::cells_with_triangles() const {
  std::vector<std::uint8_t> used(sums_.size(), 0);
  for (const Corners& triangle : triangles_) {
    for (const std::uint32_t cell : triangle) used[cell] = 1;
  }
  std::vector<std::uint32_t> cells;
  for (std::uint32_t cell = 0; cell < used.size(); ++cell) {
    if (used[cell] != 0) cells.push_back(cell);
  }
  return cells;
}

// Places the vertices, and measures their distances from the planes.
void Clusters::place(const std::vector<std::uint32_t>& cells, ClusteredSurface& surface) const {
  std::vector<double> errors(cells.size());
  surface.positions.resize(cells.size());
  executor_.for_each(static_cast<std::int64_t>(cells.size()), kClusterBlock, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    const CellSum& sum = sums_[cells[n]];
    const Vec3 place = grid_.within(sum.best());
    surface.positions[n] = grid_.middle(table_.keys()[cells[n]]) + place;
    errors[n] = std::max(evaluate(sum.planes, place), 0.0);
  });
  double squares = 0;
  double weight = 0;
  for (std::size_t n = 0; n < cells.size(); ++n) {
    squares += errors[n];
    weight += sums_[cells[n]].weight();
  }
  surface.rms = weight > 0 ? std::sqrt(squares / weight) : 0;
}

ClusteredSurface Clusters::finish() {
  drop_repeated();
  ClusteredSurface surface;
  surface.cells = sums_.size();
  surface.collapsed = collapsed_;
  surface.repeated = repeated_;
  const std::vector<std::uint32_t> cells = cells_with_triangles();
  place(cells, surface);
  std::vector<std::uint32_t> numbers(sums_.size());
  for (std::uint32_t n = 0; n < cells.size(); ++n) numbers[cells[n]] = n;
  surface.triangles = std::move(triangles_);
  for (Corners& triangle : surface.triangles) {
    for (std::uint32_t& corner : triangle) corner = numbers[corner];
  }
  return surface;
}

std::uint64_t Clusters::bytes() const {
  return table_.bytes() + sums_.capacity() * sizeof(CellSum) + triangles_.capacity() * sizeof(Corners);
}

void Clusters::serialize(StateWriter&) const { throw std::logic_error("a preview has no state"); }

void Clusters::serialize(StateReader&) { throw std::logic_error("a preview has no state"); }

}  // namespace isoweave
