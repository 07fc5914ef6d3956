// The vertices of dual marching cubes in a cell (Nielson, 2004): one for each polygon of marching cubes, on all edges
// that the polygon crosses. Around a lattice edge that the surface crosses, the vertices of four cells are joined.
//
// Two cells at an ambiguous face may meet there twice, with the same two polygons: the side between their vertices
// would have four triangles. This happens only where each of the two has no other ambiguous face. Then one of the two
// segments in the face gets a vertex of its own, which lies between the two cells on both of the segment's edges; it
// belongs to the cell above the face.
//
// At the border of an open volume there is nothing around the lattice edges in its faces. A polygon gets a vertex for
// each run of edges inside the volume; where the run is not the whole polygon, the vertex is on the border.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "extract/tables.hpp"

namespace isoweave {

// Sides of a cell, a bit each, in the order of table_rules::kFaces.
using CellSides = std::uint8_t;

struct DualVertex {
  std::uint16_t edges = 0;    // cell edges around which it is joined to the vertices of other cells
  std::uint16_t crossed = 0;  // cell edges of its polygon, or of its segment
  std::uint8_t slot = 0;      // of its id
  bool in_face = false;       // on a segment, not of a polygon
};

// The vertices of a cell, in the order of their numbers. That in a face comes last.
struct DualCell {
  static constexpr std::size_t kMost = 7;

  std::uint8_t count = 0;
  std::array<DualVertex, kMost> vertices{};

  constexpr void add(const DualVertex& vertex) { vertices[count++] = vertex; }
};

namespace dual {

inline constexpr std::uint8_t kFaceSlot = 4;    // of the vertex in a face across x; y and z follow
inline constexpr std::uint8_t kBorderSlot = 8;  // of the first vertex on the border

constexpr std::uint16_t bit_of(int edge) { return static_cast<std::uint16_t>(1U << edge); }

// The edges on the upper slice of a cell.
inline constexpr std::uint16_t kTopEdges = [] {
  std::uint16_t edges = 0;
  for (int edge = 0; edge < kCellEdges; ++edge) {
    if (table_rules::cell_edge(edge).dz == 1) edges |= bit_of(edge);
  }
  return edges;
}();

// The edges that lie in some sides of a cell.
constexpr std::uint16_t edges_in(CellSides sides) {
  std::uint16_t edges = 0;
  for (int edge = 0; edge < kCellEdges; ++edge) {
    for (int face = 0; face < 6; ++face) {
      if ((sides >> face & 1) != 0 && table_rules::on_face(edge, face)) edges |= bit_of(edge);
    }
  }
  return edges;
}

// The edges of the segment in an ambiguous face that may get a vertex: it is the one at the first of the two inside
// corners.
constexpr std::uint16_t segment_in(int inside, int face) {
  int corner = 8;
  for (const int c : table_rules::kFaces[face]) {
    if ((inside >> c & 1) != 0 && c < corner) corner = c;
  }
  std::uint16_t edges = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis != face / 2) edges |= bit_of(table_rules::edge_between(corner, corner ^ 1 << axis));
  }
  return edges;
}

// The face of a case both of whose segments belong to one polygon, or -1.
constexpr int twice_met_face(int inside) {
  int found = -1;
  table_rules::for_polygons(inside, [&](const table_rules::Polygon& polygon) {
    for (int face = 0; face < 6; ++face) {
      int segments = 0;
      for (int n = 0; n < polygon.size; ++n) {
        const int a = polygon.edges[static_cast<std::size_t>(n)];
        const int b = polygon.edges[static_cast<std::size_t>((n + 1) % polygon.size)];
        segments += table_rules::on_face(a, face) && table_rules::on_face(b, face) ? 1 : 0;
      }
      if (segments < 2) continue;
      if (found >= 0) throw "two such faces";
      found = face;
    }
  });
  return found;
}

constexpr std::array<int, 256> make_twice_met_faces() {
  std::array<int, 256> faces{};
  for (int inside = 0; inside < 256; ++inside) {
    faces[static_cast<std::size_t>(inside)] = twice_met_face(inside);
  }
  return faces;
}

// Adds the vertices of a polygon: one for each run of edges that are not `missing`.
constexpr void add_polygon(const table_rules::Polygon& polygon, std::uint8_t number, std::uint16_t missing,
                           std::uint8_t& border_slot, DualCell& out) {
  const auto edge = [&](int n) { return bit_of(polygon.edges[static_cast<std::size_t>(n % polygon.size)]); };
  DualVertex vertex;
  int first_missing = -1;
  for (int n = 0; n < polygon.size; ++n) {
    vertex.crossed |= edge(n);
    if ((edge(n) & missing) != 0) first_missing = n;
  }
  if (first_missing < 0) {
    vertex.edges = vertex.crossed;
    vertex.slot = number;
    out.add(vertex);
    return;
  }
  for (int n = first_missing + 1; n <= first_missing + polygon.size; ++n) {
    if ((edge(n) & missing) == 0) {
      vertex.edges |= edge(n);
    } else if (vertex.edges != 0) {
      vertex.slot = border_slot++;
      out.add(vertex);
      vertex.edges = 0;
    }
  }
}

// The vertices of a cell, some sides of which lie in the border of an open volume. face: the lower face whose vertex
// belongs to the cell, or -1.
constexpr DualCell make_cell(int inside, CellSides border, int face) {
  DualCell out;
  const std::uint16_t missing = edges_in(border);
  std::uint8_t number = 0;
  std::uint8_t border_slot = kBorderSlot;
  table_rules::for_polygons(
      inside, [&](const table_rules::Polygon& polygon) { add_polygon(polygon, number++, missing, border_slot, out); });
  if (face < 0) return out;
  DualVertex vertex;
  vertex.in_face = true;
  vertex.crossed = segment_in(inside, face);
  vertex.edges = static_cast<std::uint16_t>(vertex.crossed & ~missing);
  vertex.slot = vertex.edges == vertex.crossed ? static_cast<std::uint8_t>(kFaceSlot + face / 2) : border_slot;
  if (vertex.edges != 0) out.add(vertex);
  return out;
}

// The vertex of a case on each of its edges, where all polygons are whole.
constexpr std::array<std::array<std::uint8_t, kCellEdges>, 256> make_numbers() {
  std::array<std::array<std::uint8_t, kCellEdges>, 256> numbers{};
  for (int inside = 0; inside < 256; ++inside) {
    std::uint8_t number = 0;
    table_rules::for_polygons(inside, [&](const table_rules::Polygon& polygon) {
      for (int n = 0; n < polygon.size; ++n) {
        const auto edge = static_cast<std::size_t>(polygon.edges[static_cast<std::size_t>(n)]);
        numbers[static_cast<std::size_t>(inside)][edge] = number;
      }
      ++number;
    });
  }
  return numbers;
}

// The vertices of all cases away from the border; with_face: and that in the face that a cell may meet twice, where it
// is a lower one.
constexpr std::array<DualCell, 256> make_cells(bool with_face) {
  std::array<DualCell, 256> cells{};
  for (int inside = 0; inside < 256; ++inside) {
    const int face = with_face ? twice_met_face(inside) : -1;
    cells[static_cast<std::size_t>(inside)] = make_cell(inside, 0, face % 2 == 0 ? face : -1);
  }
  return cells;
}

}  // namespace dual

inline constexpr std::array<int, 256> kTwiceMetFaces = dual::make_twice_met_faces();
inline constexpr std::array<DualCell, 256> kDualCells = dual::make_cells(false);
inline constexpr std::array<DualCell, 256> kDualCellsWithFace = dual::make_cells(true);
inline constexpr std::array<std::array<std::uint8_t, kCellEdges>, 256> kDualNumbers = dual::make_numbers();

// The vertices of a cell of a case: those of the tables, or others at the border of an open volume.
class DualVertices {
 public:
  DualVertices(std::uint8_t inside, CellSides border, int face) {
    cell_ = border == 0 ? &(face < 0 ? kDualCells : kDualCellsWithFace)[inside]
                        : &made_.emplace(dual::make_cell(inside, border, face));
  }
  DualVertices(const DualVertices&) = delete;
  DualVertices& operator=(const DualVertices&) = delete;

  std::size_t size() const { return cell_->count; }
  const DualVertex* begin() const { return cell_->vertices.data(); }
  const DualVertex* end() const { return begin() + size(); }

 private:
  std::optional<DualCell> made_;
  const DualCell* cell_;
};

}  // namespace isoweave
