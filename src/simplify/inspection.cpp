#include "simplify/inspection.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>
#include <vector>

#include "parallel/prefetch.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kInspectedBlock = 256;  // vertices; walks take long

// A walk around a vertex, face by face.
class FanWalk {
 public:
  // corners: the triangles that name v. A walk over more than these ends.
  void begin(const ZoneView& zone, Index v, std::uint32_t corners) {
    vertex_ = v;
    corners_ = corners;
    faces_ = 0;
    neighbours_.clear();
    first_ = at_ = zone.vertices[v].half_edge;
    prefetch(&zone.half(at_));
  }

  // Takes one face, and fetches the next one. Returns whether there is one to take.
  bool step(const ZoneView& zone) {
    neighbours_.push_back(zone.destination(at_));
    const Index back = zone.rotate(at_);
    if (!exists(back)) neighbours_.push_back(zone.origin(previous(at_)));
    if (++faces_ > corners_ || back == first_ || !exists(back)) return false;
    prefetch(&zone.half(back));
    at_ = back;
    return true;
  }

  // The defects that the walk has found once it is over.
  SurfaceDefects defects() {
    SurfaceDefects found;
    found.nonmanifold_vertices = faces_ != corners_ ? 1 : 0;
    std::sort(neighbours_.begin(), neighbours_.end());
    for (std::size_t m = 1; m < neighbours_.size(); ++m) {
      if (neighbours_[m] == neighbours_[m - 1] && vertex_ < neighbours_[m]) ++found.nonmanifold_edges;
    }
    return found;
  }

 private:
  Index vertex_ = kNone;
  Index first_ = kNone;
  Index at_ = kNone;
  std::uint32_t corners_ = 0;
  std::uint32_t faces_ = 0;
  std::vector<Index> neighbours_;
};

// Several walks that take turns: while one waits for memory, the others go on.
class FanWalks {
 public:
  static constexpr std::size_t kCount = 8;

  SurfaceDefects inspect(const ZoneView& zone, std::span<const Index> vertices,
                         std::span<const std::uint32_t> corners) {
    for (std::size_t n = 0; n < vertices.size(); ++n) walks_[n].begin(zone, vertices[n], corners[vertices[n]]);
    std::array<std::uint8_t, kCount> going;
    std::iota(going.begin(), going.end(), std::uint8_t{0});
    SurfaceDefects found;
    for (std::size_t count = vertices.size(); count > 0;) {
      for (std::size_t n = 0; n < count;) {
        if (walks_[going[n]].step(zone)) {
          ++n;
          continue;
        }
        found += walks_[going[n]].defects();
        going[n] = going[--count];
      }
    }
    return found;
  }

 private:
  std::array<FanWalk, kCount> walks_;
};

}  // namespace

SurfaceDefects inspect_fans(const ZoneView& zone, std::span<const Index> vertices,
                            std::span<const std::uint32_t> corners, const Executor& executor) {
  std::atomic<std::uint64_t> bad_vertices{0};
  std::atomic<std::uint64_t> bad_edges{0};
  const auto prefetch_starts = [&](std::span<const Index> next) {
    for (const Index v : next) prefetch(&zone.vertices[v].half_edge);
  };
  executor.for_blocks(
      static_cast<std::int64_t>(vertices.size()), kInspectedBlock, [&](std::int64_t begin, std::int64_t end) {
        auto left = vertices.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
        SurfaceDefects found;
        FanWalks walks;
        while (!left.empty()) {
          const std::span<const Index> now = left.first(std::min(FanWalks::kCount, left.size()));
          left = left.subspan(now.size());
          prefetch_starts(left.first(std::min(FanWalks::kCount, left.size())));
          found += walks.inspect(zone, now, corners);
        }
        bad_vertices += found.nonmanifold_vertices;
        bad_edges += found.nonmanifold_edges;
      });
  return {bad_edges, bad_vertices};
}

}  // namespace isoweave
