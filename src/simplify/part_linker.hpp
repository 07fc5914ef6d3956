// How a part becomes a surface that a zone can hold: sides find their twins by ids.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "parallel/collect.hpp"
#include "parallel/parallel.hpp"
#include "simplify/zone_part.hpp"

namespace isoweave {

// The most triangles around a vertex. Extraction makes fewer, and kMaxValence bounds what is merged.
inline constexpr Index kMostFaces = 256;

// The surface that a part is of: all that is undecided, or some of it, whose other triangles lie in other parts.
enum class PartScope : std::uint8_t { kAll, kSome };

// Links a part: twins, and where the fans of vertices start. Refuses a surface that no zone could hold.
template <class Require>
class PartLinker {
 public:
  PartLinker(ZonePart& part, CostBits within, PartScope scope, const Executor& executor, const Require& require)
      : part_(part), within_(within), scope_(scope), executor_(executor), require_(require), zone_(part.view()) {}

  void link() {
    list_leaving();
    executor_.for_each(zone_.triangle_count(), kBlock, [&](std::int64_t t) {
      for (Index c = 0; c < 3; ++c) link_side(half_edge(static_cast<Index>(t), c));
    });
    leaving_ = {};
    collect(
        executor_, zone_.triangle_count(), kBlock,
        [&](std::int64_t begin, std::int64_t end, std::vector<Index>& unkeyed) {
          for (auto t = static_cast<Index>(begin); t < static_cast<Index>(end); ++t) {
            for (Index c = 0; c < 3; ++c) settle(half_edge(t, c), unkeyed);
          }
        },
        part_.unkeyed_edges);
    start_fans();
  }

 private:
  static constexpr std::int64_t kBlock = 2048;

  // Lists the half-edges that leave each vertex.
  void list_leaving() {
    std::vector<Index> end(part_.vertices.size() + 1, 0);
    for (const Triangle& triangle : part_.triangles) {
      for (const HalfEdge& side : triangle.sides) ++end[side.vertex + 1];
    }
    require_(*std::max_element(end.begin(), end.end()) <= kMostFaces, "stars as small as they are in volumes");
    std::partial_sum(end.begin(), end.end(), end.begin());
    first_leaving_ = end;
    leaving_.resize(end.back());
    for (Index t = 0; t < zone_.triangle_count(); ++t) {
      for (Index c = 0; c < 3; ++c) leaving_[end[part_.triangles[t].sides[c].vertex]++] = half_edge(t, c);
    }
  }

  // The only half-edge from one vertex to another, or kNone.
  Index find_side(Index from, Index to) const {
    Index found = kNone;
    for (Index n = first_leaving_[from]; n < first_leaving_[from + 1]; ++n) {
      if (zone_.destination(leaving_[n]) != to) continue;
      require_(found == kNone, "edges of one triangle or two");
      found = leaving_[n];
    }
    return found;
  }

  // Links both sides of an edge, by the one that begins at the vertex with the smaller number.
  void link_side(Index h) {
    static_cast<void>(find_side(zone_.origin(h), zone_.destination(h)));  // refuses two
    if (zone_.origin(h) > zone_.destination(h)) return;
    const Index back = find_side(zone_.destination(h), zone_.origin(h));
    if (back == kNone) return;
    const bool fits = expects_twin(h) && expects_twin(back) && zone_.key(h) == zone_.key(back) &&
                      zone_.tie_low(h) == zone_.tie_low(back);
    require_(fits, "edges whose two sides fit together");
    zone_.set_twin(h, back);
    zone_.set_twin(back, h);
  }

  // Whether the triangle beside a side may be here: it has not left, and the side is not on a border.
  bool expects_twin(Index h) const {
    return exists(zone_.twin(h)) || (zone_.twin(h) == kWritten) == (scope_ == PartScope::kSome);
  }

  bool is_incomplete(Index v) const { return zone_.states[v] == VertexState::kIncomplete; }

  // Checks the key of a side, or sets it aside where an end is incomplete.
  void settle(Index h, std::vector<Index>& unkeyed) {
    const Index ends[2] = {zone_.origin(h), zone_.destination(h)};
    if (is_incomplete(ends[0]) || is_incomplete(ends[1])) {
      require_(zone_.key(h) == 0, "no keys where a vertex is incomplete");
      if (zone_.represents_edge(h)) unkeyed.push_back(h);
      return;
    }
    require_(zone_.cost(h) != kUnknownCost, "keys of edges");
    for (const Index v : ends) {
      const bool live = zone_.cost(h) <= within_;
      require_(!live || zone_.states[v] != VertexState::kFinal, "no edge to decide at a final vertex");
    }
  }

  // Starts the fan of a vertex on a border at that border, and any other fan anywhere.
  void start_fans() {
    std::vector<std::uint32_t> corners(part_.vertices.size(), 0);
    for (Index t = 0; t < zone_.triangle_count(); ++t) {
      for (Index c = 0; c < 3; ++c) {
        const Index h = half_edge(t, c);
        Index& start = zone_.vertices[zone_.origin(h)].half_edge;
        if (start == kNone || !exists(zone_.twin(h))) start = h;
        ++corners[zone_.origin(h)];
      }
    }
    if (scope_ == PartScope::kSome) find_cuts();
    for (Index v = 0; v < corners.size(); ++v) {
      require_(corners[v] > 0 || is_incomplete(v), "vertices of triangles");
      if (zone_.states[v] == VertexState::kComplete) check_fan(v, corners[v]);
    }
  }

  // Finds the vertices that are not final and have triangles in other parts. Those that have all of them here at last
  // are complete, and may have to get their quadrics.
  void find_cuts() {
    std::vector<std::uint8_t> cut(part_.vertices.size(), 0);
    for (Index t = 0; t < zone_.triangle_count(); ++t) {
      for (Index c = 0; c < 3; ++c) {
        const Index h = half_edge(t, c);
        if (zone_.twin(h) == kWritten) cut[zone_.origin(h)] = cut[zone_.destination(h)] = 1;
      }
    }
    for (Index v = 0; v < cut.size(); ++v) {
      VertexState& state = zone_.states[v];
      if (state == VertexState::kIncomplete && cut[v] == 0) {
        part_.completed.push_back(v);
        state = VertexState::kComplete;
      } else if (state == VertexState::kComplete || state == VertexState::kCut) {
        state = cut[v] != 0 ? VertexState::kCut : VertexState::kComplete;
      }
    }
  }

  // A vertex with an edge to decide has all its triangles here, in one fan.
  void check_fan(Index v, std::uint32_t corners) {
    const Index first = zone_.vertices[v].half_edge;
    std::uint32_t faces = 0;
    Index h = first;
    do {
      require_(zone_.twin(h) != kWritten && zone_.twin(previous(h)) != kWritten && ++faces <= corners,
               "whole stars around vertices that are not final");
      h = zone_.rotate(h);
    } while (h != first && exists(h));
    require_(faces == corners, "one fan of triangles around each vertex that is not final");
  }

  ZonePart& part_;
  const CostBits within_;
  const PartScope scope_;
  const Executor& executor_;
  const Require& require_;
  ZoneView zone_;
  std::vector<Index> first_leaving_;  // per vertex, and one more
  std::vector<Index> leaving_;
};

// Links a part. within: final vertices have no edge up to that cost. require(holds, what): is told what a part must
// have, and does not return where it does not hold.
template <class Require>
void link_part(ZonePart& part, CostBits within, PartScope scope, const Executor& executor, const Require& require) {
  PartLinker<Require>(part, within, scope, executor, require).link();
}

}  // namespace isoweave
