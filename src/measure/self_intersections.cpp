// Self-intersections: pairs of triangles with meeting boxes through the tree, then the exact test of each pair.
#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

#include "isoweave/measure.hpp"
#include "lattice/triangles.hpp"
#include "measure/triangle_pair.hpp"
#include "measure/triangle_tree.hpp"
#include "parallel/float_environment.hpp"
#include "parallel/parallel.hpp"

namespace isoweave {
namespace {

using measure::TrianglePoints;
using Pair = std::array<std::uint64_t, 2>;

constexpr std::int64_t kLeavesPerBlock = 64;
constexpr std::int64_t kTrianglesPerBlock = 4096;

// Moves the vertices that two triangles share to the front of both, in the same order. Returns their number.
std::size_t align_shared(std::array<std::uint32_t, 3>& s, std::array<std::uint32_t, 3>& t) {
  std::size_t shared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto found = std::find(t.begin() + static_cast<std::ptrdiff_t>(shared), t.end(), s[i]);
    if (found == t.end()) continue;
    std::swap(s[shared], s[i]);
    std::iter_swap(t.begin() + static_cast<std::ptrdiff_t>(shared), found);
    ++shared;
  }
  return shared;
}

// Keeps the least pairs, in rising order.
void list(std::vector<Pair>& first, const Pair& pair, std::size_t most) {
  if (first.size() >= most && (most == 0 || first.back() < pair)) return;
  first.insert(std::upper_bound(first.begin(), first.end(), pair), pair);
  if (first.size() > most) first.pop_back();
}

class Counter {
 public:
  Counter(const TriangleMesh& mesh, std::size_t listed, const Executor& executor)
      : mesh_(mesh), listed_(listed), executor_(executor), marks_(mesh.triangles.size(), 0) {}

  SelfIntersections run() {
    mark_without_area();
    SelfIntersections result = find_pairs();
    result.triangles = count_marks(kInPair);
    result.without_area = count_marks(kWithoutArea);
    return result;
  }

 private:
  static constexpr std::uint8_t kWithoutArea = 1;
  static constexpr std::uint8_t kInPair = 2;

  TrianglePoints points_of(const std::array<std::uint32_t, 3>& t) const {
    return {mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]};
  }

  void mark_without_area() {
    executor_.for_each(static_cast<std::int64_t>(marks_.size()), kTrianglesPerBlock, [&](std::int64_t n) {
      const auto t = static_cast<std::size_t>(n);
      if (!measure::has_area(points_of(mesh_.triangles[t]))) marks_[t] = kWithoutArea;
    });
  }

  SelfIntersections find_pairs() {
    const measure::TriangleTree tree(mesh_, executor_);
    const auto leaves = static_cast<std::int64_t>(tree.leaves());
    std::vector<SelfIntersections> blocks(static_cast<std::size_t>((leaves + kLeavesPerBlock - 1) / kLeavesPerBlock));
    executor_.for_blocks(leaves, kLeavesPerBlock, [&](std::int64_t begin, std::int64_t end) {
      SelfIntersections& found = blocks[static_cast<std::size_t>(begin / kLeavesPerBlock)];
      for (std::int64_t leaf = begin; leaf < end; ++leaf) {
        tree.for_each_near_pair(static_cast<std::size_t>(leaf),
                                [&](std::uint32_t i, std::uint32_t j) { test_pair(i, j, found); });
      }
    });
    SelfIntersections total;
    for (const SelfIntersections& block : blocks) {
      total.apart += block.apart;
      total.at_vertex += block.at_vertex;
      total.at_edge += block.at_edge;
      for (const Pair& pair : block.first) list(total.first, pair, listed_);
    }
    return total;
  }

  void test_pair(std::uint32_t i, std::uint32_t j, SelfIntersections& found) {
    if (mark_of(i) == kWithoutArea || mark_of(j) == kWithoutArea) return;
    std::array<std::uint32_t, 3> s = mesh_.triangles[i];
    std::array<std::uint32_t, 3> t = mesh_.triangles[j];
    const std::size_t shared = align_shared(s, t);
    if (!meets_beyond(shared, points_of(s), points_of(t))) return;
    ++(shared == 0 ? found.apart : shared == 1 ? found.at_vertex : found.at_edge);
    list(found.first, {std::min(i, j), std::max(i, j)}, listed_);
    mark_in_pair(i);
    mark_in_pair(j);
  }

  static bool meets_beyond(std::size_t shared, const TrianglePoints& s, const TrianglePoints& t) {
    if (shared == 0) return measure::triangles_meet(s, t);
    if (shared == 1) return measure::triangles_meet_beyond_vertex(s, t);
    return measure::triangles_meet_beyond_edge(s, t);
  }

  // Other threads may mark the same triangle.
  std::uint8_t mark_of(std::uint32_t t) { return std::atomic_ref(marks_[t]).load(std::memory_order_relaxed); }
  void mark_in_pair(std::uint32_t t) { std::atomic_ref(marks_[t]).store(kInPair, std::memory_order_relaxed); }

  std::uint64_t count_marks(std::uint8_t mark) const {
    return static_cast<std::uint64_t>(std::count(marks_.begin(), marks_.end(), mark));
  }

  const TriangleMesh& mesh_;
  std::size_t listed_;
  const Executor& executor_;
  std::vector<std::uint8_t> marks_;
};

}  // namespace

SelfIntersections count_self_intersections(const TriangleMesh& mesh, std::size_t listed, int threads) {
  const StandardFloats floats;
  measure::require_finite_mesh(mesh);
  if (mesh.triangles.empty()) return {};
  return Counter(mesh, listed, Executor(threads)).run();
}

}  // namespace isoweave
