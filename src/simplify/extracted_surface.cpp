#include "simplify/extracted_surface.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "simplify/edge_rules.hpp"

namespace isoweave {
namespace {

using measure::operator-;
using measure::operator+;
using measure::operator*;
using measure::cross;
using measure::dot;
using measure::Vector;
using measure::vector_of;

constexpr std::size_t kMostCells = 256;  // of one grid that a triangle is listed in
constexpr std::size_t kMixed = 16;       // triangles of a list: the order of more is mixed
constexpr int kKeyBits = 19;             // of a cell's place along an axis, in its key
constexpr double kFewCells = 8;          // of a triangle's box: they are taken as they are
constexpr double kSlack = 1e-9;          // of lengths, for rounding

// The number of a cell. It is clamped, as mesh files may lie anywhere.
std::int64_t cell_number(double cells) { return static_cast<std::int64_t>(std::floor(std::clamp(cells, -1e15, 1e15))); }

// A triangle, or the polygon that is left of it between planes.
class CutPolygon {
 public:
  explicit CutPolygon(const ExtractedSurface::Corners& triangle) : count_(triangle.size()) {
    std::ranges::copy(triangle, corners_.begin());
  }

  // The part of the polygon between two planes across an axis.
  CutPolygon between(std::size_t axis, double low, double high) const {
    return above(axis, 1, low).above(axis, -1, -high);
  }

  // The range of the polygon along an axis; from infinity to minus infinity where nothing is left.
  std::pair<double, double> range(std::size_t axis) const {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::size_t n = 0; n < count_; ++n) {
      low = std::min(low, corners_[n][axis]);
      high = std::max(high, corners_[n][axis]);
    }
    return {low, high};
  }

 private:
  static constexpr std::size_t kMostCorners = 7;  // four planes

  CutPolygon() = default;

  // The part of the polygon where sign times the coordinate is `least` or more.
  CutPolygon above(std::size_t axis, double sign, double least) const {
    CutPolygon cut;
    for (std::size_t n = 0; n < count_; ++n) {
      const Vector& from = corners_[n];
      const Vector& to = corners_[n + 1 < count_ ? n + 1 : 0];
      const double before = sign * from[axis] - least;
      const double behind = sign * to[axis] - least;
      if (before >= 0) cut.add(from);
      if ((before >= 0) != (behind >= 0)) cut.add(from + (before / (before - behind)) * (to - from));
    }
    return cut;
  }

  // Adds a corner. Rounding may find more corners than there are: the last place stands for all of them.
  void add(const Vector& corner) {
    if (count_ < kMostCorners) corners_[count_++] = corner;
  }

  std::size_t count_ = 0;
  std::array<Vector, kMostCorners> corners_{};
};

// Mixes a list. Neighbours in it are neighbours in space, as a rule. Steps through the list of the golden section of
// its length find those near a point sooner, as no stretch of the list then waits longer than others of its length
// (Knuth, 1973).
template <class Item>
void mix(std::span<Item> list) {
  if (list.size() <= kMixed) return;
  const std::vector<Item> before(list.begin(), list.end());
  auto step = static_cast<std::size_t>(0.6180339887498949 * static_cast<double>(list.size()));
  while (std::gcd(step, list.size()) != 1) ++step;
  std::size_t at = 0;
  for (Item& next : list) {
    next = before[at];
    at = (at + step) % list.size();
  }
}

}  // namespace

ExtractedSurface::ExtractedSurface(double most, const Vec3& cell, const Vec3& largest)
    : most_(most),
      cell_{std::max(cell.x, most / 2), std::max(cell.y, most / 2), std::max(cell.z, most / 2)},
      largest_{largest.x, largest.y, largest.z} {
  for (std::size_t level = 0; level < lengths_.size(); ++level) {
    for (std::size_t n = 0; n < 3; ++n) lengths_[level][n] = std::ldexp(cell_[n], 2 * static_cast<int>(level));
  }
}

ExtractedSurface::Corners ExtractedSurface::corners_of(const Piece& piece, std::uint32_t number) {
  const auto& [a, b, c] = piece.triangles[number];
  return {vector_of(piece.positions[a]), vector_of(piece.positions[b]), vector_of(piece.positions[c])};
}

ExtractedSurface::Cell ExtractedSurface::cell_of(const Vector& p, int level) const {
  return {cell_number(p[0] / length(level, 0)), cell_number(p[1] / length(level, 1)),
          cell_number(p[2] / length(level, 2))};
}

// The key of a cell. Cells far apart may share a key, and are looked into together.
std::uint64_t ExtractedSurface::key_of(int level, const Cell& cell) {
  constexpr std::uint64_t kMask = (1U << kKeyBits) - 1;
  const auto part = [&](std::size_t n) { return static_cast<std::uint64_t>(cell[n]) & kMask; };
  return static_cast<std::uint64_t>(level) << 3 * kKeyBits | part(2) << 2 * kKeyBits | part(1) << kKeyBits | part(0);
}

double ExtractedSurface::CellBox::cells() const {
  double cells = 1;
  for (std::size_t n = 0; n < 3; ++n) cells *= static_cast<double>(last[n] - first[n] + 1);
  return cells;
}

double ExtractedSurface::CellBox::longest() const {
  return static_cast<double>(std::max({last[0] - first[0], last[1] - first[1], last[2] - first[2]}) + 1);
}

// The cells of a triangle's box, whose upper borders are not a part of it.
ExtractedSurface::CellBox ExtractedSurface::cells_of(const Corners& triangle, int level) const {
  CellBox box;
  for (std::size_t n = 0; n < 3; ++n) {
    const auto [low, high] = std::minmax({triangle[0][n], triangle[1][n], triangle[2][n]});
    box.first[n] = cell_number(low / length(level, n));
    box.last[n] = std::max(box.first[n], -cell_number(-high / length(level, n)) - 1);
  }
  return box;
}

// The cells that a ball of the distance may touch.
ExtractedSurface::CellBox ExtractedSurface::cells_around(const Part& part, int level) const {
  CellBox box;
  for (std::size_t n = 0; n < 3; ++n) {
    box.first[n] = cell_number((part.centre[n] - part.most) / length(level, n));
    box.last[n] = cell_number((part.centre[n] + part.most) / length(level, n));
  }
  return box;
}

// Calls visit(cell) for the cells of a box of some grid that a triangle touches, or may touch but for rounding, until
// visit() answers false. The triangle is cut at the layers of cells and then at the rows of each layer.
template <class Visit>
void ExtractedSurface::each_touched(const Corners& triangle, const CellBox& box, int level, const Visit& visit) const {
  const CutPolygon whole(triangle);
  const auto part = [&](const CutPolygon& polygon, std::size_t axis, std::int64_t number) {
    const double side = length(level, axis);
    const double low = static_cast<double>(number) * side;
    const double slack = kSlack * (side + std::abs(low));
    return polygon.between(axis, low - slack, low + side + slack);
  };
  const auto numbers = [&](const CutPolygon& polygon, std::size_t axis) {
    const double side = length(level, axis);
    const auto [low, high] = polygon.range(axis);
    const double slack = kSlack * (side + std::max(std::abs(low), std::abs(high)));
    return std::pair(std::max(box.first[axis], cell_number((low - slack) / side)),
                     std::min(box.last[axis], cell_number((high + slack) / side)));
  };
  Cell cell = box.first;
  for (cell[2] = box.first[2]; cell[2] <= box.last[2]; ++cell[2]) {
    const CutPolygon layer = part(whole, 2, cell[2]);
    const auto [first_row, last_row] = numbers(layer, 1);
    for (cell[1] = first_row; cell[1] <= last_row; ++cell[1]) {
      const auto [first, last] = numbers(part(layer, 1, cell[1]), 0);
      for (cell[0] = first; cell[0] <= last; ++cell[0]) {
        if (!visit(cell)) return;
      }
    }
  }
}

// Lists a triangle in the cells that it touches, in the finest grid in which they are few. Returns the level of that
// grid.
int ExtractedSurface::list_in_cells(const Corners& triangle, std::uint32_t number, std::vector<Place>& places) const {
  const std::size_t before = places.size();
  for (int level = 0;; ++level) {
    const auto list = [&](const Cell& cell) {
      places.push_back({key_of(level, cell), number});
      return true;
    };
    const auto list_few = [&](const Cell& cell) {
      return list(cell) && (places.size() - before <= kMostCells || level == kLastLevel);
    };
    const CellBox box = cells_of(triangle, level);
    if (box.cells() <= kFewCells) {
      each_cell(box, list);
    } else if (box.longest() <= kMostCells || level == kLastLevel) {
      each_touched(triangle, box, level, list_few);
    } else {
      continue;
    }
    if (places.size() - before <= kMostCells || level == kLastLevel) return level;
    places.resize(before);
  }
}

void ExtractedSurface::append(Array<Vec3> positions, std::span<const std::array<std::uint32_t, 3>> triangles,
                              double complete_below) {
  complete_below_ = complete_below;
  if (triangles.empty()) return;
  Piece piece;
  piece.positions = std::move(positions);
  piece.triangles.resize(triangles.size());
  std::ranges::copy(triangles, piece.triangles.begin());
  std::vector<Place> places;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const Corners corners = corners_of(piece, t);
    const auto [low, high] = std::minmax({corners[0][2], corners[1][2], corners[2][2]});
    piece.lowest = std::min(piece.lowest, low);
    piece.top = std::max(piece.top, high);
    piece.levels |= std::uint64_t{1} << list_in_cells(corners, t, places);
  }
  make_slots(piece, places);
  fill_slots(piece, places);
  push_piece(std::move(piece));
}

// Adds a piece. Pieces lie one above the other, but for a few triangles.
void ExtractedSurface::push_piece(Piece&& piece) {
  piece.highest = pieces_.empty() ? piece.top : std::max(piece.top, pieces_.back().highest);
  for (auto before = pieces_.rbegin(); before != pieces_.rend() && before->lowest > piece.lowest; ++before) {
    before->lowest = piece.lowest;
  }
  pieces_.push_back(std::move(piece));
}

// Makes a slot for each cell, with room for its triangles. The triangles of a cell come one after the other, as a rule.
void ExtractedSurface::make_slots(Piece& piece, std::span<const Place> places) {
  std::size_t cells = 1;
  for (std::size_t n = 1; n < places.size(); ++n) {
    if (places[n].key != places[n - 1].key) ++cells;
  }
  piece.slots.assign(std::bit_ceil(cells + cells / 3 + 1), {});  // some free
  for (const Place& place : places) {
    Slot& slot = piece.slots[slot_of(piece, place.key)];
    slot.key = place.key;
    ++slot.count;
  }
  std::uint32_t first = 0;
  for (Slot& slot : piece.slots) slot.first = std::exchange(first, first + slot.count);
}

void ExtractedSurface::fill_slots(Piece& piece, std::span<const Place> places) {
  piece.listed.resize(places.size());
  std::vector<std::uint32_t> filled(piece.slots.size(), 0);
  for (const Place& place : places) {
    const std::size_t at = slot_of(piece, place.key);
    piece.listed[piece.slots[at].first + filled[at]++] = place.triangle;
  }
  for (const Slot& slot : piece.slots) mix(std::span(piece.listed.data() + slot.first, slot.count));
}

// The slot of a key, or the free one that the key would get. Cells come in blocks of two along each axis, whose slots
// lie beside each other: a look goes to several of them.
std::size_t ExtractedSurface::slot_of(const Piece& piece, std::uint64_t key) {
  constexpr std::uint64_t kLow = 1 | std::uint64_t{1} << kKeyBits | std::uint64_t{1} << 2 * kKeyBits;
  const std::uint64_t in_block = (key & 1) | (key >> (kKeyBits - 1) & 2) | (key >> (2 * kKeyBits - 2) & 4);
  const std::size_t mask = piece.slots.size() - 1;
  std::size_t at = static_cast<std::size_t>(mix_bits(key & ~kLow) << 3 | in_block) & mask;
  while (piece.slots[at].count > 0 && piece.slots[at].key != key) at = (at + 1) & mask;
  return at;
}

void ExtractedSurface::forget_below(double z) {
  const double lowest = (layer_of(z) - kShift - 1) * cell_[2] - most_;  // a layer more than that of z, for rounding
  std::erase_if(pieces_, [&](const Piece& piece) { return piece.top < lowest; });
}

void ExtractedSurface::serialize(StateWriter& state) const {
  state.value(static_cast<std::uint64_t>(pieces_.size()));
  state.value(complete_below_);
  for (const Piece& piece : pieces_) {
    state.list(piece.positions);
    state.list(piece.triangles);
  }
}

// Grids are made anew. An answer does not depend on them, nor on pieces that have been forgotten.
void ExtractedSurface::serialize(StateReader& state, const Vec3& farthest) {
  const std::size_t pieces = state.count(sizeof(std::uint64_t));
  state.value(complete_below_);
  for (std::size_t n = 0; n < pieces; ++n) {
    Array<Vec3> positions;
    state.list(positions);
    for (const Vec3& p : positions) state.require(lies_within(p, farthest), "a surface nearby");
    Array<std::array<std::uint32_t, 3>> triangles;
    state.list(triangles);
    for (const auto& [a, b, c] : triangles) {
      state.require(std::max({a, b, c}) < positions.size(), "triangles of the vertices of a piece");
    }
    append(std::move(positions), {triangles.data(), triangles.size()}, complete_below_);
  }
}

std::uint64_t ExtractedSurface::bytes() const {
  std::uint64_t sum = 0;
  for (const Piece& piece : pieces_) {
    sum += piece.positions.capacity() * sizeof(Vec3) + piece.triangles.capacity() * sizeof(piece.triangles[0]) +
           piece.slots.capacity() * sizeof(Slot) + piece.listed.capacity() * sizeof(std::uint32_t);
  }
  return sum;
}

// The pieces with triangles that may lie between two heights.
std::span<const ExtractedSurface::Piece> ExtractedSurface::pieces_between(double low, double high) const {
  const auto first = std::ranges::lower_bound(pieces_, low, {}, &Piece::highest);
  const auto end =
      std::upper_bound(first, pieces_.end(), high, [](double z, const Piece& piece) { return z < piece.lowest; });
  return {first, end};
}

}  // namespace isoweave
