#include "extract/marching_cubes.hpp"

#include "extract/cell_cases.hpp"
#include "extract/choose_diagonals.hpp"

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
  const CellRow cells = cell_row(at);
  cell_kernels_.write_triangles(cells, {piece.triangles.data() + first, count});
  shorten_diagonals(cells, first, piece);
}

// Gives the polygons of a row of cells, whose triangles begin with the `first`, their shortest diagonals.
void MarchingCubes::shorten_diagonals(const CellRow& cells, std::uint32_t first, SurfacePiece& piece) const {
  std::uint32_t* corners = piece.triangles[first].data();
  const auto shorten = [&](int, std::uint32_t cell) {
    shorten_diagonals_of(cell, corners, piece);
    corners += 3 * kCaseTable[cell].triangles;
  };
  for (std::size_t w = 0; w < cells.words; ++w) {
    if (cells.crossed[w] == 0) continue;
    for (const unsigned half : {0U, 1U}) for_cells(cells, w, half, shorten);
  }
}

void MarchingCubes::shorten_diagonals_of(std::uint32_t cell, std::uint32_t* corners, const SurfacePiece& piece) const {
  const auto place = [&](std::uint32_t number) -> const Vec3& { return place_of(number, piece); };
  for (std::size_t n = kChoicePolygons.first[cell]; n < kChoicePolygons.first[cell + 1]; ++n) {
    const ChoicePolygon& polygon = kChoicePolygons.polygons[n];
    const auto corner = [&](std::size_t at) -> std::uint32_t& { return corners[3U * polygon.first + at]; };
    choose_diagonals(polygon, corner, place);
  }
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
