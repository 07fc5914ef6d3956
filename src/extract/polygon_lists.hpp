// Polygons of marching cubes that are to get their diagonals, in lists by their number of corners.
//
// Cell after cell nobody could predict how many corners the next polygon has, nor how many polygons a cell. Within a
// list all take the same way.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "extract/choose_diagonals.hpp"
#include "extract/vertex_places.hpp"

namespace isoweave {

class PolygonLists {
 public:
  explicit PolygonLists(const VertexPlaces& places) : place_(places) {}

  // Adds the polygons of a cell, whose triangles have such corners. The corners must stay where they are until the
  // diagonals have been chosen.
  void add(std::uint32_t cell, std::uint32_t* corners) {
    const std::size_t end = kChoicePolygons.first[cell + 1];
    std::size_t n = kChoicePolygons.first[cell];
    add(kChoicePolygons.polygons[n], corners, n < end);  // often there is none
    while (++n < end) add(kChoicePolygons.polygons[n], corners, true);
  }

  // Makes room for the polygons of 64 cells: chooses the diagonals of lists that may have none.
  void make_room() { choose_where_more_than(kRoom - kOfWord); }

  // Chooses the diagonals of all polygons.
  void choose() { choose_where_more_than(0); }

 private:
  struct Entry {
    std::uint32_t* corners;  // of its triangles
    const ChoicePolygon* polygon;
  };

  static constexpr std::size_t kOfWord = 64 * ChoicePolygons::kMostOfCase + 1;  // one is written and not kept
  static constexpr std::size_t kRoom = 256;

  struct List {
    std::size_t count = 0;
    std::array<Entry, kRoom> entries;
  };

  // Adds a polygon if it is there.
  void add(const ChoicePolygon& polygon, std::uint32_t* corners, bool is_there) {
    List& list = lists_[(polygon.size - 4U) % lists_.size()];
    list.entries[list.count] = {corners + 3U * polygon.first, &polygon};
    list.count += is_there ? 1 : 0;
  }

  void choose_where_more_than(std::size_t count) {
    const auto choose = [&](List& list, const auto& choose_one) {
      if (list.count <= count) return;
      for (const Entry& entry : std::span(list.entries).first(list.count)) {
        choose_one(*entry.polygon, [&](std::size_t at) -> std::uint32_t& { return entry.corners[at]; });
      }
      list.count = 0;
    };
    choose(lists_[0], [&](const auto& polygon, const auto& vertex) { choose_diagonal(polygon, vertex, place_); });
    choose(lists_[1], [&](const auto& polygon, const auto& vertex) { cut_ear(polygon, vertex, place_); });
    choose(lists_[2],
           [&](const auto& polygon, const auto& vertex) { choose_diagonals_of<6>(polygon, vertex, place_); });
    choose(lists_[3],
           [&](const auto& polygon, const auto& vertex) { choose_diagonals_of<7>(polygon, vertex, place_); });
  }

  VertexPlaces place_;
  std::array<List, 4> lists_;  // of four to seven corners
};

}  // namespace isoweave
