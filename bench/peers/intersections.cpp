// Self-intersections of meshes beside those that CGAL's Polygon Mesh Processing finds with its exact predicates, and
// the time of both in one thread: of five runs, taken in turns, the shortest.
//   bench_intersections MESH...    ends with 1 when the pairs differ
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <exception>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "isoweave/measure.hpp"
#include "isoweave/mesh.hpp"

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Pairs = std::vector<std::array<std::uint64_t, 2>>;

// Faces get the numbers of the triangles.
Mesh to_cgal(const isoweave::TriangleMesh& from) {
  Mesh mesh;
  for (const auto& [x, y, z] : from.vertices) mesh.add_vertex({x, y, z});
  for (const auto& [a, b, c] : from.triangles) {
    if (mesh.add_face(Mesh::Vertex_index(a), Mesh::Vertex_index(b), Mesh::Vertex_index(c)) == Mesh::null_face()) {
      throw std::runtime_error("CGAL does not take the mesh: not manifold");
    }
  }
  return mesh;
}

// In the order of ours. CGAL pairs a triangle without area with itself; those are left out.
Pairs pairs_of_cgal(const Mesh& mesh) {
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> found;
  CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(found));
  Pairs pairs;
  for (const auto& [a, b] : found) {
    if (a != b) pairs.push_back({std::min(a.idx(), b.idx()), std::max(a.idx(), b.idx())});
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

Pairs pairs_of_isoweave(const isoweave::TriangleMesh& mesh) {
  return isoweave::count_self_intersections(mesh, std::numeric_limits<std::size_t>::max(), 1).first;
}

template <class Work>
double seconds(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

bool compare(const char* path) {
  const isoweave::TriangleMesh mesh = isoweave::read_mesh(path);
  const Mesh theirs = to_cgal(mesh);
  Pairs by_cgal;
  Pairs by_isoweave;
  double cgal = std::numeric_limits<double>::infinity();
  double isoweave = cgal;
  for (int round = 0; round < 5; ++round) {
    cgal = std::min(cgal, seconds([&] { by_cgal = pairs_of_cgal(theirs); }));
    isoweave = std::min(isoweave, seconds([&] { by_isoweave = pairs_of_isoweave(mesh); }));
  }
  std::printf("%s: %zu triangles; pairs: CGAL %zu, isoweave %zu, %s; seconds: %.3f, %.3f, ratio %.2f\n", path,
              mesh.triangles.size(), by_cgal.size(), by_isoweave.size(),
              by_cgal == by_isoweave ? "the same" : "NOT the same", cgal, isoweave, cgal / isoweave);
  return by_cgal == by_isoweave;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    bool same = true;
    for (int n = 1; n < argc; ++n) same = compare(argv[n]) && same;
    return same ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
