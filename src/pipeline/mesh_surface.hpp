// A mesh file as one more source of a surface.
#pragma once

#include "extract/surface_piece.hpp"
#include "isoweave/mesh.hpp"
#include "parallel/parallel.hpp"

namespace isoweave {

// The whole mesh as one piece: ids are positions in the file, triangles keep their order. Triangles that repeat a
// vertex are left out; `dropped` counts them.
void make_piece(const TriangleMesh& mesh, const Executor& executor, SurfacePiece& piece, std::uint64_t& dropped);

// Mean area of the mesh's triangles, summed in blocks of fixed size in file order; 0 for an empty mesh.
double mean_triangle_area(const TriangleMesh& mesh, const Executor& executor);

}  // namespace isoweave
