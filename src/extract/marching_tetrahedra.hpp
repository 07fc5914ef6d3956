// Marching tetrahedra over slabs of layers (Doi and Koide, 1991): each cube of the lattice is cut into six tetrahedra
// around its diagonal (Kuhn, 1960). The cut is the same in every cube, so shifting a volume shifts its surface.
#pragma once

#include "extract/edge_extractor.hpp"

namespace isoweave {

class MarchingTetrahedra final : public EdgeExtractor<KuhnEdges> {
 public:
  // Throws OverMemory for rows of more than kMostRowSamples.
  MarchingTetrahedra(const VolumeInfo& volume, const ExtractOptions& options, const Executor& executor);

 private:
  void count_cells(const SliceWindow& window, const Row& at, RowCounts& counts) const override;
  void write_cells(const SliceWindow& window, const Row& at, SurfacePiece& piece) const override;

  // A row of lattice edges that a row of cells touches: its crossings, and the number of the first one of each word.
  struct EdgeWords {
    const std::uint64_t* crossings = nullptr;
    std::array<const std::uint64_t*, 3> before{};  // crossings of other directions that are numbered first
    const std::uint32_t* base = nullptr;

    std::uint32_t first(std::size_t w) const;
  };
  std::vector<EdgeWords> edge_words(const Row& at) const;
  template <class Found>
  static EdgeWords words_of(const Found& crossings, std::size_t direction, std::size_t word);
};

}  // namespace isoweave
