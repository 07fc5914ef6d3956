#include "extract/marching_tetrahedra.hpp"

#include <algorithm>

#include "extract/cell_cases.hpp"
#include "extract/tetrahedra_table.hpp"

namespace isoweave {
namespace {

// The crossed cells of a row, as for_cells() takes them.
CellRow cells_of(const CellSlab& slab, std::size_t n, std::size_t row, const std::uint64_t* crossed) {
  CellRow cells{};
  cells.words = slab.words();
  cells.crossed = crossed;
  cells.inside = slab.rows_around(static_cast<std::ptrdiff_t>(n), row);
  return cells;
}

}  // namespace

MarchingTetrahedra::MarchingTetrahedra(const VolumeInfo& volume, const ExtractOptions& options,
                                       const Executor& executor)
    : EdgeExtractor(volume, options, VertexNumbering::of_kuhn_edges(options.whole(volume)), executor) {}

void MarchingTetrahedra::count_cells(const SliceWindow&, const Row& at, RowCounts& counts) const {
  const CellRow cells = cells_of(slab(), at.n, at.row, crossed(at.number));
  for (std::size_t w = 0; w < cells.words; ++w) {
    if (cells.crossed[w] == 0) continue;
    for (const unsigned half : {0U, 1U}) {
      for_cells(cells, w, half, [&](int, std::uint32_t cell) { counts.triangles += kTetrahedraTable[cell].triangles; });
    }
  }
}

std::uint32_t MarchingTetrahedra::EdgeWords::first(std::size_t w) const {
  std::uint32_t number = base[w];
  for (const std::uint64_t* const words : before) {
    if (words != nullptr) number += static_cast<std::uint32_t>(std::popcount(words[w]));
  }
  return number;
}

template <class Found>
MarchingTetrahedra::EdgeWords MarchingTetrahedra::words_of(const Found& crossings, std::size_t direction,
                                                           std::size_t word) {
  EdgeWords words{&crossings.along[direction][word], {}, &crossings.base[word]};
  for (std::size_t d = 0; d < direction; ++d) words.before[d] = &crossings.along[d][word];
  return words;
}

// The rows of edges that a row of cells touches, in the order of the table.
std::vector<MarchingTetrahedra::EdgeWords> MarchingTetrahedra::edge_words(const Row& at) const {
  std::vector<EdgeWords> rows;
  for (const KuhnEdgeRow& row : kuhn::kRows) {
    const std::size_t word = (at.row + row.dy) * slab().words();
    const bool on_slice_row = row.direction < 4;  // directions 1, 2, 3, and 4 to 7 from one slice to the next
    rows.push_back(on_slice_row ? words_of(on_slice(at.n + row.dz), row.direction - 1U, word)
                                : words_of(in_layer(at.n), row.direction - 4U, word));
  }
  return rows;
}

// From one crossed cell to the next there is no crossing but those at the first one's bit (cell_kernels.hpp), so the
// numbers are counted on.
void MarchingTetrahedra::write_cells(const SliceWindow&, const Row& at, SurfacePiece& piece) const {
  const CellRow cells = cells_of(slab(), at.n, at.row, crossed(at.number));
  const std::vector<EdgeWords> rows = edge_words(at);
  auto* out = piece.triangles.data() + triangles_of(at.number).first;
  std::array<std::uint32_t, 2 * kuhn::kEdgeRows> numbers{};
  const auto next = numbers.begin() + kuhn::kEdgeRows;
  const auto begin_word = [&](std::size_t w) {
    for (std::size_t r = 0; r < rows.size(); ++r) next[static_cast<std::ptrdiff_t>(r)] = rows[r].first(w);
  };
  for (std::size_t w = 0; w < cells.words; ++w) {
    if (cells.crossed[w] == 0) continue;
    begin_word(w);
    for (const unsigned half : {0U, 1U}) {
      for_cells(cells, w, half, [&](int bit, std::uint32_t cell) {
        std::copy(next, numbers.end(), numbers.begin());
        for (std::size_t r = 0; r < rows.size(); ++r) {
          next[static_cast<std::ptrdiff_t>(r)] +=
              static_cast<std::uint32_t>(rows[r].crossings[w] >> 32 * half) >> bit & 1;
        }
        if (half == 1 && bit == 31 && w + 1 < cells.words) begin_word(w + 1);
        const kuhn::Case& shape = kTetrahedraTable[cell];
        const std::uint8_t* place = shape.places.data();
        for (std::size_t t = 0; t < shape.triangles; ++t, ++out) {
          for (std::uint32_t& corner : *out) corner = numbers[*place++];
        }
      });
    }
  }
}

}  // namespace isoweave
