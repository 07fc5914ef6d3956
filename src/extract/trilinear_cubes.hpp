// Marching cubes with the topology of the trilinear interpolant. Cells that leave no choice are those of marching
// cubes; the others follow their samples (trilinear_rules.hpp).
#pragma once

#include "extract/marching_cubes.hpp"

namespace isoweave {

class TrilinearCubes final : public MarchingCubes {
 public:
  // Throws OverMemory for rows of more than kMostRowSamples.
  TrilinearCubes(const VolumeInfo& volume, const ExtractOptions& options, const Executor& executor);

 private:
  void count_cells(const SliceWindow& window, const Row& at, RowCounts& counts) const override;
  void write_cells(const SliceWindow& window, const Row& at, SurfacePiece& piece) const override;

  template <class T>
  class RowWriter;

  bool has_choices(const CellRow& cells) const;
  template <class T>
  void count_choices(const SliceWindow& window, const Row& at, RowCounts& counts) const;
  template <class T>
  void write_row(const SliceWindow& window, const Row& at, SurfacePiece& piece) const;
};

}  // namespace isoweave
