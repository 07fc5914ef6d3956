// A mesh in memory as a source of pieces.
#pragma once

#include <cstdint>
#include <vector>

#include "extract/surface_piece.hpp"
#include "isoweave/mesh.hpp"
#include "parallel/array.hpp"
#include "parallel/parallel.hpp"
#include "pipeline/piece_source.hpp"

namespace isoweave {

// Pieces of consecutive triangles of a mesh. So the triangles held while a piece is simplified stay few, and in the
// caches. Ids are positions in the mesh. Triangles that repeat a vertex are left out.
//
// A vertex is incomplete from the first of its triangles to the last. Where these lie far apart, as in a mesh whose
// triangles have been shuffled, pieces are made larger, up to the whole mesh.
class MeshSurface final : public PieceSource {
 public:
  struct Pieces {
    std::uint64_t triangles;  // of the smallest one; 1 at least where the mesh has any
    bool exactly = false;     // of each of them
  };

  // The mesh must outlive this source. Throws std::invalid_argument when a triangle refers to a vertex that the mesh
  // does not have, and OverMemory for a mesh of 2^32 triangles or more.
  MeshSurface(const TriangleMesh& mesh, const Executor& executor, const Pieces& pieces);

  bool complete() const override { return next_ == mesh_.triangles.size(); }

  // Sets the size of the next piece, where that is free.
  void read(const Held& held, MeshReport& report) override;

  // Fills `piece` with the next triangles: as many as wanted or more, as far as there are so many.
  void make(SurfacePiece& piece, MeshReport& report) override;

  // Triangles left out so far.
  std::uint64_t dropped() const { return dropped_; }

 private:
  void find_uses();
  std::uint64_t inherited_with(std::uint64_t piece) const;
  void add_new_vertices(std::uint64_t end, SurfacePiece& piece);
  void add_triangles(std::uint64_t end, SurfacePiece& piece);
  void list_incomplete(std::uint64_t end, SurfacePiece& piece);

  const TriangleMesh& mesh_;
  const Executor& executor_;
  Pieces pieces_;
  std::uint64_t wanted_ = 0;               // of the next piece
  std::uint64_t next_ = 0;                 // the first triangle of the next piece
  Array<std::uint32_t> first_, last_;      // per vertex: triangles; first > last where there are none
  Array<std::uint32_t> number_;            // per vertex: in the last piece that names it
  std::vector<std::uint32_t> vertices_;    // new in the present piece
  std::vector<std::uint32_t> incomplete_;  // after the present piece
  std::uint64_t dropped_ = 0;
};

// Mean area of the mesh's triangles, summed in blocks of fixed size in file order; 0 for an empty mesh. Throws
// std::invalid_argument when a triangle refers to a vertex that the mesh does not have.
double mean_triangle_area(const TriangleMesh& mesh, const Executor& executor);

}  // namespace isoweave
