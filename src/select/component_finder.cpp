#include "select/component_finder.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <string>

#include "isoweave/error.hpp"
#include "parallel/atomics.hpp"
#include "parallel/collect.hpp"
#include "parallel/union_find.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kFinderBlock = 4096;

}  // namespace

void ComponentFinder::apply(SurfacePiece& piece) {
  begin(piece);
  const auto vertices = static_cast<std::uint32_t>(parents_.size());
  LayerEnd done{piece.inherited, 0};
  while (done.vertex < vertices) {
    const LayerEnd end = end_of_layer(piece, done.vertex);
    join_triangles(piece, done.triangle, end.triangle);
    add_seeds(piece, done.vertex, end.vertex);
    done = end;
  }
  join_seeds(piece.inherited);
  count_triangles(piece);
  list_front(piece);
}

// Makes every vertex a set of its own.
void ComponentFinder::begin(const SurfacePiece& piece) {
  parents_.resize(piece.inherited + piece.positions.size());
  labels_.resize(parents_.size());
  executor_.for_each(static_cast<std::int64_t>(parents_.size()), kFinderBlock, [&](std::int64_t n) {
    const auto v = static_cast<std::uint32_t>(n);
    parents_[v] = v;
    if (v < piece.inherited) labels_[v] = front_[v];
  });
  new_roots_.clear();
}

// Finds the end of the layer that begins with a vertex. The last vertex of every triangle of a layer is new in that
// layer.
ComponentFinder::LayerEnd ComponentFinder::end_of_layer(const SurfacePiece& piece, std::uint32_t first_vertex) const {
  const std::uint64_t* const ids = piece.ids.begin();
  const std::int64_t layer = numbering_.layer_of(ids[first_vertex - piece.inherited]);
  const std::uint64_t* const end =
      std::partition_point(ids + (first_vertex - piece.inherited), piece.ids.end(),
                           [&](std::uint64_t id) { return numbering_.layer_of(id) == layer; });
  const std::uint32_t vertex = piece.inherited + static_cast<std::uint32_t>(end - ids);
  const auto* const triangle = std::partition_point(piece.triangles.begin(), piece.triangles.end(), [&](const auto& t) {
    return std::max({t[0], t[1], t[2]}) < vertex;
  });
  return {vertex, static_cast<std::size_t>(triangle - piece.triangles.begin())};
}

void ComponentFinder::join_triangles(const SurfacePiece& piece, std::size_t first, std::size_t end) {
  executor_.for_each(static_cast<std::int64_t>(end - first), kFinderBlock, [&](std::int64_t n) {
    const auto& [a, b, c] = piece.triangles[first + static_cast<std::size_t>(n)];
    join_sets(parents_, a, b);
    join_sets(parents_, a, c);
  });
}

// Adds the seeds of a layer: its new vertices that are still roots when all triangles of the layer have joined their
// vertices.
void ComponentFinder::add_seeds(const SurfacePiece& piece, std::uint32_t first, std::uint32_t end) {
  collect(
      executor_, end - first, kFinderBlock,
      [&](std::int64_t block_begin, std::int64_t block_end, std::vector<std::uint32_t>& list) {
        for (auto v = first + static_cast<std::uint32_t>(block_begin);
             v < first + static_cast<std::uint32_t>(block_end); ++v) {
          if (parents_[v] == v) list.push_back(v);
        }
      },
      found_);
  if (seeds_.size() + found_.size() >= std::numeric_limits<std::uint32_t>::max()) {
    throw OverMemory("the surface begins at " + std::to_string(seeds_.size() + found_.size()) +
                     " places, expected fewer than 2^32 to tell its components apart");
  }
  for (const std::uint32_t v : found_) {
    labels_[v] = static_cast<std::uint32_t>(seeds_.size());
    seed_parents_.push_back(labels_[v]);
    seeds_.push_back(piece.ids[v - piece.inherited]);
    seed_triangles_.push_back(0);
  }
  new_roots_.insert(new_roots_.end(), found_.begin(), found_.end());
}

// Joins the seeds whose parts of the surface a later layer has joined: their components are one.
void ComponentFinder::join_seeds(std::uint32_t inherited) {
  const auto join = [&](std::uint32_t v) {
    const std::uint32_t root = find_root(parents_, v);
    if (root != v) join_sets(seed_parents_, labels_[v], labels_[root]);
  };
  executor_.for_each(inherited, kFinderBlock, [&](std::int64_t v) { join(static_cast<std::uint32_t>(v)); });
  executor_.for_each(static_cast<std::int64_t>(new_roots_.size()), kFinderBlock,
                     [&](std::int64_t n) { join(new_roots_[static_cast<std::size_t>(n)]); });
}

// Counts triangles by component. Consecutive triangles are of one component as a rule, and are counted together.
void ComponentFinder::count_triangles(const SurfacePiece& piece) {
  const auto count = static_cast<std::int64_t>(piece.triangles.size());
  executor_.for_blocks(count, kFinderBlock, [&](std::int64_t begin, std::int64_t end) {
    std::uint32_t root = 0;
    std::uint64_t run = 0;
    const auto add = [&] {
      if (run > 0) fetch_add(seed_triangles_[labels_[root]], run);
    };
    for (std::int64_t n = begin; n < end; ++n) {
      const std::uint32_t own = find_root(parents_, piece.triangles[static_cast<std::size_t>(n)][0]);
      if (own != root) {
        add();
        root = own;
        run = 0;
      }
      ++run;
    }
    add();
  });
}

void ComponentFinder::list_front(const SurfacePiece& piece) {
  front_.resize(piece.incomplete.size());
  executor_.for_each(static_cast<std::int64_t>(front_.size()), kFinderBlock, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    front_[n] = find_root(seed_parents_, labels_[find_root(parents_, piece.incomplete[n])]);
  });
}

// Adds the triangles of all seeds of a component to its first seed.
void ComponentFinder::sum_up() {
  for (std::uint32_t n = 0; n < seeds_.size(); ++n) {
    const std::uint32_t root = find_root(seed_parents_, n);
    if (root != n) seed_triangles_[root] += std::exchange(seed_triangles_[n], 0);
  }
}

ComponentChoice ComponentFinder::choose(const ComponentRule& rule) {
  sum_up();
  ComponentChoice choice;
  choice.rule = rule;
  const auto largest = static_cast<std::size_t>(std::max_element(seed_triangles_.begin(), seed_triangles_.end()) -
                                                seed_triangles_.begin());
  const auto is_kept = [&](std::uint32_t root) {
    return seed_triangles_[root] >= rule.min_triangles && (!rule.largest || root == largest);
  };
  std::size_t kept_seeds = 0;
  for (std::uint32_t n = 0; n < seeds_.size(); ++n) {
    const bool kept = is_kept(find_root(seed_parents_, n));
    kept_seeds += kept ? 1 : 0;
    if (seed_triangles_[n] == 0) continue;  // not the first of its component
    ++(kept ? choice.components : choice.components_dropped);
    (kept ? choice.triangles : choice.triangles_dropped) += seed_triangles_[n];
  }
  choice.seeds_are_kept = 2 * kept_seeds < seeds_.size();
  choice.seeds.reserve(choice.seeds_are_kept ? kept_seeds : seeds_.size() - kept_seeds);
  for (std::uint32_t n = 0; n < seeds_.size(); ++n) {
    if (is_kept(find_root(seed_parents_, n)) == choice.seeds_are_kept) choice.seeds.push_back(seeds_[n]);
  }
  std::sort(choice.seeds.begin(), choice.seeds.end());
  return choice;
}

std::uint64_t ComponentFinder::bytes() const {
  return seeds_.capacity() * sizeof(std::uint64_t) + seed_parents_.capacity() * sizeof(std::uint32_t) +
         seed_triangles_.capacity() * sizeof(std::uint64_t);
}

void ComponentFinder::serialize(StateWriter&) const { throw std::logic_error("a search for components is not saved"); }

void ComponentFinder::serialize(StateReader&) { throw std::logic_error("a search for components is not saved"); }

}  // namespace isoweave
