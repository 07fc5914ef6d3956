#include "extract/dual_cubes.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

#include "extract/cell_cases.hpp"
#include "extract/dual_place.hpp"
#include "extract/shortest_diagonals.hpp"
#include "parallel/atomics.hpp"
#include "parallel/size.hpp"

namespace isoweave {
namespace {

bool is_incomplete(const DualVertex& vertex) { return (vertex.edges & dual::kTopEdges) != 0; }

// The number of the cell edge along an axis at an offset of 0 or 1 along the two axes that follow it.
int edge_along(int axis, int u, int v) {
  return axis == 1 ? 4 + v + 2 * u : 4 * axis + u + 2 * v;  // cell edges are in the order of x before z before y
}

std::vector<std::uint64_t> inner_points(const CellSlab& slab) {
  std::vector<std::uint64_t> mask(slab.words(), slab.rule().closed ? ~std::uint64_t{0} : 0);
  if (slab.rule().closed) return mask;
  for (std::int64_t bit = 2; bit < slab.dims()[0]; ++bit) {
    mask[static_cast<std::size_t>(bit >> 6)] |= std::uint64_t{1} << (bit & 63);
  }
  return mask;
}

bool is_inner(std::int64_t at, std::int64_t size, bool closed) { return closed || (at > 0 && at + 1 < size); }

}  // namespace

DualCubes::DualCubes(const VolumeInfo& volume, const ExtractOptions& options, const Executor& executor)
    : numbering_(VertexNumbering::of_dual_cubes(options.whole(volume))),
      first_(options.part_of.value_or(PartOfLattice{}).first),
      spacing_(volume.geometry.spacing),
      options_(options),
      slab_(volume, options.rule, options.cells_of(volume), 1, executor),
      inner_points_(inner_points(slab_)) {}

// Gradients look one slice further, and those of the layer below the slab are asked for again.
std::pair<std::int64_t, std::int64_t> DualCubes::slices_for(std::int64_t layers) const {
  return {slab_.next_layer() - 2, slab_.next_layer() + layers + 2};
}

SlabCounts DualCubes::extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                              SurfacePiece& piece) {
  piece.clear();
  auto count = to_size(layers);
  slab_.classify(window, count);
  planes_.find(slab_, count + 2);
  find_cells(count);
  piece.inherited = number_inherited();
  count_rows(count);
  count = layers_within(rows_, slab_.rows(), most_vertices);
  rows_.resize(count * slab_.rows());
  make_room(rows_, count, options_.normals, piece);
  planes_.make(slab_, window, spacing_, count + 2);
  make_vertices(count, piece);
  slab_.for_rows(count, [&](std::size_t n, std::size_t row, std::size_t) { write_triangles({n + 1, row}, piece); });
  slab_.advance(count);
  front_size_ = 0;
  if (layers_left() > 0) {
    list_front(count, piece);
    piece.complete_below = static_cast<double>(first_[2] + slab_.next_layer() - 1) * spacing_[2];
  }
  return {static_cast<std::int64_t>(count), piece.cells_crossed, piece.triangles.size(), piece.positions.size()};
}

// Lists the crossed cells of the slab and of the layer below it.
void DualCubes::find_cells(std::size_t layers) {
  const std::size_t words = to_size(to_size(layers + 1, slab_.rows()), slab_.words());
  crossed_.resize(words);
  first_cell_.resize(words);
  slab_.for_rows(layers + 1, [&](std::size_t layer, std::size_t row, std::size_t number) {
    slab_.find_crossed(slice_of({layer, row}), row, std::span(&crossed_[number * slab_.words()], slab_.words()));
  });
  std::uint64_t cells = 0;
  for (std::size_t w = 0; w < words; ++w) {
    first_cell_[w] = static_cast<std::uint32_t>(cells);
    cells += ones(crossed_[w]);
  }
  require_numbers(layers, cells, "cells of the surface");
  cells_.resize(to_size(cells));
  slab_.for_rows(layers + 1, [&](std::size_t layer, std::size_t row, std::size_t) { fill_cells({layer, row}); });
}

// Calls visit(bit of the row, cell) for the crossed cells of a row.
template <class Visit>
void DualCubes::for_cells_of(const Row& at, const Visit& visit) {
  for (std::size_t w = 0; w < slab_.words(); ++w) {
    const std::size_t word = number_of(at) * slab_.words() + w;
    std::uint32_t cell = first_cell_[word];
    for (std::uint64_t bits = crossed_[word]; bits != 0; bits &= bits - 1) {
      visit(static_cast<std::ptrdiff_t>(64 * w) + std::countr_zero(bits), cells_[cell++]);
    }
  }
}

void DualCubes::fill_cells(const Row& at) {
  for_cells_of(at, [&](std::ptrdiff_t bit, Cell& cell) {
    const int inside = case_of(at, bit);
    cell = {0, static_cast<std::uint8_t>(inside), border_of(at, bit), 0};
    cell.face = static_cast<std::int8_t>(face_of(at, bit, cell));
  });
}

// The case of the cell whose corner 0 is a bit of a row.
int DualCubes::case_of(const Row& at, std::ptrdiff_t bit) const {
  const auto rows = slab_.rows_around(slice_of(at), at.row);
  int inside = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const auto b = static_cast<std::size_t>(bit + corner % 2);
    inside |= static_cast<int>(rows[static_cast<std::size_t>(corner / 2)][b / 64] >> (b % 64) & 1) << corner;
  }
  return inside;
}

// The sides of a cell that lie in the border of an open volume.
CellSides DualCubes::border_of(const Row& at, std::ptrdiff_t bit) const {
  if (options_.rule.closed) return 0;
  const std::array<std::int64_t, 3> low{bit - 1, static_cast<std::int64_t>(at.row) - 1,
                                        slab_.next_layer() + slice_of(at)};
  unsigned sides = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (low[axis] == 0) sides |= 1U << (2 * axis);
    if (low[axis] + 2 == slab_.dims()[axis]) sides |= 2U << (2 * axis);
  }
  return static_cast<CellSides>(sides);
}

// The lower face of a cell that its polygon and that of the cell behind it meet twice, or -1. Below the slab those
// between slices are not looked for: their vertices are complete.
int DualCubes::face_of(const Row& at, std::ptrdiff_t bit, const Cell& cell) const {
  const int face = kTwiceMetFaces[cell.inside];
  const bool is_lower = face >= 0 && face % 2 == 0 && (cell.border >> face & 1) == 0;
  if (!is_lower || (face == 4 && at.layer == 0)) return -1;
  const Row behind{at.layer - (face == 4 ? 1 : 0), at.row - (face == 2 ? 1 : 0)};
  const int other = case_of(behind, bit - (face == 0 ? 1 : 0));
  return kTwiceMetFaces[static_cast<std::size_t>(other)] == face + 1 ? face : -1;
}

const DualCubes::Cell& DualCubes::cell_at(const Row& at, std::ptrdiff_t bit) const {
  const auto b = static_cast<std::size_t>(bit);
  const std::size_t word = number_of(at) * slab_.words() + b / 64;
  const std::uint64_t before = crossed_[word] & ((std::uint64_t{1} << b % 64) - 1);
  return cells_[first_cell_[word] + ones(before)];
}

// Numbers the incomplete vertices of the layer below the slab. Returns how many there are.
std::uint32_t DualCubes::number_inherited() {
  std::uint32_t count = 0;
  for (std::size_t row = 0; row < slab_.rows(); ++row) {
    for_cells_of({0, row}, [&](std::ptrdiff_t, Cell& cell) {
      cell.first = count;
      for (const DualVertex& vertex : vertices_of(cell)) count += is_incomplete(vertex) ? 1U : 0U;
    });
  }
  front_places_.resize(count);
  return count;
}

// Lists the incomplete vertices of the slab's last layer, in the order in which number_inherited() will number them.
void DualCubes::list_front(std::size_t layer, SurfacePiece& piece) {
  for (std::size_t row = 0; row < slab_.rows(); ++row) {
    for_cells_of({layer, row}, [&](std::ptrdiff_t, const Cell& cell) {
      std::uint32_t number = cell.first;
      for (const DualVertex& vertex : vertices_of(cell)) {
        if (is_incomplete(vertex)) piece.incomplete.push_back(number);
        ++number;
      }
    });
  }
  front_size_ = static_cast<std::uint32_t>(piece.incomplete.size());
}

// Counts the vertices and triangles of every row of the slab.
void DualCubes::count_rows(std::size_t layers) {
  rows_.assign(to_size(layers, slab_.rows()), {});
  extra_.assign(to_size(layers + 1, slab_.rows()), 0);
  slab_.for_rows(layers + 1, [&](std::size_t layer, std::size_t row, std::size_t) { count_vertices({layer, row}); });
  slab_.for_rows(layers, [&](std::size_t n, std::size_t row, std::size_t number) {
    std::uint32_t edges = 0;
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t w = 0; w < slab_.words(); ++w) edges += ones(crossings({n + 1, row}, axis, w));
    }
    rows_[number].triangles = 2 * edges + extra_[number + slab_.rows()];
  });
}

// Counts the vertices of a row of cells; and one triangle more at each edge that has a vertex in a face beside it.
void DualCubes::count_vertices(const Row& at) {
  RowCounts counts;
  for_cells_of(at, [&](std::ptrdiff_t, const Cell& cell) {
    ++counts.cells;
    for (const DualVertex& vertex : vertices_of(cell)) {
      ++counts.vertices;
      counts.on_border += vertex.slot >= dual::kBorderSlot ? 1U : 0U;
      if (vertex.in_face) add_extra(at, vertex);
    }
  });
  if (at.layer > 0) rows_[number_of(at) - slab_.rows()] = counts;
}

void DualCubes::add_extra(const Row& at, const DualVertex& vertex) {
  for (unsigned edges = vertex.edges; edges != 0; edges &= edges - 1) {
    const CellEdge edge = kEdgeTable[static_cast<std::size_t>(std::countr_zero(edges))];
    const std::size_t number = number_of({at.layer + edge.dz, at.row + edge.dy});
    if (number < extra_.size()) fetch_add(extra_[number], std::uint32_t{1});
  }
}

// The crossings of the edges along an axis that begin in word w of a row of points, where four cells are around them.
std::uint64_t DualCubes::crossings(const Row& at, int axis, std::size_t w) const {
  const bool closed = options_.rule.closed;
  const bool inner_row = is_inner(static_cast<std::int64_t>(at.row) - 1, slab_.dims()[1], closed);
  const bool inner_slice = is_inner(slab_.next_layer() + slice_of(at), slab_.dims()[2], closed);
  if ((axis != 1 && !inner_row) || (axis != 2 && !inner_slice)) return 0;
  const std::uint64_t crossed = planes_.along(static_cast<std::size_t>(axis), at.layer, at.row)[w];
  return axis == 0 ? crossed : crossed & inner_points_[w];
}

// Makes the vertices in a cell.
class DualCubes::VertexMaker {
 public:
  VertexMaker(const DualCubes& cubes, const Row& at, std::ptrdiff_t bit)
      : cubes_(cubes),
        at_(at),
        bit_(static_cast<std::size_t>(bit)),
        low_{cubes.first_[0] + bit - 1, cubes.first_[1] + static_cast<std::int64_t>(at.row) - 1,
             cubes.first_[2] + cubes.slab_.next_layer() + cubes.slice_of(at)} {}

  Vec3 place(const DualVertex& vertex) const {
    const auto& spacing = cubes_.spacing_;
    const TangentPlanes planes = planes_of(vertex);
    const Vec3 at = vertex.in_face ? planes.mean() : planes.best();
    Vec3 in_cell{at.x / spacing[0], at.y / spacing[1], at.z / spacing[2]};
    if (!vertex.in_face) in_cell = {within_cell(in_cell.x), within_cell(in_cell.y), within_cell(in_cell.z)};
    return {(static_cast<double>(low_[0]) + in_cell.x) * spacing[0],
            (static_cast<double>(low_[1]) + in_cell.y) * spacing[1],
            (static_cast<double>(low_[2]) + in_cell.z) * spacing[2]};
  }

  Point normal(const DualVertex& vertex) const { return unit_point(planes_of(vertex).normal()); }

  std::uint64_t id(const DualVertex& vertex) const {
    return cubes_.numbering_.id(low_[0], low_[1], low_[2], vertex.slot);
  }

 private:
  // The planes at the crossings of a vertex, relative to the cell.
  TangentPlanes planes_of(const DualVertex& vertex) const {
    TangentPlanes planes;
    for (unsigned edges = vertex.crossed; edges != 0; edges &= edges - 1) {
      const CellEdge& edge = kEdgeTable[static_cast<std::size_t>(std::countr_zero(edges))];
      const CrossingPlane& plane =
          cubes_.planes_.plane(edge.axis, at_.layer + edge.dz, at_.row + edge.dy, bit_ + edge.dx);
      std::array<double, 3> at{double(edge.dx), double(edge.dy), double(edge.dz)};
      at[edge.axis] += plane.t;
      planes.add({at[0] * cubes_.spacing_[0], at[1] * cubes_.spacing_[1], at[2] * cubes_.spacing_[2]},
                 {plane.normal[0], plane.normal[1], plane.normal[2]});
    }
    return planes;
  }

  const DualCubes& cubes_;
  Row at_;
  std::size_t bit_;
  std::array<std::int64_t, 3> low_;  // sample of the whole
};

// Makes the vertices of the slab, and the places of the inherited ones again.
void DualCubes::make_vertices(std::size_t layers, SurfacePiece& piece) {
  slab_.for_rows(1, [&](std::size_t, std::size_t row, std::size_t) { make_front({0, row}); });
  slab_.for_rows(layers, [&](std::size_t layer, std::size_t row, std::size_t number) {
    std::size_t next = rows_[number].vertices;
    const Row at{layer + 1, row};
    for_cells_of(at, [&](std::ptrdiff_t bit, Cell& cell) {
      cell.first = piece.inherited + static_cast<std::uint32_t>(next);
      const VertexMaker maker(*this, at, bit);
      for (const DualVertex& vertex : vertices_of(cell)) {
        piece.positions[next] = maker.place(vertex);
        piece.ids[next] = maker.id(vertex);
        if (options_.normals) piece.normals[next] = maker.normal(vertex);
        ++next;
      }
    });
  });
}

// Makes the places of the inherited vertices in a row of cells again.
void DualCubes::make_front(const Row& at) {
  for_cells_of(at, [&](std::ptrdiff_t bit, const Cell& cell) {
    const VertexMaker maker(*this, at, bit);
    std::size_t next = cell.first;
    for (const DualVertex& vertex : vertices_of(cell)) {
      if (is_incomplete(vertex)) front_places_[next++] = maker.place(vertex);
    }
  });
}

// The vertices around a lattice edge, and the place of one in a face among them, if there is any.
struct DualCubes::Polygon {
  std::array<std::uint32_t, 6> corners{};
  std::size_t size = 0;
  std::optional<std::size_t> face{};

  std::uint32_t corner(std::size_t n) const { return corners[n % size]; }
  void turn_around() {
    std::reverse(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(size));
    if (face) face = size - 1 - *face;
  }
};

// The cell so many steps down along an axis.
DualCubes::Place DualCubes::moved(const Place& from, int axis, int steps) {
  Place to = from;
  if (axis == 0) to.bit -= steps;
  if (axis == 1) to.at.row -= static_cast<std::size_t>(steps);
  if (axis == 2) to.at.layer -= static_cast<std::size_t>(steps);
  return to;
}

// The number of a cell's vertex that is joined around a cell edge: of the polygon, or of the segment in the cell's
// face.
std::optional<std::uint32_t> DualCubes::vertex_at(const Place& place, int edge, bool in_face) const {
  const Cell& cell = cell_at(place.at, place.bit);
  if (in_face && cell.face < 0) return std::nullopt;
  const bool whole = cell.border == 0 && place.at.layer > 0;
  if (whole && !in_face) return cell.first + kDualNumbers[cell.inside][static_cast<std::size_t>(edge)];
  std::uint32_t number = cell.first;
  for (const DualVertex& vertex : vertices_of(cell)) {
    if (place.at.layer == 0 && !is_incomplete(vertex)) continue;
    if (vertex.in_face == in_face && (vertex.edges >> edge & 1) != 0) return number;
    ++number;
  }
  return std::nullopt;
}

// Goes around a lattice edge counter-clockwise, seen from its higher end: through the four cells, and through a vertex
// in the face between two of them where there is one. It belongs to the upper cell of the two.
DualCubes::Polygon DualCubes::polygon_around(const Place& place, int axis) const {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  constexpr std::array<std::array<int, 2>, 4> kSteps{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};  // down along u and v
  Polygon polygon;
  for (std::size_t n = 0; n < 4; ++n) {
    const auto [du, dv] = kSteps[n];
    const auto [next_du, next_dv] = kSteps[(n + 1) % 4];
    polygon.corners[polygon.size++] = *vertex_at(moved(moved(place, u, du), v, dv), edge_along(axis, du, dv), false);
    const int upper_du = std::min(du, next_du), upper_dv = std::min(dv, next_dv);
    const Place upper = moved(moved(place, u, upper_du), v, upper_dv);
    if (cell_at(upper.at, upper.bit).face != 2 * (du != next_du ? u : v)) continue;
    const auto in_face = vertex_at(upper, edge_along(axis, upper_du, upper_dv), true);
    if (!in_face) continue;
    polygon.face = polygon.size;
    polygon.corners[polygon.size++] = *in_face;
  }
  return polygon;
}

// Writes the triangles around the edges that begin in a row of points.
void DualCubes::write_triangles(const Row& at, SurfacePiece& piece) const {
  auto* out = piece.triangles.data() + rows_[number_of(at) - slab_.rows()].triangles;
  for (std::size_t w = 0; w < slab_.words(); ++w) {
    const std::uint64_t inside = slab_.inside(slice_of(at), at.row)[w];
    for (int axis = 0; axis < 3; ++axis) {
      for (std::uint64_t bits = crossings(at, axis, w); bits != 0; bits &= bits - 1) {
        const int bit = std::countr_zero(bits);
        Polygon polygon = polygon_around({at, static_cast<std::ptrdiff_t>(64 * w) + bit}, axis);
        const std::size_t first = first_corner(polygon, piece);
        if ((inside >> bit & 1) == 0) polygon.turn_around();
        const std::size_t start = (inside >> bit & 1) == 0 ? polygon.size - 1 - first : first;
        for (std::size_t n = 1; n + 1 < polygon.size; ++n) {
          *out++ = {polygon.corner(start), polygon.corner(start + n), polygon.corner(start + n + 1)};
        }
      }
    }
  }
}

// The corner from which all diagonals of a polygon begin: a vertex in a face, which is joined to none of the others
// elsewhere; else an end of the shorter diagonal, and of the one at the least id where they tie.
std::size_t DualCubes::first_corner(const Polygon& polygon, const SurfacePiece& piece) const {
  if (polygon.face) return *polygon.face;
  const auto place = [&](std::size_t n) -> const Vec3& {
    const std::uint32_t number = polygon.corners[n];
    return number < piece.inherited ? front_places_[number] : piece.positions[number - piece.inherited];
  };
  return squared_distance(place(1), place(3)) < squared_distance(place(0), place(2)) ? 1 : 2;
}

void DualCubes::serialize(StateReader& state) {
  slab_.serialize(state);
  front_size_ = 0;
  if (layers_left() == 0) return;
  find_cells(0);
  front_size_ = number_inherited();
}

}  // namespace isoweave
