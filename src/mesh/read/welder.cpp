#include "mesh/read/welder.hpp"

#include <bit>

namespace isoweave {
namespace {

constexpr std::uint32_t kFree = Welder::kMostPoints;
constexpr std::size_t kFewestSlots = 1024;

// Adding 0 turns -0 into 0, which compares equal and must hash equal.
std::uint64_t hash(const Point& point) {
  std::uint64_t state = 0;
  for (const float coordinate : point) {
    state = (state ^ std::bit_cast<std::uint32_t>(coordinate + 0.0F)) * 0x9e3779b97f4a7c15U;
    state ^= state >> 32;
  }
  return state;
}

}  // namespace

Welder::Welder(std::vector<Point>& points) : points_(points), slots_(kFewestSlots, kFree) {}

std::uint32_t Welder::number(const Point& point) {
  if (2 * points_.size() >= slots_.size()) grow();
  std::uint32_t& slot = find(point);
  if (slot == kFree && points_.size() < kMostPoints) {
    slot = static_cast<std::uint32_t>(points_.size());
    points_.push_back(point);
  }
  return slot;
}

// The slot that holds an equal point, or the free one where it belongs.
std::uint32_t& Welder::find(const Point& point) {
  std::size_t at = static_cast<std::size_t>(hash(point)) & (slots_.size() - 1);
  while (slots_[at] != kFree && points_[slots_[at]] != point) at = (at + 1) & (slots_.size() - 1);
  return slots_[at];
}

void Welder::grow() {
  slots_.assign(2 * slots_.size(), kFree);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    find(points_[i]) = static_cast<std::uint32_t>(i);
  }
}

}  // namespace isoweave
