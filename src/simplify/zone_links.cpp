// How triangles are linked: half-edges get their twins, and vertices whose faces are not one fan are found.
#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <utility>
#include <vector>

#include "parallel/collect.hpp"
#include "parallel/vertex_owners.hpp"
#include "simplify/zone.hpp"
#include "simplify/zone_rules.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kLinksBlock = 2048;
constexpr std::uint32_t kNoFan = std::uint32_t{1} << 31;  // beside a number of triangles

using Four [[gnu::vector_size(16), gnu::may_alias]] = std::uint32_t;

// The sides of triangles that run one way at a vertex: all leave it, or all arrive.
struct Sides {
  static constexpr std::size_t kRoom = 16;  // a fan's hub has more sides: they are only counted

  alignas(Four) std::array<Index, kRoom> other_end;
  std::array<Index, kRoom> half_edge;
  std::size_t count = 0;

  Sides() { other_end.fill(kNone); }

  void add(Index end, Index h) {
    if (count < kRoom) {
      other_end[count] = end;
      half_edge[count] = h;
    }
    ++count;
  }

  const Four* ends() const { return reinterpret_cast<const Four*>(other_end.data()); }
};

// The sides that leave a vertex and those that arrive there. A triangle has one of each, at the same place in the
// lists.
struct SidesAt {
  static constexpr std::uint8_t kNoSide = Sides::kRoom;

  Sides leaving;
  Sides arriving;
  std::array<std::uint8_t, Sides::kRoom> after;  // for each side that arrives: the side that leaves on its edge

  std::size_t most() const { return std::max(leaving.count, arriving.count); }
};

bool several(std::uint32_t bits) { return (bits & (bits - 1)) != 0; }

// Makes twins of the sides that leave a vertex and those that arrive there. see_bad(half-edge) is told of an edge with
// two sides that leave, or two that arrive. All sides are compared with all, by bits, as the pairs that fit cannot be
// predicted.
template <std::size_t kLanes, class SeeBad>
void link_leaving(const ZoneView& zone, SidesAt& sides, const SeeBad& see_bad) {
  const Sides& leaving = sides.leaving;
  const Sides& arriving = sides.arriving;
  Four twins[kLanes / 4] = {};
  Four rivals[kLanes / 4] = {};
  Four bit = {1, 1, 1, 1};
  for (std::size_t m = 0; m < sides.most(); ++m, bit += bit) {
    for (std::size_t n = 0; n < kLanes / 4; ++n) {
      twins[n] |= Four(leaving.ends()[n] == arriving.other_end[m]) & bit;
      rivals[n] |= Four(leaving.ends()[n] == leaving.other_end[m]) & bit;
    }
  }
  sides.after.fill(SidesAt::kNoSide);
  for (std::size_t n = 0; n < leaving.count; ++n) {
    const std::uint32_t twin = twins[n / 4][n % 4];
    if (several(twin) || several(rivals[n / 4][n % 4])) {
      see_bad(leaving.half_edge[n]);
    } else if (twin != 0) {
      const auto m = static_cast<std::size_t>(std::countr_zero(twin));
      zone.set_twin(leaving.half_edge[n], arriving.half_edge[m]);
      sides.after[m] = static_cast<std::uint8_t>(n);
    }
  }
}

}  // namespace

// Links a piece to itself and to the front.
class Zone::Linker {
 public:
  Linker(Zone& zone, const SurfacePiece& piece, Index first_triangle, const Executor& executor)
      : zone_(zone),
        inherited_(piece.inherited),
        triangles_(zone.order_.triangles()),
        first_new_(half_edge(first_triangle, 0)),
        first_known_(half_edge(static_cast<Index>(triangles_.size()), 0)),
        known_(zone.known_sides_of(piece)) {
    zone.first_side_.resize(piece.inherited + piece.positions.size());
    zone.next_side_.resize(first_known_ + 2 * known_.size());
    list_sides(executor);
  }

  // The triangles of the column of the n-th vertex of the piece, a new one. `column` must not lie behind that column,
  // and is moved on to it.
  TriangleRange column_of(Index n, std::size_t& column) const {
    if (n < inherited_) return {};
    while (zone_.order_.vertex_column_starts()[column + 1] <= n - inherited_) ++column;
    const Index first = first_new_ >> 2;
    const auto starts = zone_.order_.column_starts();
    return {first + static_cast<Index>(starts[column]), first + static_cast<Index>(starts[column + 1])};
  }

  // Links the n-th vertex of the piece, v in the zone: its sides get their twins, or are added to the bad ones. If its
  // faces are one closed fan, and all of them are in this piece, they become `star`.
  bool link(Index n, Index v, TriangleRange own_column, std::vector<Index>& bad, Star& star) const {
    SidesAt sides;
    Index first = kNone;
    std::uint32_t corners = 0;
    Index least = kNone;
    Index last = 0;
    each_side(
        n,
        [&](Index to, Index h) {
          sides.leaving.add(to, h);
          if (h < first_new_) return;
          zone_.half(h) = {v};
          zone_.triangles[h >> 2].tie_low[h & 3] = 0;
          least = std::min(least, h >> 2);
          last = std::max(last, h >> 2);
          first = std::min(first, h);
          ++corners;
        },
        [&](Index from, Index h) { sides.arriving.add(from, h); });
    if (zone_.vertices[v].half_edge == kNone) zone_.vertices[v].half_edge = first;
    const bool in_own_column = n >= inherited_ && least >= own_column.begin && last < own_column.end;
    if (corners > 0 && in_own_column) {
      zone_.countdown.expect_last(v, last);
    } else if (corners > 0) {
      zone_.countdown.expect(v, corners);
    }
    if (!zone_.corner_array_.empty()) zone_.corner_array_[v] += corners;
    const auto see_bad = [&](Index h) { bad.push_back(h); };
    if (sides.most() > Sides::kRoom) {
      link_hub(n, see_bad);
      return false;
    }
    if (sides.most() <= Sides::kRoom / 2) {
      link_leaving<Sides::kRoom / 2>(zone_, sides, see_bad);
    } else {
      link_leaving<Sides::kRoom>(zone_, sides, see_bad);
    }
    return n >= inherited_ && gather(sides, v, star);
  }

 private:
  // Lists the sides at every vertex. A triangle is listed at its corners, by the half-edge that leaves there, counted
  // from the first new one. Known sides follow, each at both of its ends.
  void list_sides(const Executor& executor) {
    const VertexOwners owners(executor, triangles_);
    owners.for_parts(zone_.first_side_.size(), [&](const VertexOwners::Part& part) {
      std::fill_n(zone_.first_side_.data() + part.first, part.size, kNone);
      const auto list = [&](Index n, Index side) {
        if (part.has(n)) zone_.next_side_[side] = std::exchange(zone_.first_side_[n], side);
      };
      part.each_triangle([&](std::size_t t) {
        for (Index c = 0; c < 3; ++c) list(triangles_[t][c], half_edge(static_cast<Index>(t), c));
      });
      for (std::size_t i = 0; i < known_.size(); ++i) {
        const Index side = first_known_ + 2 * static_cast<Index>(i);
        list(known_[i][0], side);
        list(known_[i][1], side + 1);
      }
    });
  }

  // Calls leave(other end, half-edge) and arrive(other end, half-edge) for the sides at a vertex.
  template <class Leave, class Arrive>
  void each_side(Index n, const Leave& leave, const Arrive& arrive) const {
    for (Index side = zone_.first_side_[n]; side != kNone; side = zone_.next_side_[side]) {
      if (side < first_known_) {
        const auto& corners = triangles_[side >> 2];
        leave(corners[next(side) & 3], first_new_ + side);
        arrive(corners[previous(side) & 3], first_new_ + previous(side));
      } else {
        const auto& [a, b, h] = known_[(side - first_known_) / 2];
        a == n ? leave(b, h) : arrive(a, h);
      }
    }
  }

  // Sorts the sides of a vertex that has too many of them to compare all with all.
  template <class SeeBad>
  void link_hub(Index n, const SeeBad& see_bad) const {
    std::vector<EdgeSide> sides;
    each_side(
        n, [&](Index to, Index h) { sides.emplace_back(to, h); },
        [&](Index from, Index h) { sides.emplace_back(from | EdgeSide::kBackwards, h); });
    std::sort(sides.begin(), sides.end(),
              [](const EdgeSide& a, const EdgeSide& b) { return a.other_end() < b.other_end(); });
    link_sorted(
        sides, [&](Index leaving, Index arriving) { zone_.set_twin(leaving, arriving); }, see_bad);
  }

  // Gathers the star of a vertex from its sides, where all its triangles are new, as star.gather(zone, v) would.
  // Returns false where the faces are not one closed fan.
  bool gather(const SidesAt& sides, Index v, Star& star) const {
    const Sides& leaving = sides.leaving;
    if (leaving.count == 0) return false;
    const auto id = [&](std::size_t n) { return zone_.vertices[zone_.index_of(leaving.other_end[n])].id; };
    std::size_t first = 0;
    for (std::size_t n = 1; n < leaving.count; ++n) first = id(n) < id(first) ? n : first;
    zone_.vertices[v].half_edge = leaving.half_edge[first];  // where start_fan() would begin
    std::size_t faces = 0;
    std::size_t side = first;
    do {
      if (side == SidesAt::kNoSide || faces == leaving.count) return false;
      star.out[faces] = leaving.half_edge[side];
      star.neighbour[faces++] = zone_.index_of(leaving.other_end[side]);
      side = sides.after[side];
    } while (side != first);
    star.vertex = v;
    star.faces = star.neighbours = static_cast<int>(faces);
    return faces == leaving.count;
  }

  Zone& zone_;
  const Index inherited_;
  const std::span<const std::array<std::uint32_t, 3>> triangles_;  // sorted
  const Index first_new_;
  const Index first_known_;
  const std::vector<std::array<Index, 3>> known_;  // numbers of the ends in the piece, and the half-edge
};

// Finds the twins of a piece, and the facts about its triangles that each vertex needs. The ends of a bad edge are
// marked; its sides may be linked to anything. Vertices that are complete now get their quadrics while their faces are
// at hand, if possible.
void Zone::link(const SurfacePiece& piece, Index first_triangle, std::span<const std::uint8_t> on_front,
                const Executor& executor) {
  const Linker linker(*this, piece, first_triangle, executor);
  std::vector<Index> bad;
  collect(
      executor, static_cast<std::int64_t>(first_side_.size()), kLinksBlock,
      [&](std::int64_t begin, std::int64_t end, std::vector<Index>& list) {
        std::size_t column = 0;
        for (auto n = static_cast<Index>(begin); n < static_cast<Index>(end); ++n) {
          const Index v = index_of(n);
          Star star;
          if (!linker.link(n, v, linker.column_of(n, column), list, star) || on_front[v] != 0 || options.normals_count)
            continue;
          states[v] = VertexState::kComplete;
          initial_quadric(star);
        }
      },
      bad);
  for (const Index h : bad) {
    if (corner_array_.empty()) break;
    corner_array_[origin(h)] |= kNoFan;
    corner_array_[destination(h)] |= kNoFan;
  }
}

// Whether the faces of a vertex are one fan: a walk both ways around it meets all of them, and no edge there is bad.
bool Zone::is_one_fan(const Star& star) const {
  const std::uint32_t corners = corner_array_[star.vertex];
  if (!star.border && !star.overflow) return static_cast<std::uint32_t>(star.faces) == corners;
  const Index first = vertices[star.vertex].half_edge;
  std::uint32_t faces = 1;
  for (Index h = rotate(first); h != first; h = rotate(h), ++faces) {
    if (exists(h)) continue;
    for (h = twin(first); exists(h); h = twin(next(h))) ++faces;
    break;
  }
  return faces == corners;
}

// The half-edges that a piece can bring a twin for, with the numbers that the piece gives to their ends. Only a
// triangle between incomplete vertices has such half-edges. One that has a twin already can get another side only from
// a piece that is not a manifold.
std::vector<std::array<Index, 3>> Zone::known_sides_of(const SurfacePiece& piece) const {
  Array<Index> number;  // of incomplete vertices
  number.resize(settled.first_new);
  for (Index n = 0; n < piece.inherited; ++n) number[front_[n]] = n;
  std::vector<std::array<Index, 3>> sides;
  for (const Index h : unkeyed_edges_) {
    const Index a = origin(h);
    const Index b = destination(h);
    if (states[a] != VertexState::kIncomplete || states[b] != VertexState::kIncomplete) continue;
    if (twin(h) == kNone) {
      sides.push_back({number[a], number[b], h});
    } else if (!piece.manifold) {
      sides.push_back({number[a], number[b], h});
      sides.push_back({number[b], number[a], twin(h)});
    }
  }
  return sides;
}

}  // namespace isoweave
