// Keys column by column, and which vertex has all of its own by when.
// Threads: KeyCountdown.*
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <random>
#include <thread>

#include "extract/marching_cubes.hpp"
#include "isoweave/generate.hpp"
#include "simplify/columns.hpp"
#include "simplify/key_countdown.hpp"
#include "simplify/zone.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::simplify_key_countdown_test {
namespace {

void in_threads(std::size_t threads, const std::function<void(std::size_t)>& work) {
  std::vector<std::jthread> running;
  for (std::size_t n = 0; n < threads; ++n) running.emplace_back(work, n);
}

TEST(KeyCountdown, NewVerticesWaitForNothing) {
  KeyCountdown countdown;
  countdown.begin(2);
  for (const Index v : {0U, 1U}) EXPECT_FALSE(countdown.waits(v));
  EXPECT_FALSE(countdown.count_off(0, 0));
}

TEST(KeyCountdown, OfOneColumnTheLastTriangleTells) {
  KeyCountdown countdown;
  countdown.begin(1);
  countdown.expect_last(0, 7);
  EXPECT_FALSE(countdown.count_off(0, 3));
  EXPECT_FALSE(countdown.count_off(0, 6));
  EXPECT_TRUE(countdown.waits(0));
  EXPECT_TRUE(countdown.count_off(0, 7));
  EXPECT_FALSE(countdown.waits(0));
  EXPECT_FALSE(countdown.count_off(0, 7));
}

TEST(KeyCountdown, OfSeveralColumnsAllTrianglesAreCounted) {
  KeyCountdown countdown;
  countdown.begin(1);
  countdown.expect(0, 3);
  for (const Index t : {9U, 1U}) EXPECT_FALSE(countdown.count_off(0, t));
  EXPECT_TRUE(countdown.waits(0));
  EXPECT_TRUE(countdown.count_off(0, 5));
  EXPECT_FALSE(countdown.waits(0));
  EXPECT_FALSE(countdown.count_off(0, 9));
}

TEST(KeyCountdown, WhatIsExpectedCanBeDropped) {
  KeyCountdown countdown;
  countdown.begin(3);
  for (const Index v : {0U, 2U}) countdown.expect(v, 1);
  EXPECT_TRUE(countdown.waits(0) && countdown.waits(2));
  countdown.expect_nothing();
  EXPECT_FALSE(countdown.waits(0) || countdown.waits(2));
}

TEST(KeyCountdown, OneOfManyThreadsIsTheLast) {
  constexpr Index kVertices = 1000;
  constexpr std::uint32_t kThreads = 4;
  constexpr std::uint32_t kEach = 5;
  KeyCountdown countdown;
  countdown.begin(kVertices);
  for (Index v = 0; v < kVertices; ++v) countdown.expect(v, kThreads * kEach);
  std::vector<std::atomic<int>> named(kVertices);
  in_threads(kThreads, [&](std::size_t) {
    for (std::uint32_t round = 0; round < kEach; ++round) {
      for (Index v = 0; v < kVertices; ++v) named[v] += countdown.count_off(v, round) ? 1 : 0;
    }
  });
  EXPECT_TRUE(std::all_of(named.begin(), named.end(), [](const auto& times) { return times == 1; }));
}

// Settles the edges of a zone column by column in some order, by several threads at once.
class InColumns {
 public:
  InColumns(Zone& zone, std::uint32_t seed) : zone_(zone), named_(zone.vertices.size()), columns_(Columns::kCount) {
    for (std::size_t c = 0; c < columns_.size(); ++c) columns_[c] = c;
    std::shuffle(columns_.begin(), columns_.end(), std::mt19937(seed));
  }

  void settle(std::size_t threads, const Executor& executor) {
    zone_.settle_waiting_edges(executor);
    std::vector<std::vector<Index>> unkeyed(threads);
    in_threads(threads, [&](std::size_t n) {
      for (std::size_t c = next_++; c < columns_.size(); c = next_++) settle(columns_[c], unkeyed[n]);
    });
    std::vector<Index> all;
    for (const auto& part : unkeyed) all.insert(all.end(), part.begin(), part.end());
    zone_.set_aside(all);
  }

  // How often a vertex turned out to have all its keys.
  int named(Index v) const { return named_[v]; }
  std::uint64_t named_too_early() const { return too_early_; }

 private:
  void settle(std::size_t column, std::vector<Index>& unkeyed) {
    const TriangleRange range = zone_.unsettled(column);
    zone_.settle_edges(range, unkeyed);
    for (Index t = range.begin; t < range.end; ++t) {
      for (const HalfEdge& side : zone_.triangles[t].sides) {
        if (!zone_.countdown.count_off(side.vertex, t)) continue;
        ++named_[side.vertex];
        if (zone_.states[side.vertex] == VertexState::kComplete && !has_keys(side.vertex)) ++too_early_;
      }
    }
  }

  // But for those of edges at neighbours that are incomplete.
  bool has_keys(Index v) const {
    Star star;
    star.gather(zone_, v);
    for (std::size_t n = 0; n < static_cast<std::size_t>(star.faces); ++n) {
      const bool known = zone_.cost(star.out[n]) != kUnknownCost;
      if (known != (zone_.states[star.neighbour[n]] == VertexState::kComplete)) return false;
    }
    return true;
  }

  Zone& zone_;
  std::vector<std::atomic<int>> named_;
  std::vector<std::size_t> columns_;
  std::atomic<std::size_t> next_{0};
  std::atomic<std::uint64_t> too_early_{0};
};

struct ZonePair {
  explicit ZonePair(const SurfaceCase& surface) : columns(surface.zone()), whole(surface.zone()) {}

  // One zone takes the keys of the piece in columns, the other all at once.
  void append(const SurfacePiece& piece, std::uint32_t seed) {
    for (Zone* zone : {&columns, &whole}) zone->append(piece, executor);
    whole.settle_edges(executor);
    for (std::size_t c = 0; c < Columns::kCount; ++c) {
      const TriangleRange range = columns.unsettled(c);
      for (Index t = range.begin; t < range.end; ++t) {
        for (const HalfEdge& side : columns.triangles[t].sides) EXPECT_TRUE(columns.countdown.waits(side.vertex));
      }
    }
    std::vector<bool> waited;
    for (Index v = 0; v < columns.vertices.size(); ++v) waited.push_back(columns.countdown.waits(v));
    InColumns in_columns(columns, seed);
    in_columns.settle(3, executor);
    EXPECT_EQ(in_columns.named_too_early(), 0U);
    for (Index v = 0; v < columns.vertices.size(); ++v) {
      EXPECT_EQ(in_columns.named(v), waited[v] ? 1 : 0) << "vertex " << v;
      EXPECT_FALSE(columns.countdown.waits(v) || whole.countdown.waits(v)) << "vertex " << v;
    }
  }

  std::uint64_t differing_keys() const {
    std::uint64_t differing = 0;
    for (Index h = 0; h < 4 * columns.triangle_count(); ++h) {
      if ((h & 3) == 3) continue;
      if (columns.key(h) != whole.key(h) || columns.tie(h) != whole.tie(h)) ++differing;
    }
    return differing;
  }

  const Executor executor{3};
  Zone columns;
  Zone whole;
};

TEST(KeyCountdown, NamesEveryVertexOnceWhenItHasItsKeys) {
  for (const bool closed : {true, false}) {
    const SurfaceCase surface{.volume = {.kind = "noise", .dims = {90, 75, 14}}, .closed = closed};
    const auto source = generate_volume(surface.volume);
    ZonePair zones(surface);
    MarchingCubes extractor(source->info(), {surface.rule(), false}, zones.executor);
    SliceWindow window(*source);
    SurfacePiece piece;
    for (std::uint32_t seed = 0; extractor.layers_left() > 0; ++seed) {
      const std::int64_t layers = std::min<std::int64_t>(4, extractor.layers_left());
      const auto [first, end] = extractor.slices_for(layers);
      window.advance(first, end);
      extractor.extract(window, layers, ~std::uint64_t{0}, piece);
      zones.append(piece, seed);
      ASSERT_EQ(zones.differing_keys(), 0U) << "slab " << seed;
    }
    EXPECT_GT(zones.whole.triangle_count(), 10000U);
  }
}

}  // namespace
}  // namespace isoweave::testing::simplify_key_countdown_test
