#include "simplify/piece_order.hpp"

#include <numeric>

#include "simplify/columns.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kPieceBlock = 4096;

}  // namespace

void PieceOrder::sort(const SurfacePiece& piece, const ZoneView& zone, std::span<const Index> front,
                      const Executor& executor) {
  find_columns(piece, zone, front, executor);
  number_vertices(piece, executor);
  move_triangles(piece, executor);
}

void PieceOrder::find_columns(const SurfacePiece& piece, const ZoneView& zone, std::span<const Index> front,
                              const Executor& executor) {
  const Columns column(zone.options.a0);
  const auto position = [&](std::size_t n) {
    return n < front.size() ? zone.vertices[front[n]].position : piece.positions[n - front.size()];
  };
  columns_.resize(front.size() + piece.positions.size());
  executor.for_each(static_cast<std::int64_t>(columns_.size()), kPieceBlock, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    columns_[n] = static_cast<std::uint16_t>(column(position(n)));
  });
}

void PieceOrder::number_vertices(const SurfacePiece& piece, const Executor& executor) {
  fill_buckets(
      executor, static_cast<std::uint32_t>(piece.positions.size()), Columns::kCount,
      [&](std::uint32_t n) { return std::size_t{columns_[piece.inherited + n]}; }, new_vertices_);
  numbers_.resize(columns_.size());
  std::iota(numbers_.begin(), numbers_.begin() + piece.inherited, 0);
  executor.for_each(static_cast<std::int64_t>(piece.positions.size()), kPieceBlock, [&](std::int64_t i) {
    const auto n = static_cast<std::uint32_t>(i);
    numbers_[piece.inherited + new_vertices_.items[n]] = piece.inherited + n;
  });
}

void PieceOrder::move_triangles(const SurfacePiece& piece, const Executor& executor) {
  fill_buckets(
      executor, static_cast<std::uint32_t>(piece.triangles.size()), Columns::kCount,
      [&](std::uint32_t n) { return std::size_t{columns_[piece.triangles[n][0]]}; }, by_column_);
  triangles_.resize(piece.triangles.size());
  executor.for_each(static_cast<std::int64_t>(piece.triangles.size()), kPieceBlock, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    const auto& corners = piece.triangles[by_column_.items[n]];
    for (std::size_t c = 0; c < 3; ++c) triangles_[n][c] = numbers_[corners[c]];
  });
}

std::uint64_t PieceOrder::bytes() const {
  return columns_.capacity() * sizeof(columns_[0]) + triangles_.capacity() * sizeof(triangles_[0]) +
         (new_vertices_.items.capacity() + by_column_.items.capacity() + numbers_.capacity()) * sizeof(std::uint32_t);
}

}  // namespace isoweave
