// The first of two passes that drop components. The size of a component is known in the end only, when its triangles
// have left memory. So this pass notes seeds: vertices by which the second pass, whatever its slabs, knows a component
// again.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "extract/piece_stage.hpp"
#include "isoweave/components.hpp"
#include "lattice/vertex_numbering.hpp"
#include "parallel/array.hpp"
#include "parallel/parallel.hpp"

namespace isoweave {

// The vertices of a surface are in the order in which they are extracted, layer by layer: the same order for all slabs.
// A seed is the first vertex of a connected part of one layer's surface, if that vertex is not on the slice below. So
// the first vertex of a connected part of a slab, of any thickness, is a seed or lies on the slice below the slab.
//
// An edge between two vertices of a slice lies in a face of a cell below the slice and of a cell above it. So the layer
// below tells which vertices of a slice are connected. The first slice of an open volume has no layer below: each of
// its vertices is a seed.
class ComponentFinder final : public PieceStage {
 public:
  ComponentFinder(const VertexNumbering& numbering, const Executor& executor)
      : numbering_(numbering), executor_(executor) {}

  // Looks at the next piece, of one layer or more. Throws OverMemory at 2^32 seeds.
  void apply(SurfacePiece& piece) override;

  // The choice that the rule makes, once the surface is complete. The result is the same for any pieces and any number
  // of threads. Must be called once only.
  ComponentChoice choose(const ComponentRule& rule);

  std::uint64_t bytes() const override;

  // Throw std::logic_error: no state is saved of this short pass, and a resumed run makes it anew.
  void serialize(StateWriter& state) const override;
  void serialize(StateReader& state) override;

 private:
  // The vertices and triangles of a piece up to the end of a layer.
  struct LayerEnd {
    std::uint32_t vertex;
    std::size_t triangle;
  };

  void begin(const SurfacePiece& piece);
  LayerEnd end_of_layer(const SurfacePiece& piece, std::uint32_t first_vertex) const;
  void join_triangles(const SurfacePiece& piece, std::size_t first, std::size_t end);
  void add_seeds(const SurfacePiece& piece, std::uint32_t first, std::uint32_t end);
  void join_seeds(std::uint32_t inherited);
  void count_triangles(const SurfacePiece& piece);
  void list_front(const SurfacePiece& piece);
  void sum_up();

  const VertexNumbering numbering_;
  const Executor& executor_;

  // The seeds of the whole surface, in the order of the vertices.
  std::vector<std::uint64_t> seeds_;           // ids
  std::vector<std::uint32_t> seed_parents_;    // which of them are of one component
  std::vector<std::uint64_t> seed_triangles_;  // that were found beside them

  // The vertices of the piece.
  Array<std::uint32_t> parents_;          // sets of connected vertices
  Array<std::uint32_t> labels_;           // of vertices that are roots, or were: a seed of the component
  std::vector<std::uint32_t> new_roots_;  // vertices whose seeds came with the piece
  std::vector<std::uint32_t> found_;      // those of the layer

  std::vector<std::uint32_t> front_;  // labels of the vertices that the next piece inherits
};

}  // namespace isoweave
