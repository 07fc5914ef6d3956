#include "extract/marching_cubes.hpp"

#include <bit>

#include "extract/polygon_lists.hpp"

namespace isoweave {

MarchingCubes::MarchingCubes(const VolumeInfo& volume, const ExtractOptions& options, const Executor& executor)
    : MarchingCubes(volume, options, VertexNumbering::of_cube_edges(options.whole(volume)), executor) {}

MarchingCubes::MarchingCubes(const VolumeInfo& volume, const ExtractOptions& options, const VertexNumbering& numbering,
                             const Executor& executor)
    : EdgeExtractor(volume, options, numbering, executor) {}

void MarchingCubes::count_cells(const SliceWindow&, const Row& at, RowCounts& counts) const {
  counts.triangles = cell_kernels_.count_triangles(cell_row(at));
}

void MarchingCubes::write_cells(const SliceWindow&, const Row& at, SurfacePiece& piece) const {
  const auto [first, count] = triangles_of(at.number);
  const CellRow row = cell_row(at);
  std::span<std::array<std::uint32_t, 3>> left(piece.triangles.data() + first, count);
  PolygonLists polygons(places(piece));
  for (std::size_t w = 0; w < row.words; ++w) {
    if (row.crossed[w] == 0) continue;
    std::array<std::uint8_t, 64> cases;
    cell_kernels_.write_triangles(row, w, left, cases);
    const auto cells = static_cast<std::size_t>(std::popcount(row.crossed[w]));
    for (const std::uint8_t cell : std::span(cases).first(cells)) {
      polygons.add(cell, left.data()->data());
      left = left.subspan(kCaseTable[cell].triangles);
    }
    polygons.make_room();
  }
  polygons.choose();
}

CellRow MarchingCubes::cell_row(const Row& at) const {
  const std::size_t words = slab().words();
  CellRow cells{};
  cells.words = words;
  cells.crossed = crossed(at.number);
  cells.inside = slab().rows_around(static_cast<std::ptrdiff_t>(at.n), at.row);
  for (std::size_t dz = 0; dz < 2; ++dz) {
    const OnSlice& slice = on_slice(at.n + dz);
    for (std::size_t dy = 0; dy < 2; ++dy) {
      cells.crossings[edge_row(0, dy, dz)] = &slice.along[0][(at.row + dy) * words];
      cells.x_base[edge_row(0, dy, dz)] = &slice.base[(at.row + dy) * words];
    }
    cells.crossings[edge_row(1, 0, dz)] = &slice.along[1][at.row * words];
  }
  for (std::size_t dy = 0; dy < 2; ++dy) {
    cells.crossings[edge_row(2, dy, 0)] = &in_layer(at.n).along[0][(at.row + dy) * words];
    cells.z_base[dy] = &in_layer(at.n).base[(at.row + dy) * words];
  }
  return cells;
}

}  // namespace isoweave
