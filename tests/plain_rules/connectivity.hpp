// Which triangles meet at each corner, and the rings of corners around it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "plain_rules/simplifier.hpp"

namespace isoweave::plain {

// The neighbours of a corner, counter-clockwise. Between two that follow each other lies a face; in a closed ring there
// is one between the last and the first as well.
struct Ring {
  std::vector<std::size_t> around{};
  bool open = false;

  std::size_t faces() const { return around.size() - (open ? 1 : 0); }
  std::size_t after(std::size_t n) const { return around[(n + 1) % around.size()]; }
  bool has(std::size_t corner) const { return std::find(around.begin(), around.end(), corner) != around.end(); }
};

class Connectivity {
 public:
  explicit Connectivity(const Surface& surface);

  std::size_t left() const { return left_; }  // triangles
  std::vector<std::array<std::size_t, 3>> triangles() const;

  // Whether a triangle names the corner.
  bool uses(std::size_t v) const { return !around_[v].empty(); }

  // Begins at `first`, an open one where no face lies before it.
  Ring ring_of(std::size_t v, std::size_t first) const;

  // A closed ring begins at the corner with the smallest id.
  Ring ring_of(std::size_t v) const;

  // Where an edge has more than one face on a side, or the faces of a corner are more than one fan.
  std::vector<bool> locked_corners() const;

  // The triangles of a corner go.
  void remove_around(std::size_t v);

  // The triangles that have both corners go, and `into` takes the place of `gone` in the others.
  void merge(std::size_t gone, std::size_t into);

 private:
  std::array<std::size_t, 2> others(std::size_t t, std::size_t v) const;
  void remove(std::size_t t);

  std::vector<std::uint64_t> ids_;  // of each corner
  std::vector<std::array<std::size_t, 3>> triangles_;
  std::vector<bool> alive_;
  std::size_t left_;
  std::vector<std::set<std::size_t>> around_;  // triangles of each corner
};

}  // namespace isoweave::plain
