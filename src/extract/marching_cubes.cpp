#include "extract/marching_cubes.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <limits>

#include "extract/classify.hpp"
#include "extract/gradient.hpp"
#include "extract/tables.hpp"
#include "isoweave/error.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kRowsPerBlock = 8;

std::uint32_t ones(std::uint64_t word) { return static_cast<std::uint32_t>(std::popcount(word)); }

std::uint64_t below(std::int64_t bit) { return (std::uint64_t{1} << (bit & 63)) - 1; }

// Words with the bits [first, end) set.
std::vector<std::uint64_t> bit_range(std::size_t words, std::int64_t first, std::int64_t end) {
  std::vector<std::uint64_t> mask(words, 0);
  for (std::int64_t bit = first; bit < end; ++bit)
    mask[static_cast<std::size_t>(bit >> 6)] |= std::uint64_t{1} << (bit & 63);
  return mask;
}

// Calls visit(bit within the row) for every set bit of word w.
template <class Visit>
void for_each_bit(std::uint64_t word, std::size_t w, Visit&& visit) {
  for (; word != 0; word &= word - 1) visit(static_cast<std::int64_t>(64 * w) + std::countr_zero(word));
}

// Replaces counts by the sums before them; returns the total.
std::uint64_t exclusive_scan(std::vector<std::uint32_t>& counts) {
  std::uint64_t sum = 0;
  for (std::uint32_t& count : counts) {
    const std::uint32_t own = count;
    count = static_cast<std::uint32_t>(sum);
    sum += own;
  }
  return sum;
}

}  // namespace

MarchingCubes::MarchingCubes(const VolumeInfo& volume, const ExtractOptions& options, const Executor& executor)
    : lattice_{volume.dims},
      type_(volume.type),
      spacing_(volume.geometry.spacing),
      options_(options),
      executor_(executor),
      rows_(static_cast<std::size_t>(volume.dims[1]) + 2),
      words_((static_cast<std::size_t>(volume.dims[0]) + 2 + 63) / 64),
      end_layer_(options.rule.closed ? volume.dims[2] : volume.dims[2] - 1),
      slices_(1) {
  const std::int64_t nx = volume.dims[0];
  const bool closed = options.rule.closed;
  edge_mask_ = closed ? bit_range(words_, 0, nx + 1) : bit_range(words_, 1, nx);
  cell_mask_ = edge_mask_;
  end_mask_.assign(words_, 0);
  for (const std::int64_t bit : {std::int64_t{1}, nx})
    end_mask_[static_cast<std::size_t>(bit >> 6)] |= 1ULL << (bit & 63);
  const std::size_t size = rows_ * words_;
  slices_[0] = {std::vector<std::uint64_t>(size, 0), std::vector<std::uint64_t>(size, 0),
                std::vector<std::uint64_t>(size, 0), std::vector<std::uint32_t>(size, 0)};
}

std::pair<std::int64_t, std::int64_t> MarchingCubes::slices_for(std::int64_t layers) const {
  const std::int64_t margin = options_.normals ? 1 : 0;
  return {next_layer_ - margin, next_layer_ + layers + 1 + margin};
}

std::int64_t MarchingCubes::extract(const SliceWindow& window, std::int64_t layers, SurfacePiece& piece,
                                    std::uint64_t most_vertices) {
  piece.clear();
  piece.inherited = front_size_;
  auto count = static_cast<std::size_t>(layers);
  slices_.resize(count + 1);
  layers_.resize(count);
  const std::int64_t jobs = layers * static_cast<std::int64_t>(rows_);
  for (std::size_t n = 0; n < count; ++n) {
    for (auto* bits : {&slices_[n + 1].inside, &slices_[n + 1].cross_x, &slices_[n + 1].cross_y, &layers_[n].cross_z}) {
      bits->resize(rows_ * words_);
    }
    slices_[n + 1].base.resize(rows_ * words_);
    layers_[n].base.resize(rows_ * words_);
  }
  executor_.for_each(jobs, kRowsPerBlock, [&](std::int64_t job) {
    const std::size_t n = static_cast<std::size_t>(job) / rows_;
    classify(window, next_layer_ + static_cast<std::int64_t>(n) + 1, static_cast<std::size_t>(job) % rows_,
             slices_[n + 1]);
  });
  count = layers_within(count, most_vertices);
  number_vertices(count, piece);
  visit_sample_type(type_, [&]<class T>() { emit_vertices<T>(window, count, piece); });
  emit_triangles(count, piece);
  next_layer_ += static_cast<std::int64_t>(count);
  std::swap(slices_.front(), slices_[count]);
  list_front(piece);
  return static_cast<std::int64_t>(count);
}

// Inside bits of one padded row of slice k.
void MarchingCubes::classify(const SliceWindow& window, std::int64_t k, std::size_t row, Slice& slice) const {
  const auto bits = std::span(slice.inside).subspan(row * words_, words_);
  const std::int64_t j = static_cast<std::int64_t>(row) - 1;
  if (k < 0 || k >= lattice_.dims[2] || j < 0 || j >= lattice_.dims[1]) {
    std::fill(bits.begin(), bits.end(), 0);
    return;
  }
  const std::size_t row_bytes = static_cast<std::size_t>(lattice_.dims[0]) * sample_bytes(type_);
  classify_row(window.slice(k) + static_cast<std::size_t>(j) * row_bytes, type_, lattice_.dims[0], options_.rule, bits);
}

// Crossing bits of one row of layer n of the slab and of the slice above it, and how many there are.
void MarchingCubes::find_crossings(std::size_t n, std::size_t row, std::uint32_t& count) {
  Slice& slice = slices_[n + 1];
  const std::size_t begin = row * words_;
  const std::int64_t k = next_layer_ + static_cast<std::int64_t>(n);
  const std::int64_t j = static_cast<std::int64_t>(row) - 1;
  const bool closed = options_.rule.closed;
  const bool has_y = row + 1 < rows_ && (closed || (j >= 0 && j + 1 < lattice_.dims[1]));
  const bool has_z = closed || (k >= 0 && k + 1 < lattice_.dims[2]);
  count = 0;
  for (std::size_t w = 0; w < words_; ++w) {
    const std::uint64_t bits = slice.inside[begin + w];
    const std::uint64_t carry = w + 1 < words_ ? slice.inside[begin + w + 1] << 63 : 0;
    slice.cross_x[begin + w] = (bits ^ (bits >> 1 | carry)) & edge_mask_[w];
    slice.cross_y[begin + w] = has_y ? bits ^ slice.inside[begin + words_ + w] : 0;
    layers_[n].cross_z[begin + w] = has_z ? bits ^ slices_[n].inside[begin + w] : 0;
    count += ones(slice.cross_x[begin + w]) + ones(slice.cross_y[begin + w]) + ones(layers_[n].cross_z[begin + w]);
  }
}

// Crossings in the faces of an open volume: each is the end of two open edges, and has one to its name.
std::uint32_t MarchingCubes::crossings_on_border(std::size_t n, std::size_t row) const {
  const auto is_end = [](std::int64_t at, std::int64_t size) { return at == 0 || at == size - 1; };
  const bool end_slice = is_end(next_layer_ + static_cast<std::int64_t>(n) + 1, lattice_.dims[2]);
  const bool end_row = is_end(static_cast<std::int64_t>(row) - 1, lattice_.dims[1]);
  constexpr std::uint64_t kAll = ~std::uint64_t{0};
  std::uint32_t count = 0;
  for (std::size_t w = 0; w < words_; ++w) {
    const std::size_t at = row * words_ + w;
    if (end_slice || end_row) count += ones(slices_[n + 1].cross_x[at]);
    count += ones(slices_[n + 1].cross_y[at] & (end_slice ? kAll : end_mask_[w]));
    count += ones(layers_[n].cross_z[at] & (end_row ? kAll : end_mask_[w]));
  }
  return count;
}

void MarchingCubes::number_row(std::size_t n, std::size_t row, std::uint32_t base) {
  for (std::size_t w = row * words_; w < (row + 1) * words_; ++w) {
    layers_[n].base[w] = base;
    base += ones(layers_[n].cross_z[w]);
    slices_[n + 1].base[w] = base;
    base += ones(slices_[n + 1].cross_x[w]) + ones(slices_[n + 1].cross_y[w]);
  }
}

// Counts crossings row by row; returns how many layers hold no more than `most_vertices`, one at least.
std::size_t MarchingCubes::layers_within(std::size_t layers, std::uint64_t most_vertices) {
  row_counts_.resize(layers * rows_);
  executor_.for_each(static_cast<std::int64_t>(row_counts_.size()), kRowsPerBlock, [&](std::int64_t job) {
    const auto at = static_cast<std::size_t>(job);
    find_crossings(at / rows_, at % rows_, row_counts_[at]);
  });
  std::uint64_t sum = 0;
  for (std::size_t n = 0; n < layers; ++n) {
    for (std::size_t row = 0; row < rows_; ++row) sum += row_counts_[n * rows_ + row];
    if (sum > most_vertices) return std::max<std::size_t>(n, 1);
  }
  return layers;
}

// Numbers crossings row by row (z below the slice, then x and y on it) after the inherited ones, and makes room for
// them.
void MarchingCubes::number_vertices(std::size_t layers, SurfacePiece& piece) {
  row_counts_.resize(layers * rows_);
  const auto jobs = static_cast<std::int64_t>(row_counts_.size());
  const std::uint64_t total = exclusive_scan(row_counts_);
  if (total + front_size_ >= std::numeric_limits<std::uint32_t>::max()) {
    throw OverMemory("a slab of " + std::to_string(layers) + " layers holds " + std::to_string(total) +
                     " vertices, expected fewer than 2^32: choose thinner slabs");
  }
  std::atomic<std::uint64_t> on_border{0};
  executor_.for_each(jobs, kRowsPerBlock, [&](std::int64_t job) {
    const auto at = static_cast<std::size_t>(job);
    number_row(at / rows_, at % rows_, front_size_ + row_counts_[at]);
    if (!options_.rule.closed) {
      on_border.fetch_add(crossings_on_border(at / rows_, at % rows_), std::memory_order_relaxed);
    }
  });
  piece.open_edges = on_border;
  piece.positions.resize(total);
  piece.ids.resize(total);
  piece.normals.resize(options_.normals ? total : 0);
}

template <class T>
void MarchingCubes::emit_vertices(const SliceWindow& window, std::size_t layers, SurfacePiece& piece) const {
  const SampleView<T> sample(window);
  const IsoRule& rule = options_.rule;
  const auto emit = [&](std::int64_t bit, std::size_t row, std::int64_t k, std::size_t axis, bool inside,
                        std::uint32_t number) {
    const std::array<std::int64_t, 3> low{bit - 1, static_cast<std::int64_t>(row) - 1, k};
    std::array<std::int64_t, 3> high = low;
    ++high[axis];
    const double f0 = sample(low[0], low[1], low[2]);
    const double f1 = sample(high[0], high[1], high[2]);
    const double t = crossing_parameter(f0, f1, rule.iso, inside);
    std::array<double, 3> at{static_cast<double>(low[0]), static_cast<double>(low[1]), static_cast<double>(low[2])};
    at[axis] += t;
    const std::size_t slot = number - front_size_;
    piece.positions[slot] = {at[0] * spacing_[0], at[1] * spacing_[1], at[2] * spacing_[2]};
    piece.ids[slot] = lattice_.edge_id(low[0], low[1], low[2], static_cast<int>(axis));
    if (!options_.normals) return;
    if ((f0 == f0) != (f1 == f1)) {  // a cap on the border: the surface faces along the edge
      Point cap{0, 0, 0};
      cap[axis] = inside ? 1.0F : -1.0F;
      piece.normals[slot] = cap;
      return;
    }
    const Vec3 g0 = sample.gradient(low, spacing_);
    const Vec3 g = g0 + t * (sample.gradient(high, spacing_) - g0);
    piece.normals[slot] = unit_point(rule.above ? -g : g);
  };
  executor_.for_each(static_cast<std::int64_t>(layers * rows_), kRowsPerBlock, [&](std::int64_t job) {
    const std::size_t n = static_cast<std::size_t>(job) / rows_;
    const std::size_t row = static_cast<std::size_t>(job) % rows_;
    const std::int64_t k = next_layer_ + static_cast<std::int64_t>(n);
    for (std::size_t w = 0; w < words_; ++w) {
      const std::size_t at = row * words_ + w;
      const Slice& upper = slices_[n + 1];
      const auto emit_word = [&](std::uint64_t crossings, std::int64_t slice, std::size_t axis, std::uint64_t inside,
                                 std::uint32_t number) {
        for_each_bit(crossings, w,
                     [&](std::int64_t bit) { emit(bit, row, slice, axis, (inside >> (bit & 63) & 1) != 0, number++); });
      };
      emit_word(layers_[n].cross_z[at], k, 2, slices_[n].inside[at], layers_[n].base[at]);
      emit_word(upper.cross_x[at], k + 1, 0, upper.inside[at], upper.base[at]);
      emit_word(upper.cross_y[at], k + 1, 1, upper.inside[at], upper.base[at] + ones(upper.cross_x[at]));
    }
  });
}

bool MarchingCubes::has_cells(std::int64_t k, std::size_t row) const {
  if (row + 1 >= rows_) return false;
  const std::int64_t j = static_cast<std::int64_t>(row) - 1;
  return options_.rule.closed || (k >= 0 && k + 1 < lattice_.dims[2] && j >= 0 && j + 1 < lattice_.dims[1]);
}

// Calls visit(bit, case) for every cell of a cell row that the surface crosses, and enter_word(w) before the first of a
// word.
template <class EnterWord, class Visit>
void MarchingCubes::for_active_cells(std::size_t n, std::size_t row, EnterWord&& enter_word, Visit&& visit) const {
  if (!has_cells(next_layer_ + static_cast<std::int64_t>(n), row)) return;
  const std::uint64_t* rows[4] = {&slices_[n].inside[row * words_], &slices_[n].inside[(row + 1) * words_],
                                  &slices_[n + 1].inside[row * words_], &slices_[n + 1].inside[(row + 1) * words_]};
  for (std::size_t w = 0; w < words_; ++w) {
    std::uint64_t shifted[4];
    std::uint64_t any = 0;
    std::uint64_t all = ~std::uint64_t{0};
    for (std::size_t r = 0; r < 4; ++r) {
      shifted[r] = rows[r][w] >> 1 | (w + 1 < words_ ? rows[r][w + 1] << 63 : 0);
      any |= rows[r][w] | shifted[r];
      all &= rows[r][w] & shifted[r];
    }
    const std::uint64_t active = any & ~all & cell_mask_[w];
    if (active != 0) enter_word(w);
    for_each_bit(active, w, [&](std::int64_t bit) {
      const auto pair = [&](std::size_t r) {
        return static_cast<std::uint32_t>((rows[r][w] >> (bit & 63) & 1) | (shifted[r] >> (bit & 63) & 1) << 1);
      };
      visit(bit, cell_case(pair(0), pair(1), pair(2), pair(3)));
    });
  }
}

MarchingCubes::CellWord MarchingCubes::cell_word(std::size_t n, std::size_t row, std::size_t w) const {
  CellWord word{};
  for (std::size_t e = 0; e < kEdgeTable.size(); ++e) {
    const CellEdge edge = kEdgeTable[e];
    const Slice& slice = slices_[n + edge.dz];
    const auto base_at = [&](std::size_t at) {
      if (edge.axis == 2) return layers_[n].base[at];
      return slice.base[at] + (edge.axis == 1 ? ones(slice.cross_x[at]) : 0);
    };
    const std::size_t at = (row + edge.dy) * words_ + w;
    const auto& crossings = edge.axis == 2 ? layers_[n].cross_z : edge.axis == 1 ? slice.cross_y : slice.cross_x;
    word.crossings[e] = crossings[at];
    word.base[e] = base_at(at);
    if (w + 1 < words_) word.next_base[e] = base_at(at + 1);
  }
  return word;
}

// Counts triangles per cell row, then writes them in lattice order.
void MarchingCubes::emit_triangles(std::size_t layers, SurfacePiece& piece) const {
  std::vector<std::uint32_t> counts(layers * rows_);
  std::vector<std::uint32_t> cells(layers * rows_);
  const auto jobs = static_cast<std::int64_t>(counts.size());
  executor_.for_each(jobs, kRowsPerBlock, [&](std::int64_t job) {
    const auto at = static_cast<std::size_t>(job);
    for_active_cells(
        at / rows_, at % rows_, [](std::size_t) {},
        [&](std::int64_t, std::uint32_t cell) {
          counts[at] += kCaseTable[cell].triangles;
          ++cells[at];
        });
  });
  for (const std::uint32_t crossed : cells) piece.cells_crossed += crossed;
  piece.triangles.resize(exclusive_scan(counts));
  executor_.for_each(jobs, kRowsPerBlock, [&](std::int64_t job) {
    const auto at = static_cast<std::size_t>(job);
    const std::size_t n = at / rows_;
    const std::size_t row = at % rows_;
    auto* out = piece.triangles.data() + counts[at];
    CellWord word{};
    for_active_cells(
        n, row, [&](std::size_t w) { word = cell_word(n, row, w); },
        [&](std::int64_t bit, std::uint32_t cell) {
          const bool last_of_word = (bit & 63) == 63;
          const std::array<std::uint64_t, 2> before{below(bit), below(bit) << 1 | 1};
          const auto vertex = [&](std::size_t e) {
            const std::size_t dx = kEdgeTable[e].dx;
            if (last_of_word && dx == 1) return word.next_base[e];
            return word.base[e] + ones(word.crossings[e] & before[dx]);
          };
          const CellCase& shape = kCaseTable[cell];
          for (std::size_t t = 0; t < shape.triangles; ++t, ++out) {
            for (std::size_t c = 0; c < 3; ++c) (*out)[c] = vertex(static_cast<std::size_t>(shape.edges[3 * t + c]));
          }
        });
  });
}

// The crossings of the last slice are incomplete; they become the numbers 0, 1, ... of the next slab, in this order.
void MarchingCubes::list_front(SurfacePiece& piece) {
  front_size_ = 0;
  if (layers_left() == 0) return;
  Slice& front = slices_.front();
  for (std::size_t at = 0; at < front.base.size(); ++at) {
    const std::uint32_t count = ones(front.cross_x[at]) + ones(front.cross_y[at]);
    for (std::uint32_t n = 0; n < count; ++n) piece.incomplete.push_back(front.base[at] + n);
    front.base[at] = front_size_;
    front_size_ += count;
  }
}

}  // namespace isoweave
