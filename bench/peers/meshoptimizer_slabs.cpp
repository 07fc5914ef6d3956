// meshoptimizer in parallel, as an expert would do it by hand: slabs along z with locked borders on all threads, then
// one serial pass over the whole, which takes the seams down to the target.
#include <meshoptimizer.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <thread>

#include "meshoptimizer.hpp"
#include "task.hpp"

namespace bench {
namespace {

constexpr std::size_t kSlabs = 16;
constexpr unsigned kUnseen = std::numeric_limits<unsigned>::max();

struct Slab {
  std::vector<unsigned> indices;  // of its own vertices
  std::vector<isoweave::Point> vertices;
  std::vector<std::uint32_t> numbers;  // of its vertices in the whole mesh
};

float lowest_z(const isoweave::TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  return std::min({mesh.vertices[triangle[0]][2], mesh.vertices[triangle[1]][2], mesh.vertices[triangle[2]][2]});
}

// Triangle numbers in slabs of equal count: slabs of equal height would leave threads without work.
std::vector<std::uint32_t> order_along_z(const isoweave::TriangleMesh& mesh) {
  std::vector<float> height(mesh.triangles.size());
  std::vector<std::uint32_t> order(mesh.triangles.size());
  for (std::uint32_t t = 0; t < order.size(); ++t) {
    height[t] = lowest_z(mesh, mesh.triangles[t]);
    order[t] = t;
  }
  const auto by_height = [&](std::uint32_t a, std::uint32_t b) { return height[a] < height[b]; };
  // What marching cubes made lies nearly in order.
  if (!std::is_sorted(order.begin(), order.end(), by_height)) std::stable_sort(order.begin(), order.end(), by_height);
  return order;
}

// The vertices of a slab are a short run of the mesh's when the mesh comes in order, so the map covers only that.
Slab cut_slab(const isoweave::TriangleMesh& mesh, std::span<const std::uint32_t> members) {
  std::uint32_t low = kUnseen, high = 0;
  for (const std::uint32_t t : members) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
  }
  Slab slab;
  if (members.empty()) return slab;
  std::vector<unsigned> number(high - low + 1, kUnseen);
  slab.indices.reserve(members.size() * 3);
  for (const std::uint32_t t : members) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      unsigned& own = number[v - low];
      if (own == kUnseen) {
        own = static_cast<unsigned>(slab.vertices.size());
        slab.vertices.push_back(mesh.vertices[v]);
        slab.numbers.push_back(v);
      }
      slab.indices.push_back(own);
    }
  }
  return slab;
}

// Renumbers the indices so that they run over the vertices in use, which go to `used`.
void compact(const std::vector<isoweave::Point>& vertices, std::vector<unsigned>& indices,
             std::vector<isoweave::Point>& used) {
  std::vector<unsigned> number(vertices.size(), kUnseen);
  for (unsigned& v : indices) {
    if (number[v] == kUnseen) {
      number[v] = static_cast<unsigned>(used.size());
      used.push_back(vertices[v]);
    }
    v = number[v];
  }
}

class Slabs : public Task {
 public:
  Slabs(const isoweave::TriangleMesh& full, const Goal& goal) : full_(full), goal_(goal) {}

  void run() override {
    const std::vector<std::uint32_t> order = order_along_z(full_);
    std::vector<Slab> slabs(kSlabs);
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
      for (std::size_t s = next++; s < kSlabs; s = next++) slabs[s] = simplified_slab(order, s);
    };
    std::vector<std::jthread> others;
    for (int t = 1; t < goal_.threads; ++t) others.emplace_back(work);
    work();
    others.clear();
    join(slabs);
  }
  std::size_t triangles() const override { return indices_.size() / 3; }
  isoweave::TriangleMesh mesh() const override { return {vertices_, to_triangles(indices_), {}}; }

 private:
  Slab simplified_slab(const std::vector<std::uint32_t>& order, std::size_t s) const {
    const std::size_t begin = order.size() * s / kSlabs, end = order.size() * (s + 1) / kSlabs;
    Slab slab = cut_slab(full_, std::span(order).subspan(begin, end - begin));
    const std::size_t target = (end - begin) * goal_.triangles / full_.triangles.size();
    slab.indices = meshoptimizer_simplify(slab.indices, slab.vertices, target, meshopt_SimplifyLockBorder);
    return slab;
  }

  void join(const std::vector<Slab>& slabs) {
    for (const Slab& slab : slabs) {
      for (const unsigned v : slab.indices) indices_.push_back(slab.numbers[v]);
    }
    compact(full_.vertices, indices_, vertices_);
    indices_ = meshoptimizer_simplify(indices_, vertices_, goal_.triangles, 0);
  }

  const isoweave::TriangleMesh& full_;
  Goal goal_;
  std::vector<unsigned> indices_;
  std::vector<isoweave::Point> vertices_;
};

}  // namespace

void add_meshoptimizer_slabs(Contestants& contestants) {
  contestants.simplifiers.push_back(
      {"meshoptimizer in slabs", true,
       [](const isoweave::TriangleMesh& full, const Goal& goal) { return std::make_unique<Slabs>(full, goal); }});
}

}  // namespace bench
