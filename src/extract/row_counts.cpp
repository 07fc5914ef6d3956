#include "extract/row_counts.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "isoweave/error.hpp"
#include "parallel/size.hpp"

namespace isoweave {
namespace {

// Replaces a count by the sum of those before it.
void scan_one(std::uint32_t& count, std::uint64_t& sum) {
  const std::uint32_t own = count;
  count = static_cast<std::uint32_t>(sum);
  sum += own;
}

}  // namespace

void require_numbers(std::size_t layers, std::uint64_t count, const char* what) {
  if (count <= std::numeric_limits<std::uint32_t>::max()) return;
  throw OverMemory("a slab of " + std::to_string(layers) + " layers holds " + std::to_string(count) + " " + what +
                   ", expected fewer than 2^32: choose thinner slabs");
}

std::size_t layers_within(std::span<const RowCounts> rows, std::size_t rows_of_layer, std::uint64_t most_vertices) {
  std::uint64_t sum = 0;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    sum += rows[row].vertices;
    if (sum > most_vertices) return std::max<std::size_t>(row / rows_of_layer, 1);
  }
  return rows.size() / rows_of_layer;
}

RowSums place_rows(std::span<RowCounts> rows, std::size_t layers, std::uint32_t inherited) {
  RowSums sums;
  for (RowCounts& row : rows) {
    sums.cells += row.cells;
    sums.on_border += row.on_border;
    scan_one(row.vertices, sums.vertices);
    scan_one(row.triangles, sums.triangles);
  }
  require_numbers(layers, sums.vertices + inherited, "vertices");
  require_numbers(layers, sums.triangles, "triangles");
  return sums;
}

void make_room(std::vector<RowCounts>& rows, std::size_t layers, bool normals, SurfacePiece& piece) {
  rows.emplace_back();
  const RowSums sums = place_rows(rows, layers, piece.inherited);
  piece.cells_crossed = sums.cells;
  piece.open_edges = sums.on_border;
  piece.positions.resize(to_size(sums.vertices));
  piece.ids.resize(to_size(sums.vertices));
  piece.normals.resize(normals ? to_size(sums.vertices) : 0);
  piece.triangles.resize(to_size(sums.triangles));
}

}  // namespace isoweave
