// The case table: what makes the surface an oriented manifold, checked over all cases.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "extract/tables.hpp"

namespace isoweave {
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

}  // namespace
}  // namespace isoweave
