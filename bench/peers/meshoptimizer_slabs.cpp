// meshoptimizer in parallel, as an expert would do it by hand: slabs along z with locked borders on all threads, then
// one serial pass over the whole, which takes the seams down to the target.
#include <meshoptimizer.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <thread>

#include "meshoptimizer.hpp"

namespace bench {
namespace {

constexpr std::size_t kSlabs = 16;
constexpr unsigned kUnseen = std::numeric_limits<unsigned>::max();

struct Slab {
  std::vector<unsigned> indices;  // of its own vertices
  std::vector<isoweave::Point> vertices;
  std::vector<std::uint32_t> numbers;  // of its vertices in the whole mesh
};

// Marking may happen in two slabs at a time.
class Marks {
 public:
  explicit Marks(std::size_t count) : marks_(count) {}
  void set(std::size_t n) { std::atomic_ref(marks_[n]).store(1, std::memory_order_relaxed); }
  bool operator[](std::size_t n) const { return marks_[n] != 0; }

 private:
  std::vector<unsigned char> marks_;
};

// Calls work(0 ... kSlabs - 1) in so many threads.
template <class Work>
void for_each_slab(int threads, const Work& work) {
  std::atomic<std::size_t> next = 0;
  const auto worker = [&] {
    for (std::size_t s = next++; s < kSlabs; s = next++) work(s);
  };
  std::vector<std::jthread> others;
  for (int t = 1; t < threads; ++t) others.emplace_back(worker);
  worker();
}

// Marching cubes makes triangles in lattice order, so that a run of them is a slab. Runs of equal length give all
// threads the same work; slabs of equal height would not.
std::span<const unsigned> corners_of_slab(const isoweave::TriangleMesh& full, std::size_t s) {
  const std::size_t begin = full.triangles.size() * s / kSlabs, end = full.triangles.size() * (s + 1) / kSlabs;
  return flat_indices(full).subspan(3 * begin, 3 * (end - begin));
}

class SlabSimplifier {
 public:
  SlabSimplifier(const isoweave::TriangleMesh& full, const Goal& goal)
      : full_(full), goal_(goal), in_even_(full.vertices.size()), in_odd_(full.vertices.size()), slabs_(kSlabs) {}

  FlatMesh run() {
    for_each_slab(goal_.threads, [&](std::size_t s) { mark_vertices(s); });
    for_each_slab(goal_.threads, [&](std::size_t s) { simplify(s); });
    FlatMesh joined = join();
    joined.indices = meshoptimizer_simplify(joined.indices, joined.vertices, goal_.triangles, 0);
    return joined;
  }

 private:
  void mark_vertices(std::size_t s) {
    Marks& marks = s % 2 == 0 ? in_even_ : in_odd_;
    for (const unsigned v : corners_of_slab(full_, s)) marks.set(v);
  }

  bool in_two_slabs(unsigned v) const { return in_even_[v] && in_odd_[v]; }

  // What the locked border keeps is left for the pass over the seams. Taking the rest further down in its place gives
  // more than four times the mean distance, on the CT skull at a tenth of the triangles.
  std::size_t target(std::span<const unsigned> corners) const {
    std::size_t locked = 0;
    for (std::size_t c = 0; c < corners.size(); c += 3) {
      const bool stays = in_two_slabs(corners[c]) || in_two_slabs(corners[c + 1]) || in_two_slabs(corners[c + 2]);
      if (stays) ++locked;
    }
    return locked + (corners.size() / 3 - locked) * goal_.triangles / full_.triangles.size();
  }

  void simplify(std::size_t s) {
    const std::span<const unsigned> corners = corners_of_slab(full_, s);
    if (corners.empty()) return;
    Slab& slab = slabs_[s];
    cut(corners, slab);
    slab.indices = meshoptimizer_simplify(slab.indices, slab.vertices, target(corners), meshopt_SimplifyLockBorder);
  }

  // The vertices of a slab are nearly a run of the mesh's, so the map covers only that.
  void cut(std::span<const unsigned> corners, Slab& slab) const {
    const auto [low, high] = std::minmax_element(corners.begin(), corners.end());
    std::vector<unsigned> number(*high - *low + 1, kUnseen);
    slab.indices.reserve(corners.size());
    for (const unsigned v : corners) {
      unsigned& own = number[v - *low];
      if (own == kUnseen) {
        own = static_cast<unsigned>(slab.vertices.size());
        slab.vertices.push_back(full_.vertices[v]);
        slab.numbers.push_back(v);
      }
      slab.indices.push_back(own);
    }
  }

  // All slabs as one mesh, without the vertices that are no longer in use.
  FlatMesh join() const {
    FlatMesh joined;
    std::vector<unsigned> number(full_.vertices.size(), kUnseen);
    for (const Slab& slab : slabs_) {
      for (const unsigned v : slab.indices) {
        unsigned& own = number[slab.numbers[v]];
        if (own == kUnseen) {
          own = static_cast<unsigned>(joined.vertices.size());
          joined.vertices.push_back(slab.vertices[v]);
        }
        joined.indices.push_back(own);
      }
    }
    return joined;
  }

  const isoweave::TriangleMesh& full_;
  Goal goal_;
  Marks in_even_, in_odd_;
  std::vector<Slab> slabs_;
};

class Slabs : public Task {
 public:
  Slabs(const isoweave::TriangleMesh& full, const Goal& goal) : full_(full), goal_(goal) {}
  void run() override { result_ = meshoptimizer_simplify_in_slabs(full_, goal_); }
  std::size_t triangles() const override { return result_.indices.size() / 3; }
  isoweave::TriangleMesh mesh() const override { return result_.to_mesh(); }

 private:
  const isoweave::TriangleMesh& full_;
  Goal goal_;
  FlatMesh result_;
};

}  // namespace

FlatMesh meshoptimizer_simplify_in_slabs(const isoweave::TriangleMesh& full, const Goal& goal) {
  return SlabSimplifier(full, goal).run();
}

void add_meshoptimizer_slabs(Contestants& contestants) {
  contestants.simplifiers.push_back(
      {"meshoptimizer in slabs", true,
       [](const isoweave::TriangleMesh& full, const Goal& goal) { return std::make_unique<Slabs>(full, goal); }});
}

}  // namespace bench
