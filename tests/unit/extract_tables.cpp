// The case table: what makes the surface an oriented manifold, checked over all cases.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "extract/polygon_lists.hpp"

namespace isoweave::testing::extract_tables_test {
namespace {

using table_rules::share_face;

std::array<int, 3> ends(int edge) {
  const CellEdge e = kEdgeTable[static_cast<std::size_t>(edge)];
  const int low = e.dx + 2 * e.dy + 4 * e.dz;
  return {low, low + (1 << e.axis), e.axis};
}

TEST(CaseTable, UsesExactlyTheCrossedEdges) {
  for (int inside = 0; inside < 256; ++inside) {
    const CellCase& shape = kCaseTable[static_cast<std::size_t>(inside)];
    std::set<int> used(shape.edges.begin(), shape.edges.begin() + 3 * shape.triangles);
    std::set<int> crossed;
    for (int edge = 0; edge < kCellEdges; ++edge) {
      const auto [low, high, axis] = ends(edge);
      if ((inside >> low & 1) != (inside >> high & 1)) crossed.insert(edge);
    }
    EXPECT_EQ(used, crossed) << "case " << inside;
  }
}

// Sides inside the cell are used once in each direction; sides on a cell face once, and never a diagonal inside a face
// that both of its triangles share: that would be a second use.
TEST(CaseTable, InnerSidesPairUpAndOuterSidesLieOnFaces) {
  for (int inside = 0; inside < 256; ++inside) {
    const CellCase& shape = kCaseTable[static_cast<std::size_t>(inside)];
    std::map<std::pair<int, int>, int> sides;
    for (std::size_t t = 0; t < shape.triangles; ++t) {
      for (std::size_t c = 0; c < 3; ++c) ++sides[{shape.edges[3 * t + c], shape.edges[3 * t + (c + 1) % 3]}];
    }
    for (const auto& [side, uses] : sides) {
      EXPECT_EQ(uses, 1) << "case " << inside;
      const bool paired = sides.count({side.second, side.first}) > 0;
      EXPECT_NE(paired, share_face(side.first, side.second)) << "case " << inside;
    }
  }
}

// Both cells at a face must draw the same segments, in opposite directions.
TEST(CaseTable, NeighboursDrawTheSameSegmentsOnTheSharedFace) {
  const auto segments = [](int inside, int axis, int side) {
    std::set<std::pair<int, int>> found;
    const CellCase& shape = kCaseTable[static_cast<std::size_t>(inside)];
    const auto on_face = [&](int edge) {
      const auto [low, high, along] = ends(edge);
      return along != axis && (low >> axis & 1) == side;
    };
    const auto flatten = [&](int edge) {
      return edge - (side != 0
                         ? edge - table_rules::edge_between(ends(edge)[0] & ~(1 << axis), ends(edge)[1] & ~(1 << axis))
                         : 0);
    };
    for (std::size_t t = 0; t < shape.triangles; ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        const int a = shape.edges[3 * t + c], b = shape.edges[3 * t + (c + 1) % 3];
        if (on_face(a) && on_face(b)) found.insert({flatten(a), flatten(b)});
      }
    }
    return found;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (int left = 0; left < 256; ++left) {
      for (int far = 0; far < 16; ++far) {
        int right = 0;  // its near face has the corners of left's far face, its far face any
        for (int corner = 0, n = 0; corner < 8; ++corner) {
          if ((corner >> axis & 1) != 0) {
            right |= (far >> n++ & 1) << corner;
          } else {
            right |= (left >> (corner | 1 << axis) & 1) << corner;
          }
        }
        std::set<std::pair<int, int>> turned;
        for (const auto& [a, b] : segments(right, axis, 0)) turned.insert({b, a});
        ASSERT_EQ(segments(left, axis, 1), turned) << "axis " << axis << ", cases " << left << " and " << right;
      }
    }
  }
}

TEST(CaseTable, FacesOutwards) {
  const CellCase& corner = kCaseTable[1];
  ASSERT_EQ(corner.triangles, 1);
  EXPECT_EQ(corner.edges[0], 0);  // x, y, z: counter-clockwise seen from (1, 1, 1)
  EXPECT_EQ(corner.edges[1], 4);
  EXPECT_EQ(corner.edges[2], 8);
}

using Polygon = std::vector<std::uint32_t>;

// The least sum of squared diagonals of a polygon over all its triangulations: one triangle is at its last side.
double least_sum(const Polygon& polygon, const std::vector<Vec3>& places, const std::vector<int>& edges) {
  const auto weigh = [&](std::size_t a, std::size_t b) {
    if (a + 1 == b) return 0.0;
    const std::uint32_t first = polygon[a], second = polygon[b];
    const bool side = second == first + 1 || (first == 0 && second + 1 == edges.size());
    if (side) return 0.0;
    return share_face(edges[first], edges[second]) ? 1e30 : squared_distance(places[first], places[second]);
  };
  if (polygon.size() < 3) return 0;
  double best = 1e30;
  for (std::size_t apex = 1; apex + 1 < polygon.size(); ++apex) {
    const Polygon left(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(apex) + 1);
    const Polygon right(polygon.begin() + static_cast<std::ptrdiff_t>(apex), polygon.end());
    best = std::min(best, weigh(0, apex) + weigh(apex, polygon.size() - 1) + least_sum(left, places, edges) +
                              least_sum(right, places, edges));
  }
  return best;
}

// The squared diagonals of five corners where the ear, the only one between two parallel edges and parallel to them, is
// cut off, and the rest has the shorter diagonal.
double sum_without_ear(const std::vector<Vec3>& places, const std::vector<int>& edges) {
  const auto axis = [&](std::size_t n) { return ends(edges[n % 5])[2]; };
  double sum = 0;
  int ears = 0;
  for (std::size_t a = 0; a < 5; ++a) {
    if (axis(a) != axis(a + 1) || axis(a) != axis(a + 4)) continue;
    const auto squared = [&](std::size_t m, std::size_t n) {
      return squared_distance(places[(a + m) % 5], places[(a + n) % 5]);
    };
    EXPECT_FALSE(share_face(edges[(a + 1) % 5], edges[(a + 4) % 5]));
    EXPECT_FALSE(share_face(edges[(a + 1) % 5], edges[(a + 3) % 5]));
    EXPECT_FALSE(share_face(edges[(a + 2) % 5], edges[(a + 4) % 5]));
    sum = squared(1, 4) + std::min(squared(1, 3), squared(2, 4));
    ++ears;
  }
  EXPECT_EQ(ears, 1);
  return sum;
}

// The squared lengths of the diagonals of triangles: a diagonal is a side that two of them share.
double sum_of_diagonals(const std::vector<std::uint32_t>& corners, const std::vector<Vec3>& places) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const std::uint32_t a = corners[c], b = corners[c % 3 == 2 ? c - 2 : c + 1];
    ++uses[{std::min(a, b), std::max(a, b)}];
  }
  double sum = 0;
  for (const auto& [side, count] : uses)
    sum += count == 2 ? squared_distance(places[side.first], places[side.second]) : 0;
  return sum;
}

TEST(Diagonals, AreTheShortestButForEars) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> place(0, 1);
  for (int inside = 0; inside < 256; ++inside) {
    std::size_t next = kChoicePolygons.first[static_cast<std::size_t>(inside)];
    table_rules::for_polygons(inside, [&](const table_rules::Polygon& own) {
      if (own.size < 4) return;
      const ChoicePolygon& polygon = kChoicePolygons.polygons[next++];
      ASSERT_EQ(polygon.size, own.size);
      const std::vector<int> edges(own.edges.begin(), own.edges.begin() + own.size);
      Polygon numbers(edges.size());
      std::vector<Vec3> places(edges.size());
      for (std::size_t n = 0; n < edges.size(); ++n) {
        numbers[n] = static_cast<std::uint32_t>(n);
        places[n] = {place(random), place(random), place(random)};
      }
      std::vector<std::uint32_t> corners(3 * (edges.size() - 2), 99);
      const CellCase& shape = kCaseTable[static_cast<std::size_t>(inside)];
      for (std::size_t c = 0; c < corners.size(); ++c) {
        const auto edge = std::ranges::find(edges, int{shape.edges[3U * polygon.first + c]});
        corners[c] = static_cast<std::uint32_t>(edge - edges.begin());
      }
      choose_diagonals(
          polygon, [&](std::size_t at) -> std::uint32_t& { return corners[at]; },
          [&](std::uint32_t v) -> const Vec3& { return places[v]; });
      double expected = least_sum(numbers, places, edges);
      if (edges.size() == 5) expected = sum_without_ear(places, edges);
      EXPECT_NEAR(sum_of_diagonals(corners, places), expected, 1e-12) << "case " << inside;
    });
    EXPECT_EQ(next, kChoicePolygons.first[static_cast<std::size_t>(inside) + 1]);
  }
}

// Random cells one after the other, and the corners of their triangles: numbers of vertices at random places.
struct RandomCells {
  static constexpr std::size_t kVertices = 500;

  std::vector<std::uint8_t> cells;
  std::vector<std::uint32_t> corners;
  std::vector<Vec3> places{kVertices};

  RandomCells(std::size_t count, std::mt19937& random) {
    std::uniform_real_distribution<double> coordinate(0, 1);
    for (Vec3& place : places) place = {coordinate(random), coordinate(random), coordinate(random)};
    for (; count > 0; --count) {
      cells.push_back(static_cast<std::uint8_t>(1 + random() % 254));
      const CellCase& shape = kCaseTable[cells.back()];
      const auto first = static_cast<std::uint32_t>(random() % (kVertices - kCellEdges));
      for (std::size_t c = 0; c < 3U * shape.triangles; ++c) corners.push_back(first + shape.edges[c]);
    }
  }

  // The corners after the polygons have got their diagonals one after the other.
  std::vector<std::uint32_t> one_after_the_other() const {
    std::vector<std::uint32_t> out = corners;
    std::size_t at = 0;
    for (const std::uint8_t cell : cells) {
      for (std::size_t n = kChoicePolygons.first[cell]; n < kChoicePolygons.first[cell + 1U]; ++n) {
        const ChoicePolygon& polygon = kChoicePolygons.polygons[n];
        const auto corner = [&](std::size_t c) -> std::uint32_t& { return out[at + 3U * polygon.first + c]; };
        choose_diagonals(polygon, corner, [&](std::uint32_t v) -> const Vec3& { return places[v]; });
      }
      at += 3U * kCaseTable[cell].triangles;
    }
    return out;
  }
};

TEST(PolygonLists, GiveTheDiagonalsThatPolygonsGetOneAfterTheOther) {
  constexpr std::size_t kInherited = 100;
  std::mt19937 random(22);
  for (const std::size_t words : {1U, 3U, 20U}) {
    RandomCells row(64 * words, random);
    const std::vector<std::uint32_t> expected = row.one_after_the_other();
    PolygonLists polygons(VertexPlaces({row.places.data(), kInherited}, row.places.data() + kInherited));
    std::uint32_t* corners = row.corners.data();
    for (std::size_t n = 0; n < row.cells.size(); ++n) {
      polygons.add(row.cells[n], corners);
      corners += 3U * kCaseTable[row.cells[n]].triangles;
      if (n % 64 == 63) polygons.make_room();
    }
    polygons.choose();
    EXPECT_EQ(row.corners, expected) << words << " words";
  }
}

}  // namespace
}  // namespace isoweave::testing::extract_tables_test
