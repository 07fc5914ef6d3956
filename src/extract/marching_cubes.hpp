// Marching cubes over slabs of layers (Lorensen and Cline, 1987; slabs and the front table as in the source paper).
#pragma once

#include "extract/cell_kernels.hpp"
#include "extract/edge_extractor.hpp"

namespace isoweave {

class MarchingCubes final : public EdgeExtractor<CubeEdges> {
 public:
  // Throws OverMemory for rows of more than kMostRowSamples.
  MarchingCubes(const VolumeInfo& volume, const ExtractOptions& options, const Executor& executor);

 private:
  void count_cells(const SliceWindow& window, const Row& at, RowCounts& counts) const override;
  void write_cells(const SliceWindow& window, const Row& at, SurfacePiece& piece) const override;
  CellRow cell_row(const Row& at) const;

  const CellKernels& cell_kernels_ = cell_kernels();
};

}  // namespace isoweave
