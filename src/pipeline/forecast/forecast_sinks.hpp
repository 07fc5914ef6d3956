// Sinks of the blocks that a forecast meshes: they keep no mesh.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "isoweave/mesh.hpp"

namespace isoweave {

// Counts triangles.
class CountingSink : public MeshSink {
 public:
  void append(const MeshPiece& piece) override { total += piece.triangles.size(); }
  void finish() override {}

  std::uint64_t total = 0;
};

// Counts the triangles whose first corners lie where they count: where(point).
template <class Where>
class CountWhere final : public MeshSink {
 public:
  explicit CountWhere(const Where& where) : where_(where) {}

  void append(const MeshPiece& piece) override {
    for (const Point& vertex : piece.vertices) counts_.push_back(where_(vertex));
    for (const auto& t : piece.triangles) total += counts_[t[0]] ? 1U : 0U;
  }
  void finish() override {}

  std::uint64_t total = 0;

 private:
  Where where_;
  std::vector<bool> counts_;  // per vertex
};

struct BetweenHeights {
  double from, to;
  bool operator()(const Point& p) const { return p[2] >= from && p[2] < to; }
};

using CountBetween = CountWhere<BetweenHeights>;

// Tells where triangles are, by their first corners in samples: look(i, j, k).
template <class Look>
class LocatingSink final : public MeshSink {
 public:
  LocatingSink(const std::array<double, 3>& spacing, const Look& look) : spacing_(spacing), look_(look) {}

  void append(const MeshPiece& piece) override {
    vertices_.insert(vertices_.end(), piece.vertices.begin(), piece.vertices.end());
    for (const auto& t : piece.triangles) {
      const Point& at = vertices_[t[0]];
      look_(double{at[0]} / spacing_[0], double{at[1]} / spacing_[1], double{at[2]} / spacing_[2]);
    }
  }
  void finish() override {}

 private:
  const std::array<double, 3>& spacing_;
  const Look& look_;
  std::vector<Point> vertices_;
};

}  // namespace isoweave
