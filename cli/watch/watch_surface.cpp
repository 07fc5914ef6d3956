#include "watch/watch_surface.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <utility>

namespace isoweave::cli {
namespace {

constexpr int kMostBits = 16;  // one cell is all there is

std::array<CellTable::Place, 3> corners_of(const GridTriangle& t) {
  return {{{t[0], t[1], t[2]}, {t[3], t[4], t[5]}, {t[6], t[7], t[8]}}};
}

std::uint64_t cell_of(const CellTable::Place& place, int bits) {
  std::uint64_t cell = 0;
  for (const std::uint16_t at : place) cell = cell << 16 | std::uint64_t{at} >> bits;
  return cell;
}

}  // namespace

CellTable::Place CellTable::first_in_cell(const Place& place, int bits) {
  if (2 * (size_ + 1) > slots_.size()) grow();
  const std::uint64_t cell = cell_of(place, bits);
  Slot& slot = slot_of(cell);
  if (slot.cell == kEmpty) {
    slot = {cell, place};
    ++size_;
  }
  return slot.first;
}

// The slot of a cell, or the free one that the cell would get.
CellTable::Slot& CellTable::slot_of(std::uint64_t cell) {
  constexpr std::uint64_t kGoldenRatio = 0x9e3779b97f4a7c15;  // Knuth, The Art of Computer Programming 3, 6.4
  std::size_t n = (cell * kGoldenRatio >> 20) & (slots_.size() - 1);
  while (slots_[n].cell != kEmpty && slots_[n].cell != cell) n = (n + 1) & (slots_.size() - 1);
  return slots_[n];
}

void CellTable::grow() {
  const std::vector<Slot> before =
      std::exchange(slots_, std::vector<Slot>(std::max<std::size_t>(2 * slots_.size(), 1024)));
  for (const Slot& slot : before) {
    if (slot.cell != kEmpty) slot_of(slot.cell) = slot;
  }
}

void CoarseSurface::add(const GridTriangle& triangle) {
  GridTriangle snapped = triangle;
  if (!snap(snapped)) return;
  if (triangles_.size() == triangles_.capacity()) {
    triangles_.reserve(std::min(most_, 2 * triangles_.size() + 1024));  // never more than what may be held
  }
  triangles_.push_back(snapped);
  while (is_full() && bits_ < kMostBits) coarsen();
}

// Moves the corners to the points that stand for their cells. Returns false where they lie in fewer than three cells.
bool CoarseSurface::snap(GridTriangle& triangle) {
  if (bits_ == 0) return true;
  const auto corners = corners_of(triangle);
  const std::uint64_t a = cell_of(corners[0], bits_);
  const std::uint64_t b = cell_of(corners[1], bits_);
  const std::uint64_t c = cell_of(corners[2], bits_);
  if (a == b || b == c || c == a) return false;
  for (std::size_t n = 0; n < 3; ++n) {
    std::ranges::copy(cells_.first_in_cell(corners[n], bits_), triangle.begin() + static_cast<std::ptrdiff_t>(3 * n));
  }
  return true;
}

// A surface has half as many vertices as triangles; noise may have more, which count as well.
bool CoarseSurface::is_full() const { return triangles_.size() >= most_ || 3 * cells_.size() >= 2 * most_; }

// The bits of the narrowest cells that are as wide as the mean of the first edges. Narrower cells would join next to
// nothing.
int CoarseSurface::first_bits() const {
  std::uint64_t sum = 0;
  for (const GridTriangle& t : triangles_) {
    int longest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) longest = std::max(longest, std::abs(t[axis] - t[3 + axis]));
    sum += static_cast<std::uint64_t>(longest);
  }
  const std::uint64_t mean = sum / std::max<std::size_t>(triangles_.size(), 1);
  return std::max(static_cast<int>(std::bit_width(mean)), 1);
}

void CoarseSurface::coarsen() {
  bits_ = bits_ == 0 ? first_bits() : bits_ + 1;
  cells_ = {};
  std::size_t kept = 0;
  std::size_t marked = 0;
  for (std::size_t n = 0; n < triangles_.size(); ++n) {
    GridTriangle triangle = triangles_[n];
    if (snap(triangle)) triangles_[kept++] = triangle;
    if (n + 1 == marked_) marked = kept;
  }
  triangles_.resize(kept);
  marked_ = marked;
}

}  // namespace isoweave::cli
