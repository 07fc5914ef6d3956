// Whether a face is within a distance of the extracted surface.
#include <algorithm>
#include <bit>

#include "simplify/extracted_surface.hpp"
#include "simplify/point_distance.hpp"
#include "simplify/prism.hpp"
#include "simplify/projected_surface.hpp"

namespace isoweave {
namespace {

using measure::operator-;
using measure::operator+;
using measure::operator*;
using measure::dot;
using measure::Vector;
using measure::vector_of;

constexpr double kUsualReach = 1;      // of the distance, beyond the largest triangle: longer parts are seldom near one
constexpr double kFinest = 1.0 / 16;   // of the distance
constexpr double kSmall = 1.0 / 4;     // of the distance: a part for which all that is near is looked at
constexpr double kSeen = 0.93;         // of the distance: within kSure, also when it is rounded up to a whole bound
constexpr double kLeastSeen = 0.5;     // of the distance: what is nearer is not told apart
constexpr double kWide = 3;            // distances: the radius of a part that is worth seeing the surface around it
constexpr int kMostNear = 4;           // triangles of a cell, of which the nearest is taken
constexpr double kPlainly = 1 + 1e-9;  // distances: farther away than rounding goes
constexpr double kMostSeenCells = 1024;  // of a grid, around a part

static_assert(kSeen < ExtractedSurface::kSure && ExtractedSurface::kSure < 1 - kFinest);

// Puts the longest side first.
void turn_longest_side_first(ExtractedSurface::Corners& t) {
  std::array<double, 3> squared{};
  for (std::size_t n = 0; n < 3; ++n) {
    const Vector side = t[(n + 1) % 3] - t[n];
    squared[n] = dot(side, side);
  }
  const auto longest = std::max_element(squared.begin(), squared.end()) - squared.begin();
  std::rotate(t.begin(), t.begin() + longest, t.end());
}

// A set of triangles, by their pieces and their numbers in these.
class TriangleSet {
 public:
  // Returns false where a triangle is in it already.
  bool insert(std::size_t piece, std::uint32_t triangle) {
    const std::uint64_t key = (std::uint64_t{piece} << 32 | triangle) + 1;
    std::size_t at = static_cast<std::size_t>(key * 0x9e3779b97f4a7c15U >> (64 - kBits));
    for (; slots_[at] != 0; at = (at + 1) % slots_.size()) {
      if (slots_[at] == key) return false;
    }
    slots_[at] = key;
    return true;
  }

 private:
  static constexpr int kBits = 9;
  static_assert(std::size_t{1} << kBits >= 2 * SeenTriangles::kRoom, "half of the slots stay free");
  std::array<std::uint64_t, std::size_t{1} << kBits> slots_{};
};

}  // namespace

ExtractedSurface::Part ExtractedSurface::part_of(const Corners& corners, double most) {
  Part part{corners, (1.0 / 3) * (corners[0] + corners[1] + corners[2]), {}, 0, most};
  for (std::size_t n = 0; n < 4; ++n) {
    const Vector& p = n < 3 ? corners[n] : part.centre;
    part.points.x[n] = p[0];
    part.points.y[n] = p[1];
    part.points.z[n] = p[2];
    const Vector to = p - part.centre;
    part.radius = std::max(part.radius, dot(to, to));
  }
  return part;
}

// Whether a part is too long to be near one triangle: such a part is cut at once. That is a guess, and cutting early is
// never wrong.
bool ExtractedSurface::is_long(const Part& part) const {
  for (std::size_t n = 0; n < 3; ++n) {
    const auto [low, high] = std::minmax({part.corners[0][n], part.corners[1][n], part.corners[2][n]});
    if (high - low > largest_[n] + kUsualReach * part.most) return true;
  }
  return false;
}

// Finds how much of a part is within the distance of a triangle, where `known` is what other triangles have given.
ExtractedSurface::Found ExtractedSurface::find_near(const Part& part, const Piece& piece, std::uint32_t number,
                                                    Found known) const {
  constexpr unsigned kCorners = 7;
  constexpr unsigned kCentre = 8;
  const auto& [a, b, c] = piece.triangles[number];
  if (part.looks != nullptr) ++*part.looks;
  const unsigned near = kernels_.points_within(part.most * part.most, part.points,
                                               {&piece.positions[a], &piece.positions[b], &piece.positions[c]});
  if ((near & kCorners) == kCorners) {
    if (part.last != nullptr) *part.last = {&piece, number};
    if (part.nearest != nullptr) measure_corners(part, {piece.positions[a], piece.positions[b], piece.positions[c]});
    return Found::kAll;
  }
  return (near & kCentre) != 0 ? std::max(known, Found::kCentre) : known;
}

// Lowers the part's least distance to that of its corners from a triangle.
void ExtractedSurface::measure_corners(const Part& part, const std::array<Vec3, 3>& triangle) {
  double farthest = 0;
  for (std::size_t n = 0; n < 3; ++n) {
    farthest = std::max(farthest, distance({part.points.x[n], part.points.y[n], part.points.z[n]}, triangle));
  }
  *part.nearest = std::min(*part.nearest, farthest);
}

// Looks at the triangles of a cell up to one that the part is near. Their order depends on slabs; so where the nearest
// is asked for, all are looked at, or so many that the part is near that nobody asks any more.
ExtractedSurface::Found ExtractedSurface::find_in_cell(const Part& part, std::uint64_t key,
                                                       std::span<const Piece> pieces) const {
  Found found = Found::kNothing;
  int near = 0;
  for (const Piece& piece : pieces) {
    const Slot& slot = piece.slots[slot_of(piece, key)];
    for (const std::uint32_t number : std::span(piece.listed.data() + slot.first, slot.count)) {
      const Found one = find_near(part, piece, number, found);
      found = std::max(found, one);
      if (one != Found::kAll) continue;
      if (part.nearest == nullptr) return found;
      if (++near > kMostNear) {
        *part.nearest = std::numeric_limits<double>::infinity();
        return found;
      }
    }
  }
  return found;
}

// Whether a cell comes within the distance of a point.
bool ExtractedSurface::is_near(const Part& part, int level, const Cell& cell) const {
  double squared = 0;
  for (std::size_t n = 0; n < 3; ++n) {
    const double side = length(level, n);
    const double low = static_cast<double>(cell[n]) * side;
    const double outside = std::max({low - part.centre[n], 0.0, part.centre[n] - (low + side)});
    squared += outside * outside;
  }
  return squared <= part.most * part.most;
}

// Looks into the cells that are `ring` cells away from that of the centre.
ExtractedSurface::Found ExtractedSurface::find_in_ring(const Part& part, const Cell& centre, std::int64_t ring,
                                                       std::span<const Piece> pieces) const {
  Found found = Found::kNothing;
  Cell cell{};
  for (cell[2] = centre[2] - ring; cell[2] <= centre[2] + ring; ++cell[2]) {
    for (cell[1] = centre[1] - ring; cell[1] <= centre[1] + ring; ++cell[1]) {
      const bool side = std::max(std::abs(cell[2] - centre[2]), std::abs(cell[1] - centre[1])) == ring;
      const std::int64_t step = side ? 1 : 2 * ring;
      for (cell[0] = centre[0] - ring; cell[0] <= centre[0] + ring; cell[0] += step) {
        if (!is_near(part, 0, cell)) continue;
        found = std::max(found, find_in_cell(part, key_of(0, cell), pieces));
        if (found == Found::kAll) return found;
      }
    }
  }
  return found;
}

// Looks into the grids of larger triangles, where few cells come near the centre: into its own cell first.
ExtractedSurface::Found ExtractedSurface::find_above(const Part& part, std::span<const Piece> pieces) const {
  std::uint64_t levels = 0;
  for (const Piece& piece : pieces) levels |= piece.levels;
  Found found = Found::kNothing;
  for (levels &= ~std::uint64_t{1}; levels != 0 && found != Found::kAll; levels &= levels - 1) {
    const int level = std::countr_zero(levels);
    const Cell own = cell_of(part.centre, level);
    found = std::max(found, find_in_cell(part, key_of(level, own), pieces));
    if (found == Found::kAll) break;
    each_cell(cells_around(part, level), [&](const Cell& cell) {
      if (cell == own || !is_near(part, level, cell)) return true;
      found = std::max(found, find_in_cell(part, key_of(level, cell), pieces));
      return found != Found::kAll;
    });
  }
  return found;
}

// Looks into the cells around the centre, ring by ring. For a part that can be cut some more, the search ends at the
// first ring that is near: the surface farther away will do no better.
ExtractedSurface::Found ExtractedSurface::find(const Part& part) const {
  if (part.last != nullptr && part.last->piece != nullptr &&
      find_near(part, *part.last->piece, part.last->triangle, Found::kNothing) == Found::kAll) {
    return Found::kAll;
  }
  const std::span<const Piece> pieces = pieces_between(part.centre[2] - part.most, part.centre[2] + part.most);
  if (pieces.empty()) return Found::kNothing;
  Found found = find_above(part, pieces);
  const Cell centre = cell_of(part.centre, 0);
  const double smallest = *std::min_element(cell_.begin(), cell_.end());
  const auto rings = static_cast<std::int64_t>(std::ceil(part.most / smallest));
  for (std::int64_t ring = 0; ring <= rings && found != Found::kAll; ++ring) {
    if (found == Found::kCentre && !part.is_below(kSmall * part.most)) break;
    found = std::max(found, find_in_ring(part, centre, ring, pieces));
  }
  return found;
}

// A look at a face. Its parts are cut in depth: one sibling waits for each cut.
class ExtractedSurface::Look {
 public:
  Look(const ExtractedSurface& surface, const Corners& face, double most)
      : surface_(surface), most_(most), has_normal_(seen_.look_at(face)) {
    open_[count_++] = {face, false};
  }

  Reach reach() {
    for (int looked_at = 0; count_ > 0; ++looked_at) {
      Open next = open_[--count_];
      const Part part = part_of(next.corners, most_);
      const Seen seen = see(part, next.is_seen);
      if (seen == Seen::kCovered) continue;
      if (seen == Seen::kBeyond) return Reach::kBeyond;
      const Found found = surface_.is_long(part) ? Found::kCentre : find(part);
      if (found == Found::kAll) continue;
      if (found == Found::kNothing || part.is_below(kFinest * most_)) return Reach::kBeyond;
      if (count_ + 2 > open_.size() || looked_at == kMostParts) return Reach::kBeyond;
      cut(next);
    }
    return Reach::kWithin;
  }

  const Looked& looked() const { return looked_; }

 private:
  struct Open {
    Corners corners;
    bool is_seen;  // the surface around this part, and maybe more
  };

  enum class Seen : std::uint8_t { kNothing, kCovered, kBeyond };

  // Whether a part is seen to lie near the surface, where it is a wide one, or was cut from one.
  Seen see(const Part& part, bool& is_seen) {
    if (!has_normal_) return Seen::kNothing;
    if (is_seen) return seen_.covers(part.corners) ? Seen::kCovered : Seen::kNothing;
    if (part.is_below(kWide * most_)) return Seen::kNothing;
    is_seen = see_around(part);
    if (!is_seen) return Seen::kNothing;
    double farthest = kLeastSeen * most_;
    const bool covered = seen_.survey(part.corners, kSeen * most_, farthest);
    note_distance(farthest);
    if (covered) return Seen::kCovered;
    return seen_.far_point() && surface_.is_beyond(*seen_.far_point(), kPlainly * most_) ? Seen::kBeyond
                                                                                         : Seen::kNothing;
  }

  // Notes how far a part is. What is not within kSeen may be as far as is allowed.
  void note_distance(double distance) {
    looked_.farthest = distance <= kSeen * most_ ? std::max(looked_.farthest, distance) : most_;
  }

  // Finds a triangle that a part is near: the nearest one, as long as all parts so far are within kSeen.
  Found find(Part part) {
    double nearest = std::numeric_limits<double>::infinity();
    const bool asks_for_nearest = looked_.farthest <= kSeen * most_;
    part.looks = &looked_.comparisons;
    part.nearest = asks_for_nearest ? &nearest : nullptr;
    part.last = asks_for_nearest ? nullptr : &last_;
    const Found found = surface_.find(part);
    if (asks_for_nearest && found == Found::kAll) note_distance(nearest);
    return found;
  }

  struct Box {
    Vector low{}, high{};
  };

  // Gathers the triangles that come near a part. Returns false where they are too many.
  bool see_around(const Part& part) {
    const double height = kSeen * most_;
    Box around;
    for (std::size_t n = 0; n < 3; ++n) {
      const auto [low, high] = std::minmax({part.corners[0][n], part.corners[1][n], part.corners[2][n]});
      around.low[n] = low - height;
      around.high[n] = high + height;
    }
    const std::span<const Piece> pieces = surface_.pieces_between(around.low[2], around.high[2]);
    std::uint64_t levels = 0;
    for (const Piece& piece : pieces) levels |= piece.levels;
    const Prism prism(part.corners, height);
    TriangleSet taken;
    bool fits = true;
    seen_.clear();
    for (; fits && levels != 0; levels &= levels - 1) {
      const int level = std::countr_zero(levels);
      const CellBox box{surface_.cell_of(around.low, level), surface_.cell_of(around.high, level)};
      if (box.cells() > kMostSeenCells) return false;
      const CellsOfPrism cells(prism, surface_.lengths_[static_cast<std::size_t>(level)]);
      each_cell(box, [&](const Cell& cell) {
        if (cells.may_touch(cell)) fits = see_cell(key_of(level, cell), around, pieces, taken);
        return fits;
      });
    }
    return fits;
  }

  // Adds the triangles of a cell whose boxes touch another: whether they are too many must not depend on what else
  // their pieces hold.
  bool see_cell(std::uint64_t key, const Box& around, std::span<const Piece> pieces, TriangleSet& taken) {
    for (std::size_t n = 0; n < pieces.size(); ++n) {
      const Piece& piece = pieces[n];
      const Slot& slot = piece.slots[slot_of(piece, key)];
      for (const std::uint32_t t : std::span(piece.listed.data() + slot.first, slot.count)) {
        const auto& [a, b, c] = piece.triangles[t];
        if (!touches(around, corners_of(piece, t)) || !taken.insert(n, t)) continue;
        if (!seen_.add(piece.positions[a], piece.positions[b], piece.positions[c])) return false;
      }
    }
    return true;
  }

  static bool touches(const Box& box, const Corners& t) {
    bool touching = true;
    for (std::size_t n = 0; n < 3; ++n) {
      touching &= std::min({t[0][n], t[1][n], t[2][n]}) <= box.high[n];
      touching &= std::max({t[0][n], t[1][n], t[2][n]}) >= box.low[n];
    }
    return touching;
  }

  void cut(Open& part) {
    turn_longest_side_first(part.corners);
    const auto& [a, b, c] = part.corners;
    const Vector middle = 0.5 * (a + b);
    open_[count_++] = {{a, middle, c}, part.is_seen};
    open_[count_++] = {{middle, b, c}, part.is_seen};
  }

  const ExtractedSurface& surface_;
  double most_;
  ProjectedSurface seen_;
  bool has_normal_;
  Looked looked_;
  Named last_;
  std::array<Open, 128> open_;
  std::size_t count_ = 0;
};

Reach ExtractedSurface::reach(const Vec3& a, const Vec3& b, const Vec3& c, double most, Looked* looked) const {
  if (std::max({a.z, b.z, c.z}) + most > complete_below_) return Reach::kUnknown;
  Look look(*this, {vector_of(a), vector_of(b), vector_of(c)}, most);
  const Reach answer = look.reach();
  if (looked != nullptr) *looked = look.looked();
  return answer;
}

bool ExtractedSurface::is_beyond(const Vec3& p, double most) const {
  return p.z + most <= complete_below_ && is_beyond(vector_of(p), most);
}

bool ExtractedSurface::is_beyond(const Vector& p, double most) const {
  return find(part_of({p, p, p}, most)) != Found::kAll;
}

}  // namespace isoweave
