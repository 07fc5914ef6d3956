// The part that extractors share whose vertices are crossings of lattice edges: marching cubes and tetrahedra.
//
// Crossings are bits. Every word of 64 lattice points has one word of crossings for each direction of edges. The number
// of a vertex is the number given to its word plus the crossings before it in the word. So every crossing is computed
// once, found by its lattice position, and numbered in lattice order.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "extract/cell_slab.hpp"
#include "extract/extractor.hpp"
#include "extract/gradient.hpp"
#include "extract/lattice_edges.hpp"
#include "extract/row_counts.hpp"
#include "extract/sample_view.hpp"
#include "extract/surface_piece.hpp"
#include "extract/vertex_places.hpp"
#include "lattice/vertex_numbering.hpp"
#include "parallel/parallel.hpp"

namespace isoweave {

struct ExtractOptions {
  IsoRule rule;
  bool normals = false;  // from central differences of the samples; needs one slice more on either side
  // The place of a volume that is a part of another one: its vertices have the places and ids that they have in the
  // whole. Where a border inside the whole has cells, no sample there may be inside.
  std::optional<PartOfLattice> part_of{};
  // The cells of the volume that have a surface; none: all. The samples around them are there for normals alone.
  std::optional<CellBox> cells{};

  CellBox cells_of(const VolumeInfo& volume) const {
    return cells.value_or(CellBox::of_volume(volume.dims, rule.closed));
  }

  const std::array<std::int64_t, 3>& whole(const VolumeInfo& volume) const {
    return part_of ? part_of->dims : volume.dims;
  }
};

template <class Edges>
class EdgeExtractor : public Extractor {
 public:
  VertexNumbering numbering() const override { return numbering_; }
  std::int64_t layers_left() const override { return slab_.layers_left(); }
  std::pair<std::int64_t, std::int64_t> slices_for(std::int64_t layers) const override;

  // Throws OverMemory when the slab holds 2^32 vertices or triangles, or more.
  SlabCounts extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                     SurfacePiece& piece) final;

  std::uint64_t inherited() const override { return front_size_; }
  void serialize(StateWriter& state) const override { slab_.serialize(state); }
  void serialize(StateReader& state) override;

 protected:
  // numbering: its first slots are those of Edges. Throws OverMemory for rows of more than kMostRowSamples.
  EdgeExtractor(const VolumeInfo& volume, const ExtractOptions& options, const VertexNumbering& numbering,
                const Executor& executor);

  // The crossings of the edges of some directions that begin in a slice or a layer.
  template <std::size_t kDirections>
  struct Crossings {
    std::array<std::vector<std::uint64_t>, kDirections> along;
    std::vector<std::uint32_t> base;  // per word: the number of its first crossing, direction by direction

    void resize(std::size_t words);
    std::uint32_t count(std::size_t word) const;
  };
  using OnSlice = Crossings<Edges::kOnSlice.size()>;
  using InLayer = Crossings<Edges::kInLayer.size()>;

  // A row of cells of the slab.
  struct Row {
    std::size_t n;       // layer
    std::size_t row;     // of the padded slice
    std::size_t number;  // of all rows of the slab
  };

  // Counts the triangles of the crossed cells of a row, and the vertices inside of them.
  virtual void count_cells(const SliceWindow& window, const Row& at, RowCounts& counts) const = 0;

  // Writes the triangles of a row of cells in lattice order, and the vertices inside of them.
  virtual void write_cells(const SliceWindow& window, const Row& at, SurfacePiece& piece) const = 0;

  // Whether write_cells() asks for the places of inherited vertices.
  virtual bool needs_places() const { return false; }

  const CellSlab& slab() const { return slab_; }
  const ExtractOptions& options() const { return options_; }
  const std::array<double, 3>& spacing() const { return spacing_; }
  const std::array<std::int64_t, 3>& first_sample() const { return first_; }  // of the volume, in the whole
  SampleType sample_type() const { return type_; }
  const OnSlice& on_slice(std::size_t n) const { return on_slices_[n]; }
  const InLayer& in_layer(std::size_t n) const { return in_layers_[n]; }
  const std::uint64_t* crossed(std::size_t number) const { return &crossed_[number * slab_.words()]; }

  // The triangles of a row: the first one, and how many there are.
  std::pair<std::uint32_t, std::uint32_t> triangles_of(std::size_t number) const {
    const std::uint32_t first = rows_[number].triangles;
    return {first, rows_[number + 1].triangles - first};
  }

  // The number of the first vertex inside the cells of a row.
  std::uint32_t first_inside(const Row& at) const;

  // The place in the piece of a vertex that is new in it.
  std::size_t index_of(std::uint32_t number) const { return number - front_size_; }

  VertexPlaces places(const SurfacePiece& piece) const {
    return {std::span(front_places_).first(front_size_), piece.positions.data()};
  }

 private:
  template <class T, std::uint8_t Direction>
  struct EdgeRow;
  struct Vertices;

  void resize(std::size_t layers);
  void find_on_slice(std::ptrdiff_t n, std::size_t row, OnSlice& slice) const;
  void find_in_layer(std::ptrdiff_t n, std::size_t row, InLayer& layer) const;
  std::uint32_t count_crossings(std::size_t n, std::size_t row) const;
  std::uint32_t crossings_on_border(std::size_t n, std::size_t row) const;
  void count_rows(const SliceWindow& window, std::size_t layers);
  void number_row(std::size_t n, std::size_t row, std::uint32_t base);
  template <class T>
  void emit_front(const SliceWindow& window);
  template <class T>
  void emit_vertices(const SliceWindow& window, std::size_t layers, SurfacePiece& piece);
  template <class T, auto kDirections>
  void emit_row(const SampleView<T>& samples, const Crossings<kDirections.size()>& crossings, std::size_t n,
                std::size_t row, const Vertices& out) const;
  template <class T, std::uint8_t Direction>
  EdgeRow<T, Direction> edges_of(const SampleView<T>& samples, std::size_t n, std::size_t row) const;
  template <class T, std::uint8_t Direction>
  void emit_word(const SampleView<T>& samples, const EdgeRow<T, Direction>& edges, std::size_t w,
                 std::uint64_t crossings, std::uint32_t number, const Vertices& out) const;
  void list_front(SurfacePiece& piece);
  template <class See>
  void number_front(const See& see);

  VertexNumbering numbering_;          // of the whole
  std::array<std::int64_t, 3> first_;  // sample in it
  SampleType type_;
  std::array<double, 3> spacing_;
  ExtractOptions options_;
  CellSlab slab_;
  std::vector<OnSlice> on_slices_;  // the first one is the front left by the slab before
  std::vector<InLayer> in_layers_;
  std::vector<std::uint64_t> crossed_;  // cells, row by row of the slab
  std::vector<RowCounts> rows_;         // one more follows the last row
  std::vector<Vec3> front_places_;
  std::uint32_t front_size_ = 0;
};

extern template class EdgeExtractor<CubeEdges>;
extern template class EdgeExtractor<KuhnEdges>;

}  // namespace isoweave
