// Marching cubes over slabs of layers (Lorensen and Cline, 1987; slabs and the front table as in the source paper).
//
// Crossings are bits. Every row of 64 lattice points has one word of inside bits and one word of crossings per axis.
// The number of a vertex is the number given to its word plus the crossings before it in the word. So every crossing is
// computed once, found by its lattice position, and numbered in lattice order.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "extract/cell_kernels.hpp"
#include "extract/cube_rules.hpp"
#include "extract/extractor.hpp"
#include "extract/row_counts.hpp"
#include "extract/row_kernels.hpp"
#include "extract/sample_view.hpp"
#include "extract/surface_piece.hpp"
#include "lattice/vertex_numbering.hpp"
#include "parallel/parallel.hpp"
#include "volume/slice_window.hpp"

namespace isoweave {

struct ExtractOptions {
  IsoRule rule;
  bool normals = false;  // from central differences of the samples; needs one slice more on either side
  // The place of a volume that is a part of another one: its vertices have the places and ids that they have in the
  // whole. There is no surface at a border inside the whole, so no sample there may be inside.
  std::optional<PartOfLattice> part_of{};
};

class MarchingCubes final : public Extractor {
 public:
  // Throws OverMemory for rows of more than kMostRowSamples.
  MarchingCubes(const VolumeInfo& volume, const ExtractOptions& options, const Executor& executor);

  // The first layer is -1, in the pad, and empty in open mode.
  VertexNumbering numbering() const override { return numbering_; }
  std::int64_t layers_left() const override { return end_layer_ - next_layer_; }
  std::pair<std::int64_t, std::int64_t> slices_for(std::int64_t layers) const override;

  // Throws OverMemory when the slab holds 2^32 vertices or triangles, or more.
  SlabCounts extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                     SurfacePiece& piece) override;

  std::uint64_t inherited() const override { return front_size_; }
  void serialize(StateWriter& state) const override;
  void serialize(StateReader& state) override;

 private:
  // Bits and vertex numbers of one slice; one entry per word, row by row.
  struct Slice {
    std::vector<std::uint64_t> inside, cross_x, cross_y;
    std::vector<std::uint32_t> base;  // number of the word's first x-crossing; y-crossings follow
  };
  // The bits and vertex numbers between two slices.
  struct Layer {
    std::vector<std::uint64_t> cross_z;
    std::vector<std::uint64_t> crossed;  // cells that the surface crosses, not only along z
    std::vector<std::uint32_t> base;
  };

  template <class T, int Axis>
  struct EdgeRow;

  void classify(const SliceWindow& window, std::int64_t k, std::size_t row, Slice& slice) const;
  void find_on_slice(std::size_t row, Slice& slice) const;
  std::uint32_t find_crossings(std::size_t n, std::size_t row);
  std::uint32_t crossings_on_border(std::size_t n, std::size_t row) const;
  void count_rows(std::size_t layers);
  std::size_t layers_within(std::size_t layers, std::uint64_t most_vertices) const;
  void make_room(std::size_t layers, SurfacePiece& piece);
  void number_row(std::size_t n, std::size_t row, std::uint32_t base);
  template <class T>
  void emit_vertices(const SliceWindow& window, std::size_t layers, SurfacePiece& piece);
  template <class T, int Axis>
  void emit_word(const SampleView<T>& samples, const EdgeRow<T, Axis>& edges, std::size_t w, std::uint64_t crossings,
                 std::uint64_t inside, std::uint32_t number, SurfacePiece& piece) const;
  void emit_triangles(std::size_t layers, SurfacePiece& piece) const;
  void list_front(SurfacePiece& piece);
  template <class See>
  void number_front(const See& see);
  bool has_cells(std::int64_t k, std::size_t row) const;
  template <class Visit>
  void for_rows(std::size_t layers, const Visit& visit) const;
  std::array<const std::uint64_t*, 4> rows_around(std::size_t n, std::size_t row) const;
  void find_cells(std::size_t n, std::size_t row, RowCounts& counts);
  CellRow cell_row(std::size_t n, std::size_t row) const;

  std::array<std::int64_t, 3> dims_;
  VertexNumbering numbering_;          // of the whole
  std::array<std::int64_t, 3> first_;  // sample in it
  SampleType type_;
  std::array<double, 3> spacing_;
  ExtractOptions options_;
  const Executor& executor_;
  const RowKernels& kernels_ = row_kernels();
  const CellKernels& cell_kernels_ = cell_kernels();
  std::size_t rows_;                                  // padded rows of a slice
  std::size_t words_;                                 // words of a padded row
  std::vector<std::uint64_t> edge_mask_, cell_mask_;  // per word: x-edges and cells that exist
  std::int64_t next_layer_ = -1;
  std::int64_t end_layer_;
  std::vector<Slice> slices_;  // slices_[0] is the front left by the slab before
  std::vector<Layer> layers_;
  std::vector<RowCounts> rows_of_slab_;  // one more follows the last row
  std::vector<std::uint64_t> end_mask_;  // per word: the first and the last sample of a row
  std::uint32_t front_size_ = 0;
};

}  // namespace isoweave
