// Marching cubes over a slab on a device: passes with one thread for every word of 64 lattice points. The rules and the
// numbering are those of extract/marching_cubes.hpp: vertices and triangles come in the same order.
#pragma once

#include <bit>

#include "extract/choose_diagonals.hpp"
#include "extract/cube_rules.hpp"
#include "extract/gradient.hpp"
#include "extract/tables.hpp"
#include "lattice/vertex_numbering.hpp"
#include "simplify/zone_view.hpp"

namespace isoweave {

ISOWEAVE_HD inline std::uint32_t count_ones(std::uint64_t word) {
#ifdef __CUDA_ARCH__
  return static_cast<std::uint32_t>(__popcll(static_cast<long long>(word)));
#else
  return static_cast<std::uint32_t>(std::popcount(word));
#endif
}

ISOWEAVE_HD inline int lowest_bit(std::uint64_t word) {
#ifdef __CUDA_ARCH__
  return __ffsll(static_cast<long long>(word)) - 1;
#else
  return std::countr_zero(word);
#endif
}

// Slices on the device, in a ring.
template <class T>
struct SliceRing {
  const T* samples = nullptr;
  std::array<std::int64_t, 3> dims{};
  std::int64_t room = 1;  // slices; slice k lies at k % room

  ISOWEAVE_HD bool reaches(std::size_t axis, std::int64_t at) const { return at >= 0 && at < dims[axis]; }

  ISOWEAVE_HD SampleRow<T> row(std::int64_t j, std::int64_t k) const {
    if (j < 0 || k < 0 || j >= dims[1] || k >= dims[2]) return {};
    return {samples + ((k % room) * dims[1] + j) * dims[0], dims[0]};
  }
};

// The bits of a slab: the inside bits of its slices, and the crossings and cells that follow from them.
//
// Slice n = 0 is the front of the slab before. A word is named by its slice or layer, its row and its place in the row;
// word_of() gives its place in the arrays.
struct SlabBits {
  VertexNumbering numbering;
  bool closed = true;
  std::int64_t first_layer = -1;  // of the slab
  std::int64_t rows = 0;          // padded, of a slice
  std::int64_t words = 0;         // of a padded row
  std::uint64_t* inside = nullptr;

  ISOWEAVE_HD std::int64_t plane() const { return rows * words; }
  ISOWEAVE_HD std::int64_t word_of(std::int64_t n, std::int64_t row, std::int64_t w) const {
    return (n * rows + row) * words + w;
  }
  ISOWEAVE_HD bool is_sample(std::int64_t at, int axis) const {
    return at >= 0 && at < numbering.lattice.dims[static_cast<std::size_t>(axis)];
  }

  // Whether an edge along an axis exists that starts at `at` on that axis, counted in samples.
  ISOWEAVE_HD bool has_edge(std::int64_t at, int axis) const {
    return closed ? at + 1 <= numbering.lattice.dims[static_cast<std::size_t>(axis)]
                  : is_sample(at, axis) && is_sample(at + 1, axis);
  }

  // Bits [first, end) of word w of a row.
  ISOWEAVE_HD static std::uint64_t bits_between(std::int64_t w, std::int64_t first, std::int64_t end) {
    const std::int64_t from = first - 64 * w;
    const std::int64_t to = end - 64 * w;
    const std::uint64_t below_to = to >= 64 ? ~std::uint64_t{0} : to <= 0 ? 0 : (std::uint64_t{1} << to) - 1;
    const std::uint64_t below_from = from >= 64 ? ~std::uint64_t{0} : from <= 0 ? 0 : (std::uint64_t{1} << from) - 1;
    return below_to & ~below_from;
  }

  // The x-edges that exist in word w of a row. The cells are the same bits.
  ISOWEAVE_HD std::uint64_t edge_mask(std::int64_t w) const {
    const std::int64_t nx = numbering.lattice.dims[0];
    return closed ? bits_between(w, 0, nx + 1) : bits_between(w, 1, nx);
  }

  // The inside bits of the lattice points one step further along x.
  ISOWEAVE_HD std::uint64_t shifted(std::int64_t n, std::int64_t row, std::int64_t w) const {
    const std::uint64_t* const at = inside + word_of(n, row, w);
    return at[0] >> 1 | (w + 1 < words ? at[1] << 63 : 0);
  }

  ISOWEAVE_HD std::uint64_t cross_x(std::int64_t n, std::int64_t row, std::int64_t w) const {
    return (inside[word_of(n, row, w)] ^ shifted(n, row, w)) & edge_mask(w);
  }
  ISOWEAVE_HD std::uint64_t cross_y(std::int64_t n, std::int64_t row, std::int64_t w) const {
    if (row + 1 >= rows || !has_edge(row - 1, 1)) return 0;
    return inside[word_of(n, row, w)] ^ inside[word_of(n, row + 1, w)];
  }
  // The crossings along z between slices n and n + 1.
  ISOWEAVE_HD std::uint64_t cross_z(std::int64_t n, std::int64_t row, std::int64_t w) const {
    if (!has_edge(first_layer + n, 2)) return 0;
    return inside[word_of(n, row, w)] ^ inside[word_of(n + 1, row, w)];
  }

  // Cells of layer n that the surface crosses.
  ISOWEAVE_HD std::uint64_t active_cells(std::int64_t n, std::int64_t row, std::int64_t w) const {
    if (row + 1 >= rows || !has_edge(first_layer + n, 2) || !has_edge(row - 1, 1)) return 0;
    std::uint64_t any = 0;
    std::uint64_t all = ~std::uint64_t{0};
    for (std::int64_t corner = 0; corner < 4; ++corner) {
      const std::uint64_t here = inside[word_of(n + corner / 2, row + corner % 2, w)];
      const std::uint64_t beside = shifted(n + corner / 2, row + corner % 2, w);
      any |= here | beside;
      all &= here & beside;
    }
    return any & ~all & edge_mask(w);
  }

  ISOWEAVE_HD std::uint32_t case_of(std::int64_t n, std::int64_t row, std::int64_t w, int bit) const {
    std::uint32_t pairs[4];
    for (std::int64_t corner = 0; corner < 4; ++corner) {
      const std::uint64_t here = inside[word_of(n + corner / 2, row + corner % 2, w)];
      const std::uint64_t beside = shifted(n + corner / 2, row + corner % 2, w);
      pairs[corner] = static_cast<std::uint32_t>((here >> bit & 1) | (beside >> bit & 1) << 1);
    }
    return cell_case(pairs[0], pairs[1], pairs[2], pairs[3]);
  }
};

// The totals over the rows of a slab.
struct SlabTotals {
  std::uint64_t cells = 0;  // crossed

  ISOWEAVE_HD void operator+=(const SlabTotals& other) { cells += other.cells; }
};

struct ExtractPasses {
  SlabBits bits;
  IsoRule rule;
  std::array<double, 3> spacing{};
  const CellCase* cases = nullptr;            // kCaseTable
  const ChoicePolygons* choices = nullptr;    // kChoicePolygons
  std::uint32_t* vertex_base = nullptr;       // per word of a layer: counts, then numbers of its first vertex
  std::uint32_t* triangle_base = nullptr;     // the same for triangles
  const std::uint32_t* front_base = nullptr;  // per word of slice 0: the number of its first x-crossing
  const Index* front = nullptr;               // in the zone: vertices 0 ... inherited - 1
  std::uint32_t inherited = 0;
  Index first_vertex = 0;  // of the slab, in the zone
  Index first_triangle = 0;
  ZoneView zone;

  struct Word {
    std::int64_t n, row, w;
  };

  ISOWEAVE_HD Word word(std::int64_t item) const {
    const auto number = static_cast<std::uint32_t>(item);  // divisions of 64 bits are slow on a device
    const auto words = static_cast<std::uint32_t>(bits.words);
    const auto rows = static_cast<std::uint32_t>(bits.rows);
    const std::uint32_t row = number / words;
    const std::uint32_t n = row / rows;
    return {n, row - n * rows, number - row * words};
  }

  // Whether the n-th lattice point of the slab is inside, counted from the first one above the front, in words of 64.
  template <class T>
  ISOWEAVE_HD bool is_inside(std::int64_t n, SliceRing<T> ring) {
    const Word at = word(n >> 6);
    const double f = ring.row(at.row - 1, bits.first_layer + at.n + 1)[64 * at.w + (n & 63) - 1];
    return rule.above ? f >= rule.iso : f <= rule.iso;
  }

  // Counts the vertices and triangles of a word, on layer n and on the slice above it.
  ISOWEAVE_HD void count(std::int64_t item) {
    const auto [n, row, w] = word(item);
    vertex_base[item] = count_ones(bits.cross_z(n, row, w)) + count_ones(bits.cross_x(n + 1, row, w)) +
                        count_ones(bits.cross_y(n + 1, row, w));
    std::uint32_t triangles = 0;
    for (std::uint64_t active = bits.active_cells(n, row, w); active != 0; active &= active - 1) {
      triangles += cases[bits.case_of(n, row, w, lowest_bit(active))].triangles;
    }
    triangle_base[item] = triangles;
  }

  // Makes the vertices of a word. Crossings along z below the slice are numbered first, then those along x and y on it.
  template <class T>
  ISOWEAVE_HD void emit_vertices(std::int64_t item, SliceRing<T> ring) {
    const auto [n, row, w] = word(item);
    const std::int64_t k = bits.first_layer + n;
    Index v = first_vertex + vertex_base[item];
    v = emit_word(ring, {w, row - 1, k, 2}, bits.cross_z(n, row, w), n, v);
    v = emit_word(ring, {w, row - 1, k + 1, 0}, bits.cross_x(n + 1, row, w), n + 1, v);
    emit_word(ring, {w, row - 1, k + 1, 1}, bits.cross_y(n + 1, row, w), n + 1, v);
  }

  // Makes the triangles of a word, in lattice order.
  ISOWEAVE_HD void emit_triangles(std::int64_t item, SlabTotals& totals) {
    const auto [n, row, w] = word(item);
    Index t = first_triangle + triangle_base[item];
    for (std::uint64_t active = bits.active_cells(n, row, w); active != 0; active &= active - 1) {
      const int bit = lowest_bit(active);
      const std::uint32_t cell = bits.case_of(n, row, w, bit);
      const Index first = t;
      for (int c = 0; c < 3 * cases[cell].triangles; ++t) {
        Triangle triangle;
        for (HalfEdge& side : triangle.sides) {
          side.vertex = vertex_on({n, row, w}, bit, cases[cell].edges[static_cast<std::size_t>(c++)]);
        }
        zone.triangles[t] = triangle;
      }
      shorten_diagonals(cell, first);
      ++totals.cells;
    }
  }

  // Counts the crossings of word `at` of the slab's last slice.
  ISOWEAVE_HD void count_front(std::int64_t at, std::int64_t layers, std::uint32_t* base) {
    const auto [n, row, w] = word(at);
    base[at] = count_ones(bits.cross_x(layers, row, w)) + count_ones(bits.cross_y(layers, row, w));
  }
  ISOWEAVE_HD void list_front(std::int64_t at, std::int64_t layers, const std::uint32_t* base, Index* vertices) {
    const auto [n, row, w] = word(at);
    const Index first = first_vertex + (number_on_slice(layers, row, w) - inherited);
    for (std::uint32_t n_word = base[at]; n_word < base[at + 1]; ++n_word)
      vertices[n_word] = first + (n_word - base[at]);
  }

 private:
  // Gives the polygons of a cell, whose triangles begin with the `first`, their shortest diagonals.
  ISOWEAVE_HD void shorten_diagonals(std::uint32_t cell, Index first) const {
    for (std::size_t n = choices->first[cell]; n < choices->first[cell + 1]; ++n) {
      const ChoicePolygon& polygon = choices->polygons[n];
      Triangle* const own = &zone.triangles[first + polygon.first];
      choose_diagonals(
          polygon, [&](std::size_t at) -> Index& { return own[at / 3].sides[at % 3].vertex; },
          [&](Index v) -> const Vec3& { return zone.vertices[v].position; });
    }
  }

  // A run of 64 lattice edges along an axis: its word, and the row and slice of its lower ends, in samples.
  struct EdgeWord {
    std::int64_t w, j, k;
    int axis;
  };

  template <class T>
  ISOWEAVE_HD Index emit_word(const SliceRing<T>& ring, const EdgeWord& edges, std::uint64_t crossings, std::int64_t n,
                              Index v) const {
    if (crossings == 0) return v;
    const std::uint64_t inside = bits.inside[bits.word_of(n, edges.j + 1, edges.w)];
    const SampleRow<T> low = ring.row(edges.j, edges.k);
    const SampleRow<T> high = ring.row(edges.j + (edges.axis == 1 ? 1 : 0), edges.k + (edges.axis == 2 ? 1 : 0));
    for (; crossings != 0; crossings &= crossings - 1, ++v) {
      const int bit = lowest_bit(crossings);
      const std::int64_t i = 64 * edges.w + bit - 1;
      const double f0 = low[i];
      const double f1 = high[edges.axis == 0 ? i + 1 : i];
      const bool low_inside = (inside >> bit & 1) != 0;
      const double t = crossing_parameter(f0, f1, rule.iso, low_inside);
      double at[3] = {static_cast<double>(i), static_cast<double>(edges.j), static_cast<double>(edges.k)};
      at[edges.axis] = at[edges.axis] + t;
      Vertex vertex;
      vertex.position = {at[0] * spacing[0], at[1] * spacing[1], at[2] * spacing[2]};
      vertex.id = bits.numbering.id(i, edges.j, edges.k, static_cast<std::uint32_t>(edges.axis));
      zone.vertices[v] = vertex;
      zone.states[v] = VertexState::kIncomplete;
      zone.turn_keys[v] = 0;
      zone.turns[v] = Turn();
      if (!zone.normals.empty()) {
        const Crossing crossing{
            {i, edges.j, edges.k}, static_cast<std::uint8_t>(1 << edges.axis), f0, f1, t, low_inside};
        zone.normals[v] = normal_at(ring, crossing, spacing, rule.above);
      }
    }
    return v;
  }

  // The number of the first crossing along x in a word of slice n. Crossings along y follow.
  ISOWEAVE_HD std::uint32_t number_on_slice(std::int64_t n, std::int64_t row, std::int64_t w) const {
    if (n == 0) return front_base[bits.word_of(0, row, w)];
    return inherited + vertex_base[bits.word_of(n - 1, row, w)] + count_ones(bits.cross_z(n - 1, row, w));
  }

  // The vertex on edge e of the cell at a bit.
  ISOWEAVE_HD Index vertex_on(const Word& cell, int bit, int e) const {
    const CellEdge edge = table_rules::cell_edge(e);
    const std::int64_t at = 64 * cell.w + bit + edge.dx;
    const std::int64_t n = cell.n + edge.dz;
    const std::int64_t row = cell.row + edge.dy;
    const std::int64_t w = at >> 6;
    const std::uint64_t before = (std::uint64_t{1} << (at & 63)) - 1;
    std::uint32_t number = 0;
    if (edge.axis == 2) {
      number = inherited + vertex_base[bits.word_of(n, row, w)] + count_ones(bits.cross_z(n, row, w) & before);
    } else if (edge.axis == 0) {
      number = number_on_slice(n, row, w) + count_ones(bits.cross_x(n, row, w) & before);
    } else {
      number = number_on_slice(n, row, w) + count_ones(bits.cross_x(n, row, w)) +
               count_ones(bits.cross_y(n, row, w) & before);
    }
    return number < inherited ? front[number] : first_vertex + (number - inherited);
  }
};

}  // namespace isoweave
