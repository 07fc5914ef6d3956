// The options of the mesh of a volume: which surface, how it is simplified, what its vertices carry, and its
// coordinates.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "isoweave/components.hpp"
#include "isoweave/simplify_options.hpp"
#include "isoweave/volume.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// How a surface is made from the samples. All four are closed, oriented manifolds, but for the border of an open
// volume.
enum class ExtractorKind : std::uint8_t {
  // Marching cubes (Lorensen and Cline, 1987): a vertex where the surface crosses an edge of the lattice; on a face
  // where
  // the samples leave a choice, inside corners are kept apart.
  kCubes,
  // Marching cubes with the topology of the trilinear interpolant: faces by the asymptotic decider (Nielson and Hamann,
  // 1991), tunnels through cells (Chernyaev, 1995). Elsewhere it is kCubes.
  kTrilinear,
  // Marching tetrahedra (Doi and Koide, 1991), six in a cube (Kuhn, 1960): no choices, and three times the triangles.
  kTetrahedra,
  // Dual marching cubes (Nielson, 2004): a vertex inside the cell for each polygon of kCubes, where it meets the
  // tangent
  // planes best. Sharp edges are kept.
  kDual
};

// The surface of a volume.
struct SurfaceOptions {
  double iso = 0;            // a value: slope and intercept of the volume are accounted for
  bool inside_above = true;  // inside is value >= iso; else value <= iso. NaN is outside
  bool closed = true;        // caps at the volume's border; else the surface ends there
  // Passes of smooth_mask, 0 to 64: the surface of a mask or label map without its staircase. 0: the surface of the
  // samples. No vertex leaves its edge of the lattice. min, max and nan of the report are those of the samples.
  int smooth = 0;
  ExtractorKind extractor = ExtractorKind::kCubes;  // a device has kCubes only
  // The components that are kept, found by choose_components in this volume with the same `iso`, `inside_above`,
  // `closed` and `extractor`; null: all. The result is the mesh of a surface that never had the others: errors, numbers
  // of triangles and distances refer to the kept components. Costs a second union-find over the triangles of each slab.
  // Not on a device.
  std::shared_ptr<const ComponentChoice> components{};
};

// Normals of the vertices: none; gradients of the samples, which merge as vertices do; or gradients that the
// simplification keeps as well. In the last case an edge collapses where the error of position and normal is least, and
// only while that is within the error (Hoppe, 1999). A difference of length 1 between two unit normals counts as an
// error of half a mean voxel.
enum class Normals : std::uint8_t { kAbsent, kGradient, kQuadric };

// The attributes that vertices carry beside their places.
struct AttributeOptions {
  Normals normals = Normals::kAbsent;  // unit length, outwards; zero where there is no direction
  // Another volume of as many samples, whose values the vertices get. Values are interpolated where a vertex is
  // extracted, and along the edge when it collapses. Slope and intercept are applied. The volume is read during the
  // run, and must not be the source of the run.
  std::shared_ptr<SliceSource> values{};
};

// The coordinates of the output: the volume's own world, a named convention (x and y change sign between the two), or
// index * spacing, without origin and direction.
enum class OutputSpace : std::uint8_t { kAsVolume, kLps, kRas, kIndex };

// The name of the space of the coordinates of a volume's mesh, for MeshFileOptions::space: "LPS", "RAS", "index", or
// nothing where the volume does not say.
std::string space_of_mesh(const Geometry& volume, OutputSpace space);

// The offset for a sink that gets a mesh of this volume (MeshFileOptions::offset, MeshInMemory). It is 0 unless the
// volume lies so far from the origin that rounding to 32 bits would move vertices by more than a thousandth of the
// smallest spacing. Then it is the place of the first sample, so that coordinates are those of the same volume at the
// origin.
std::array<double, 3> mesh_offset(const VolumeInfo& volume, OutputSpace space);

// The place in the output of a point of the volume, by its indices i, j, k. They count samples, from 0, and need not be
// whole or inside the volume. For what a program shows beside a mesh: the box of the volume, its slices. Relative to no
// offset.
std::array<double, 3> output_place(const VolumeInfo& volume, OutputSpace space, const std::array<double, 3>& index);

// Everything that the mesh of a volume depends on.
struct MeshOptions : SurfaceOptions, SimplifyOptions, AttributeOptions {
  OutputSpace space = OutputSpace::kAsVolume;
};

// The options of the same surface, not simplified and without attributes.
MeshOptions full_surface(const SurfaceOptions& surface);

}  // namespace isoweave
#pragma GCC visibility pop
