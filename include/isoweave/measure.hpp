// Measures of finished meshes: invariants, digest, distance. They use nothing but the triangles.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "isoweave/mesh.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// Angles of triangles in degrees. A triangle without area has angles of 0 and 180.
struct TriangleAngles {
  std::uint64_t triangles = 0;                                 // of which the rest tells
  double smallest = std::numeric_limits<double>::quiet_NaN();  // of all angles; not a number where there is no triangle
  double largest = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t under_5_degrees = 0;  // triangles with an angle below 5 degrees

  // Triangles by their smallest angle, in ten equal parts of [0, 60]. An angle between two parts is in the upper one.
  std::array<std::uint64_t, 10> smallest_in_bins{};
};

// The counts of a mesh. Degenerate triangles count as triangles and in the digest; all other counts leave them out,
// unless they say otherwise.
struct MeshCheck {
  std::uint64_t vertices = 0;  // referenced by a triangle
  std::uint64_t unused_vertices = 0;
  std::uint64_t triangles = 0;
  std::uint64_t degenerate_triangles = 0;  // with a repeated vertex
  std::uint64_t coincident_triangles = 0;  // of the others, with two corners at the same coordinates
  std::uint64_t zero_area_triangles = 0;   // of all, with an area of 0
  std::uint64_t open_edges = 0;            // with one triangle
  std::uint64_t nonmanifold_edges = 0;     // with three or more triangles
  std::uint64_t misoriented_edges = 0;     // with exactly two triangles, which run along it in the same direction
  std::uint64_t nonmanifold_vertices =
      0;                         // whose triangles form more than one fan (an end of a non-manifold edge counts)
  std::uint64_t components = 0;  // connected through shared vertices
  std::int64_t euler = 0;        // vertices - edges + triangles, without degenerate ones
  double area = 0;               // length squared
  double volume = 0;             // enclosed, signed: positive when triangles face outwards; meaningful when closed
  TriangleAngles angles;
  std::uint64_t digest = 0;
};

// Counts by sorting edges, in the calling thread. The offset of the mesh counts in the digest only.
// @throws std::invalid_argument when a triangle refers to a vertex that the mesh does not have
// @cost O(n log n) time, about 80 bytes per triangle.
// @determinism The same on every machine, but for the last digits of the smallest and the largest angle.
MeshCheck check_mesh(const TriangleMesh& mesh);

// Pairs of triangles of one mesh that have more points in common than they should. Triangles are closed sets: touching
// counts. Vertices are told apart by number: triangles whose corners only lie at the same place do not share them. A
// triangle without area (all its corners on one line) is in no pair.
struct SelfIntersections {
  std::uint64_t apart = 0;         // pairs without a common vertex that have a point in common
  std::uint64_t at_vertex = 0;     // pairs with one common vertex that have another point in common
  std::uint64_t at_edge = 0;       // pairs with two or three common vertices that overlap: folded flat, or one twice
  std::uint64_t triangles = 0;     // in at least one of these pairs
  std::uint64_t without_area = 0;  // triangles left out

  // The first pairs, by numbers in the mesh from 0: the smaller number of a pair first, pairs in rising order.
  std::vector<std::array<std::uint64_t, 2>> first;

  std::uint64_t pairs() const { return apart + at_vertex + at_edge; }
};

// Counts the pairs of triangles that intersect. Exact for any float32 coordinates: signs of determinants are evaluated
// in double with an error bound, and without rounding where that does not decide (Shewchuk 1997; triangles: Devillers,
// Guigue 2002). At most `listed` pairs are returned in `first`. threads: 0 for all.
// @throws std::invalid_argument for an index out of range, a coordinate that is not finite, and 2^32 triangles or more
// @cost About O(n log n) time on surfaces and 80 bytes per triangle, however many pairs there are.
// @determinism The same for any number of threads.
SelfIntersections count_self_intersections(const TriangleMesh& mesh, std::size_t listed = 10, int threads = 0);

// The digest of a triangle, a mix of its float32 coordinate bits that begins with its smallest corner. The digest of a
// mesh is the 64-bit sum over its triangles: equal for equal meshes whatever the order and numbering of their parts,
// and different (but for chance) when a coordinate or an orientation differs. -0 counts as 0.
std::uint64_t triangle_digest(const Point& a, const Point& b, const Point& c);

// The digest of a triangle whose corners are relative to the offset of a mesh: of the bits of the float64 sums, or,
// where the offset is 0, of the float32 coordinates.
std::uint64_t triangle_digest(const Point& a, const Point& b, const Point& c, const std::array<double, 3>& offset);

// A digest as 16 hexadecimal digits.
std::string digest_text(std::uint64_t digest);

struct DistanceOptions {
  std::uint64_t samples = 500000;  // on each mesh, uniform by area
  std::uint64_t seed = 1;
  int threads = 0;       // 0: all
  std::size_t bins = 0;  // of the histograms; 0: none are made. They take 8 bytes for each sample meanwhile
};

// Distances from one surface to another, in the meshes' unit: mean, root mean square and largest over the samples.
struct OneWayDistance {
  double mean = 0, rms = 0, max = 0;
  std::vector<std::uint64_t> histogram;  // samples in equal parts of [0, MeshDistance::max]; or none
};

struct MeshDistance {
  OneWayDistance a_to_b, b_to_a;
  double mean = 0, rms = 0, max = 0;  // both ways: mean of the means, root of the mean of the squares, larger maximum
};

// Compares two meshes both ways. Samples each mesh by area and finds exact point-to-triangle distances to the other
// through a bounding volume hierarchy. A mesh without area is sampled by triangle. Offsets are applied; units and
// spaces are not (match_place, mesh.hpp).
// @throws std::invalid_argument when a mesh has no triangles, an index out of range, a coordinate that is not finite or
//   2^32 triangles, and for 0 samples
// @cost Meshes with different offsets are copied. Histograms take 8 bytes per sample meanwhile.
// @determinism The same for any number of threads.
MeshDistance compare_meshes(const TriangleMesh& a, const TriangleMesh& b, const DistanceOptions& options = {});

// The distance of every vertex of a mesh to the nearest point of another, in the meshes' unit. Offsets are applied.
// threads: 0 for all.
// @throws std::invalid_argument as compare_meshes does
// @determinism The same for any number of threads.
std::vector<float> vertex_distances(const TriangleMesh& mesh, const TriangleMesh& to, int threads = 0);

}  // namespace isoweave
#pragma GCC visibility pop
