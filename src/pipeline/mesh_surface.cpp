#include "pipeline/mesh_surface.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "isoweave/error.hpp"
#include "lattice/triangles.hpp"
#include "parallel/collect.hpp"
#include "parallel/vertex_owners.hpp"
#include "pipeline/run_report.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kSurfaceBlock = 4096;
constexpr std::uint32_t kNoTriangle = 0xffffffffu;
constexpr std::uint64_t kInheritedPart = 4;  // one vertex in so many may be incomplete between two pieces

Vec3 position_of(const Point& p) { return {p[0], p[1], p[2]}; }

bool repeats_a_vertex(const std::array<std::uint32_t, 3>& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

// Twice the sum of the areas.
double sum_areas(const TriangleMesh& mesh, std::int64_t begin, std::int64_t end) {
  double sum = 0;
  for (std::int64_t n = begin; n < end; ++n) {
    const auto& t = mesh.triangles[static_cast<std::size_t>(n)];
    measure::require_in_range(t, mesh.vertices.size());
    const Vec3 a = position_of(mesh.vertices[t[0]]);
    const Vec3 normal = cross(position_of(mesh.vertices[t[1]]) - a, position_of(mesh.vertices[t[2]]) - a);
    sum += std::sqrt(dot(normal, normal));
  }
  return sum;
}

}  // namespace

MeshSurface::MeshSurface(const TriangleMesh& mesh, const Executor& executor, const Pieces& pieces)
    : mesh_(mesh), executor_(executor), pieces_(pieces) {
  if (mesh.triangles.size() > kNoTriangle) {
    throw OverMemory("the mesh has " + std::to_string(mesh.triangles.size()) + " triangles, expected fewer than 2^32");
  }
  find_uses();
  if (pieces_.exactly) return;
  while (inherited_with(pieces_.triangles) > mesh.vertices.size() / kInheritedPart) pieces_.triangles *= 2;
}

// Finds the first and the last triangle of every vertex.
void MeshSurface::find_uses() {
  const VertexOwners owners(executor_, mesh_.triangles);
  if (!mesh_.triangles.empty() && owners.largest_vertex() >= mesh_.vertices.size()) measure::refuse_index();
  first_.resize(mesh_.vertices.size());
  last_.resize(mesh_.vertices.size());
  number_.resize(mesh_.vertices.size());
  owners.for_parts(mesh_.vertices.size(), [&](const VertexOwners::Part& part) {
    std::fill_n(first_.data() + part.first, part.size, kNoTriangle);
    std::fill_n(last_.data() + part.first, part.size, 0);
    part.each_triangle([&](std::size_t n) {
      const auto& triangle = mesh_.triangles[n];
      if (repeats_a_vertex(triangle)) return;
      const auto t = static_cast<std::uint32_t>(n);
      for (const std::uint32_t v : triangle) {
        if (!part.has(v)) continue;
        first_[v] = std::min(first_[v], t);
        last_[v] = t;
      }
    });
  });
}

// The number of vertices, over all pieces, that pieces of so many triangles would inherit.
std::uint64_t MeshSurface::inherited_with(std::uint64_t piece) const {
  std::atomic<std::uint64_t> sum{0};
  executor_.for_blocks(static_cast<std::int64_t>(mesh_.vertices.size()), kSurfaceBlock,
                       [&](std::int64_t begin, std::int64_t end) {
                         std::uint64_t own = 0;
                         for (auto v = static_cast<std::size_t>(begin); v < static_cast<std::size_t>(end); ++v) {
                           if (first_[v] != kNoTriangle) own += last_[v] / piece - first_[v] / piece;
                         }
                         sum.fetch_add(own, std::memory_order_relaxed);
                       });
  return sum;
}

// Chooses the size of the next piece. Every piece costs passes over all triangles held, so it should bring half as
// many: more would take memory, and save little time.
void MeshSurface::read(const Held& held, MeshReport&) { wanted_ = held.triangles / 2; }

void MeshSurface::make(SurfacePiece& piece, MeshReport& report) {
  Stopwatch clock;
  piece.clear();
  piece.inherited = static_cast<std::uint32_t>(incomplete_.size());
  piece.manifold = false;
  const std::uint64_t triangles = pieces_.exactly ? pieces_.triangles : std::max(pieces_.triangles, wanted_);
  const std::uint64_t end = next_ + std::min(triangles, mesh_.triangles.size() - next_);
  add_new_vertices(end, piece);
  add_triangles(end, piece);
  list_incomplete(end, piece);
  report.triangles_extracted += end - next_;
  next_ = end;
  if (complete()) report.vertices_extracted = mesh_.vertices.size();
  clock.lap(report.seconds_extract);
}

// Adds the new vertices in the order in which triangles name them.
void MeshSurface::add_new_vertices(std::uint64_t end, SurfacePiece& piece) {
  collect(
      executor_, static_cast<std::int64_t>(end - next_), kSurfaceBlock,
      [&](std::int64_t from, std::int64_t to, std::vector<std::uint32_t>& list) {
        for (std::uint64_t t = next_ + static_cast<std::uint64_t>(from); t < next_ + static_cast<std::uint64_t>(to);
             ++t) {
          for (const std::uint32_t v : mesh_.triangles[t]) {
            if (first_[v] == t) list.push_back(v);
          }
        }
      },
      vertices_);
  piece.positions.resize(vertices_.size());
  piece.ids.resize(vertices_.size());
  piece.values.resize(mesh_.values.empty() ? 0 : vertices_.size());
  executor_.for_each(static_cast<std::int64_t>(vertices_.size()), kSurfaceBlock, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    const std::uint32_t v = vertices_[n];
    piece.positions[n] = position_of(mesh_.vertices[v]);
    piece.ids[n] = v;
    if (!mesh_.values.empty()) piece.values[n] = mesh_.values[v];
    number_[v] = piece.inherited + static_cast<std::uint32_t>(n);
  });
}

void MeshSurface::add_triangles(std::uint64_t end, SurfacePiece& piece) {
  piece.triangles.resize(end - next_);
  std::atomic<bool> any_repeats{false};
  executor_.for_each(static_cast<std::int64_t>(end - next_), kSurfaceBlock, [&](std::int64_t n) {
    const auto& triangle = mesh_.triangles[next_ + static_cast<std::uint64_t>(n)];
    const bool repeats = repeats_a_vertex(triangle);
    for (std::size_t c = 0; c < 3; ++c) {
      piece.triangles[static_cast<std::size_t>(n)][c] = repeats ? 0 : number_[triangle[c]];
    }
    if (repeats) any_repeats.store(true, std::memory_order_relaxed);
  });
  if (!any_repeats) return;
  const auto kept = std::remove_if(piece.triangles.begin(), piece.triangles.end(), repeats_a_vertex);
  const auto repeats = static_cast<std::uint64_t>(piece.triangles.end() - kept);
  piece.triangles.resize(piece.triangles.size() - repeats);
  dropped_ += repeats;
}

// Lists the incomplete vertices: those that have been incomplete before, then the new ones.
void MeshSurface::list_incomplete(std::uint64_t end, SurfacePiece& piece) {
  const auto vertex = [&](std::uint32_t n) {
    return n < piece.inherited ? incomplete_[n] : vertices_[n - piece.inherited];
  };
  collect(
      executor_, static_cast<std::int64_t>(incomplete_.size() + vertices_.size()), kSurfaceBlock,
      [&](std::int64_t from, std::int64_t to, std::vector<std::uint32_t>& list) {
        for (auto n = static_cast<std::uint32_t>(from); n < static_cast<std::uint32_t>(to); ++n) {
          if (last_[vertex(n)] >= end) list.push_back(n);
        }
      },
      piece.incomplete);
  std::vector<std::uint32_t> incomplete(piece.incomplete.size());
  for (std::size_t n = 0; n < incomplete.size(); ++n) {
    incomplete[n] = vertex(piece.incomplete[n]);
    number_[incomplete[n]] = static_cast<std::uint32_t>(n);
  }
  incomplete_ = std::move(incomplete);
}

double mean_triangle_area(const TriangleMesh& mesh, const Executor& executor) {
  if (mesh.triangles.empty()) return 0;
  const auto count = static_cast<std::int64_t>(mesh.triangles.size());
  std::vector<double> sums(static_cast<std::size_t>((count + kSurfaceBlock - 1) / kSurfaceBlock));
  executor.for_blocks(count, kSurfaceBlock, [&](std::int64_t begin, std::int64_t end) {
    sums[static_cast<std::size_t>(begin / kSurfaceBlock)] = sum_areas(mesh, begin, end);
  });
  double sum = 0;
  for (const double block : sums) sum += block;
  return sum / 2 / static_cast<double>(count);
}

}  // namespace isoweave
