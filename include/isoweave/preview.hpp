// A quick look at a surface: vertex clustering (Rossignac and Borrel, 1993) with quadrics (Lindstrom, 2000).
//
// Space is cut into cubic cells of one size. The vertices of the full surface that lie in a cell become one vertex, at
// the place in that cell which is nearest to the planes of the triangles there. Triangles with corners in three cells
// stay, the others are gone. No triangle is held before it is known to stay, so a preview takes little more time than
// extraction, and memory for the cells that the surface passes through.
//
// A preview keeps neither topology nor manifoldness. Parts and tunnels smaller than a cell vanish, sheets that are
// thinner grow together, edges have one triangle or more than two; the report counts them. What holds is that no point
// of the preview is farther than the diagonal of a cell from the full surface. Points of the full surface may be
// farther from the preview. mesh_volume and simplify_mesh make meshes that are fit for more than a look.
#pragma once

#include "isoweave/mesh.hpp"
#include "isoweave/mesh_options.hpp"
#include "isoweave/report.hpp"
#include "isoweave/run.hpp"
#include "isoweave/volume.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

struct PreviewOptions : SurfaceOptions {
  // The side of a cell. 0: two voxels, or a 256th of the longest side of the volume or mesh, whichever is more.
  Length cell{};
  OutputSpace space = OutputSpace::kAsVolume;
};

// Makes the preview of a volume's surface, and finishes the sink. In the report `preview` has the size of the cells and
// the error; defects and components are those that check_mesh finds. `error`, and what belongs to simplification, is 0.
// @pre The volume has not been read. No other object reads it or writes to the sink meanwhile.
// @throws BadInput, CannotWrite from the source and the sink; BadInput also when the volume's file has another size or
//   time of change in the end than in the beginning
// @throws std::invalid_argument for options out of range, a cell so small that more than 2^19 lie along the longest
//   side, and for options of runs that simplify: components to be dropped, a device, an observer, a memory cap, states
// @throws OverMemory at 2^32 - 1 occupied cells; Interrupted; EmptySurface where the control says so, also when every
//   triangle is smaller than the cells
// @cost About the time of mesh_volume with an error of 0. Memory: a slab, about 130 bytes for each occupied cell, and
//   12 to 48 for each triangle of the result; with RunControl::measure 80 more for each triangle in the end.
// @determinism The mesh does not depend on threads and slabs, and neither does the order of vertices and triangles.
MeshReport preview_volume(SliceSource& volume, MeshSink& sink, const PreviewOptions& options,
                          const RunControl& control = {});

// Makes the preview of a mesh, which need not be a manifold. Triangles that repeat a vertex are left out with a
// warning. Normals and values are not kept.
// @throws std::invalid_argument for a cell out of range, a triangle that refers to a vertex that the mesh does not
//   have, a coordinate that is not finite, and for options as preview_volume, a volume's among them
// @throws OverMemory for a mesh of 2^32 triangles or more; CannotWrite; Interrupted; EmptySurface as preview_volume
// @cost Memory beside the mesh as preview_volume.
// @determinism As preview_volume, and whatever the pieces.
MeshReport preview_mesh(const TriangleMesh& mesh, MeshSink& sink, const Length& cell = {},
                        const RunControl& control = {});

}  // namespace isoweave
#pragma GCC visibility pop
