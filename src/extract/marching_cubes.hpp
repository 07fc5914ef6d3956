// Marching cubes over slabs of layers (Lorensen and Cline, 1987; slabs and the front table as in the source paper).
// Polygons of more than three corners get the shortest diagonals.
#pragma once

#include "extract/cell_kernels.hpp"
#include "extract/edge_extractor.hpp"

namespace isoweave {

class MarchingCubes : public EdgeExtractor<CubeEdges> {
 public:
  // Throws OverMemory for rows of more than kMostRowSamples.
  MarchingCubes(const VolumeInfo& volume, const ExtractOptions& options, const Executor& executor);

 protected:
  MarchingCubes(const VolumeInfo& volume, const ExtractOptions& options, const VertexNumbering& numbering,
                const Executor& executor);

  void count_cells(const SliceWindow& window, const Row& at, RowCounts& counts) const override;
  void write_cells(const SliceWindow& window, const Row& at, SurfacePiece& piece) const override;

  bool needs_places() const override { return true; }

  // A row of cells and the rows around it. Its numbers are valid once vertices have been emitted.
  CellRow cell_row(const Row& at) const;

 private:
  const CellKernels& cell_kernels_ = cell_kernels();
};

}  // namespace isoweave
