#include "extract/marching_cubes.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <string>
#include <utility>

#include "extract/classify.hpp"
#include "extract/front_bits.hpp"
#include "isoweave/error.hpp"
#include "parallel/size.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kSamplesPerBlock = 4096;  // of rows that a thread takes at a time: fewer are no work for it

std::uint32_t ones(std::uint64_t word) { return static_cast<std::uint32_t>(std::popcount(word)); }

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

const std::array<std::int64_t, 3>& checked_dims(const VolumeInfo& volume) {
  if (volume.dims[0] <= kMostRowSamples) return volume.dims;
  throw OverMemory(volume.path + ": a row has " + std::to_string(volume.dims[0]) + " samples, expected at most 2^29");
}

}  // namespace

MarchingCubes::MarchingCubes(const VolumeInfo& volume, const ExtractOptions& options, const Executor& executor)
    : dims_(checked_dims(volume)),
      numbering_(VertexNumbering::of_cube_edges(options.part_of.value_or(PartOfLattice{volume.dims, {}}).dims)),
      first_(options.part_of.value_or(PartOfLattice{}).first),
      type_(volume.type),
      spacing_(volume.geometry.spacing),
      options_(options),
      executor_(executor),
      rows_(to_size(volume.dims[1] + 2)),
      words_(to_size((volume.dims[0] + 2 + 63) / 64)),
      end_layer_(options.rule.closed ? volume.dims[2] : volume.dims[2] - 1),
      slices_(1) {
  const std::int64_t nx = volume.dims[0];
  const bool closed = options.rule.closed;
  edge_mask_ = closed ? bit_range(words_, 0, nx + 1) : bit_range(words_, 1, nx);
  cell_mask_ = edge_mask_;
  end_mask_.assign(words_, 0);
  for (const std::int64_t bit : {std::int64_t{1}, nx})
    end_mask_[static_cast<std::size_t>(bit >> 6)] |= 1ULL << (bit & 63);
  const std::size_t size = to_size(rows_, words_);
  slices_[0] = {std::vector<std::uint64_t>(size, 0), std::vector<std::uint64_t>(size, 0),
                std::vector<std::uint64_t>(size, 0), std::vector<std::uint32_t>(size, 0)};
}

std::pair<std::int64_t, std::int64_t> MarchingCubes::slices_for(std::int64_t layers) const {
  const std::int64_t margin = options_.normals ? 1 : 0;
  return {next_layer_ - margin, next_layer_ + layers + 1 + margin};
}

SlabCounts MarchingCubes::extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                                  SurfacePiece& piece) {
  piece.clear();
  piece.inherited = front_size_;
  auto count = to_size(layers);
  slices_.resize(count + 1);
  layers_.resize(count);
  for (std::size_t n = 0; n < count; ++n) {
    for (auto* bits : {&slices_[n + 1].inside, &slices_[n + 1].cross_x, &slices_[n + 1].cross_y, &layers_[n].cross_z,
                       &layers_[n].crossed}) {
      bits->resize(rows_ * words_);
    }
    slices_[n + 1].base.resize(rows_ * words_);
    layers_[n].base.resize(rows_ * words_);
  }
  for_rows(count, [&](std::size_t n, std::size_t row, std::size_t) {
    classify(window, next_layer_ + static_cast<std::int64_t>(n) + 1, row, slices_[n + 1]);
  });
  count_rows(count);
  count = layers_within(count, most_vertices);
  make_room(count, piece);
  visit_sample_type(type_, [&]<class T>() { emit_vertices<T>(window, count, piece); });
  emit_triangles(count, piece);
  next_layer_ += static_cast<std::int64_t>(count);
  std::swap(slices_.front(), slices_[count]);
  list_front(piece);
  if (layers_left() > 0) piece.complete_below = static_cast<double>(first_[2] + next_layer_) * spacing_[2];
  return {static_cast<std::int64_t>(count), piece.cells_crossed, piece.triangles.size(), piece.positions.size()};
}

// Calls visit(layer, row, number of the row in the slab) for every row of so many layers.
template <class Visit>
void MarchingCubes::for_rows(std::size_t layers, const Visit& visit) const {
  const auto count = static_cast<std::int64_t>(layers * rows_);
  executor_.for_blocks(count, kSamplesPerBlock / dims_[0] + 1, [&](std::int64_t begin, std::int64_t end) {
    std::size_t n = static_cast<std::size_t>(begin) / rows_;
    std::size_t row = static_cast<std::size_t>(begin) % rows_;
    for (auto number = static_cast<std::size_t>(begin); number < static_cast<std::size_t>(end); ++number) {
      visit(n, row, number);
      if (++row < rows_) continue;
      row = 0;
      ++n;
    }
  });
}

// Inside bits of one padded row of slice k.
void MarchingCubes::classify(const SliceWindow& window, std::int64_t k, std::size_t row, Slice& slice) const {
  const auto bits = std::span(slice.inside).subspan(row * words_, words_);
  const std::int64_t j = static_cast<std::int64_t>(row) - 1;
  if (k < 0 || k >= dims_[2] || j < 0 || j >= dims_[1]) {
    std::fill(bits.begin(), bits.end(), 0);
    return;
  }
  const std::size_t row_bytes = static_cast<std::size_t>(dims_[0]) * sample_bytes(type_);
  classify_row(window.slice(k) + static_cast<std::size_t>(j) * row_bytes, type_, dims_[0], options_.rule, bits,
               kernels_);
}

// Finds the crossings of one row of a slice.
void MarchingCubes::find_on_slice(std::size_t row, Slice& slice) const {
  const std::size_t begin = row * words_;
  const std::int64_t j = static_cast<std::int64_t>(row) - 1;
  const bool has_y = row + 1 < rows_ && (options_.rule.closed || (j >= 0 && j + 1 < dims_[1]));
  const std::uint64_t* const bits = &slice.inside[begin];
  kernels_.differ_along(bits, edge_mask_.data(), words_, &slice.cross_x[begin]);
  kernels_.differ(bits, has_y ? bits + words_ : bits, words_, &slice.cross_y[begin]);
}

// Finds the crossings of one row of layer n of the slab and of the slice above it. Returns how many there are.
std::uint32_t MarchingCubes::find_crossings(std::size_t n, std::size_t row) {
  Slice& slice = slices_[n + 1];
  find_on_slice(row, slice);
  const std::size_t begin = row * words_;
  const std::int64_t k = next_layer_ + static_cast<std::int64_t>(n);
  const bool has_z = options_.rule.closed || (k >= 0 && k + 1 < dims_[2]);
  const std::uint64_t* const bits = &slice.inside[begin];
  const std::uint64_t* const x = &slice.cross_x[begin];
  const std::uint64_t* const y = &slice.cross_y[begin];
  std::uint64_t* const z = &layers_[n].cross_z[begin];
  kernels_.differ(bits, has_z ? &slices_[n].inside[begin] : bits, words_, z);
  std::uint32_t count = 0;
  for (std::size_t w = 0; w < words_; ++w) count += ones(x[w]) + ones(y[w]) + ones(z[w]);
  return count;
}

// Counts the crossings in the faces of an open volume. The surface's border runs through them, so there are as many
// open edges as such crossings.
std::uint32_t MarchingCubes::crossings_on_border(std::size_t n, std::size_t row) const {
  const auto is_end = [](std::int64_t at, std::int64_t size) { return at == 0 || at == size - 1; };
  const bool end_slice = is_end(next_layer_ + static_cast<std::int64_t>(n) + 1, dims_[2]);
  const bool end_row = is_end(static_cast<std::int64_t>(row) - 1, dims_[1]);
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

// Finds the crossings of every row, and counts them and the triangles.
void MarchingCubes::count_rows(std::size_t layers) {
  rows_of_slab_.resize(to_size(layers, rows_));
  for_rows(layers, [&](std::size_t n, std::size_t row, std::size_t number) {
    RowCounts counts;
    counts.vertices = find_crossings(n, row);
    if (!options_.rule.closed) counts.on_border = crossings_on_border(n, row);
    find_cells(n, row, counts);
    rows_of_slab_[number] = counts;
  });
}

// The largest number of layers with no more than `most_vertices` vertices, one at least.
std::size_t MarchingCubes::layers_within(std::size_t layers, std::uint64_t most_vertices) const {
  std::uint64_t sum = 0;
  for (std::size_t n = 0; n < layers; ++n) {
    for (std::size_t row = 0; row < rows_; ++row) sum += rows_of_slab_[n * rows_ + row].vertices;
    if (sum > most_vertices) return std::max<std::size_t>(n, 1);
  }
  return layers;
}

// Turns the counts of rows into the places where their vertices and triangles begin, and makes room for these.
void MarchingCubes::make_room(std::size_t layers, SurfacePiece& piece) {
  rows_of_slab_.resize(layers * rows_);
  rows_of_slab_.emplace_back();
  const RowSums sums = place_rows(rows_of_slab_, layers, front_size_);
  piece.cells_crossed = sums.cells;
  piece.open_edges = sums.on_border;
  piece.positions.resize(to_size(sums.vertices));
  piece.ids.resize(to_size(sums.vertices));
  piece.normals.resize(options_.normals ? to_size(sums.vertices) : 0);
  piece.triangles.resize(to_size(sums.triangles));
}

// Numbers the crossings of a row word by word: z below the slice, then x and y on it.
void MarchingCubes::number_row(std::size_t n, std::size_t row, std::uint32_t base) {
  for (std::size_t w = row * words_; w < (row + 1) * words_; ++w) {
    layers_[n].base[w] = base;
    base += ones(layers_[n].cross_z[w]);
    slices_[n + 1].base[w] = base;
    base += ones(slices_[n + 1].cross_x[w]) + ones(slices_[n + 1].cross_y[w]);
  }
}

// A row of lattice edges along an axis, between the samples of two rows, or of one row for axis x.
template <class T, int Axis>
struct MarchingCubes::EdgeRow {
  SampleRow<T> low, high;  // high[i], of axis x high[i + 1], is the other end of the edge from low[i]
  std::int64_t j, k;       // of the lower ends
};

// Numbers the crossings, after the inherited ones, and makes their vertices.
template <class T>
void MarchingCubes::emit_vertices(const SliceWindow& window, std::size_t layers, SurfacePiece& piece) {
  const SampleView<T> samples(window, options_.rule.iso);
  for_rows(layers, [&](std::size_t n, std::size_t row, std::size_t number) {
    const std::int64_t j = static_cast<std::int64_t>(row) - 1;
    const std::int64_t k = next_layer_ + static_cast<std::int64_t>(n);
    const Slice& upper = slices_[n + 1];
    const std::uint32_t first = rows_of_slab_[number].vertices;
    if (first == rows_of_slab_[number + 1].vertices) return;  // no cell asks for numbers there
    number_row(n, row, front_size_ + first);
    const SampleRow<T> here = samples.row(j, k + 1);
    const EdgeRow<T, 2> along_z{samples.row(j, k), here, j, k};
    const EdgeRow<T, 0> along_x{here, here, j, k + 1};
    const EdgeRow<T, 1> along_y{here, samples.row(j + 1, k + 1), j, k + 1};
    for (std::size_t w = 0; w < words_; ++w) {
      const std::size_t at = row * words_ + w;
      emit_word(samples, along_z, w, layers_[n].cross_z[at], slices_[n].inside[at], layers_[n].base[at], piece);
      emit_word(samples, along_x, w, upper.cross_x[at], upper.inside[at], upper.base[at], piece);
      emit_word(samples, along_y, w, upper.cross_y[at], upper.inside[at], upper.base[at] + ones(upper.cross_x[at]),
                piece);
    }
  });
}

// Makes the vertices of the crossings of one word, numbered from `number` on.
template <class T, int Axis>
void MarchingCubes::emit_word(const SampleView<T>& samples, const EdgeRow<T, Axis>& edges, std::size_t w,
                              std::uint64_t crossings, std::uint64_t inside, std::uint32_t number,
                              SurfacePiece& piece) const {
  if (crossings == 0) return;
  const auto j = static_cast<double>(first_[1] + edges.j);
  const auto k = static_cast<double>(first_[2] + edges.k);
  const std::uint64_t first_id = numbering_.id(first_[0] - 1, first_[1] + edges.j, first_[2] + edges.k, Axis);
  Vec3* position = piece.positions.data() + (number - front_size_);
  std::uint64_t* id = piece.ids.data() + (number - front_size_);
  for_each_bit(crossings, w, [&](std::int64_t bit) {
    const std::int64_t i = bit - 1;
    const double f0 = edges.low[i];
    const double f1 = edges.high[Axis == 0 ? i + 1 : i];
    const bool low_inside = (inside >> (bit & 63) & 1) != 0;
    const double t = crossing_parameter(f0, f1, samples.iso(), low_inside);
    const auto low = static_cast<double>(first_[0] + i);
    const double x = Axis == 0 ? low + t : low;
    *position++ = {x * spacing_[0], (Axis == 1 ? j + t : j) * spacing_[1], (Axis == 2 ? k + t : k) * spacing_[2]};
    *id++ = first_id + 3 * static_cast<std::uint64_t>(bit);
    if (options_.normals) {
      const Crossing crossing{{i, edges.j, edges.k}, Axis, f0, f1, t, low_inside};
      piece.normals[number++ - front_size_] = normal_at(samples, crossing, spacing_, options_.rule.above);
    }
  });
}

bool MarchingCubes::has_cells(std::int64_t k, std::size_t row) const {
  if (row + 1 >= rows_) return false;
  const std::int64_t j = static_cast<std::int64_t>(row) - 1;
  return options_.rule.closed || (k >= 0 && k + 1 < dims_[2] && j >= 0 && j + 1 < dims_[1]);
}

// The rows of inside bits around a row of cells.
std::array<const std::uint64_t*, 4> MarchingCubes::rows_around(std::size_t n, std::size_t row) const {
  return {&slices_[n].inside[row * words_], &slices_[n].inside[(row + 1) * words_],
          &slices_[n + 1].inside[row * words_], &slices_[n + 1].inside[(row + 1) * words_]};
}

// Finds the cells of a row that the surface crosses, and counts them and their triangles.
void MarchingCubes::find_cells(std::size_t n, std::size_t row, RowCounts& counts) {
  const std::span crossed(&layers_[n].crossed[row * words_], words_);
  if (!has_cells(next_layer_ + static_cast<std::int64_t>(n), row)) {
    std::fill(crossed.begin(), crossed.end(), 0);
    return;
  }
  kernels_.cells_crossed(rows_around(n, row), cell_mask_.data(), words_, crossed.data());
  for (const std::uint64_t word : crossed) counts.cells += ones(word);
  if (counts.cells > 0) counts.triangles = cell_kernels_.count_triangles(cell_row(n, row));
}

// A row of cells and the rows around it. Its numbers are valid once vertices have been emitted.
CellRow MarchingCubes::cell_row(std::size_t n, std::size_t row) const {
  CellRow cells{};
  cells.words = words_;
  cells.crossed = &layers_[n].crossed[row * words_];
  cells.inside = rows_around(n, row);
  for (std::size_t dz = 0; dz < 2; ++dz) {
    const Slice& slice = slices_[n + dz];
    for (std::size_t dy = 0; dy < 2; ++dy) {
      cells.crossings[edge_row(0, dy, dz)] = &slice.cross_x[(row + dy) * words_];
      cells.x_base[edge_row(0, dy, dz)] = &slice.base[(row + dy) * words_];
    }
    cells.crossings[edge_row(1, 0, dz)] = &slice.cross_y[row * words_];
  }
  for (std::size_t dy = 0; dy < 2; ++dy) {
    cells.crossings[edge_row(2, dy, 0)] = &layers_[n].cross_z[(row + dy) * words_];
    cells.z_base[dy] = &layers_[n].base[(row + dy) * words_];
  }
  return cells;
}

// Writes triangles in lattice order.
void MarchingCubes::emit_triangles(std::size_t layers, SurfacePiece& piece) const {
  for_rows(layers, [&](std::size_t n, std::size_t row, std::size_t number) {
    const std::uint32_t first = rows_of_slab_[number].triangles;
    const std::uint32_t count = rows_of_slab_[number + 1].triangles - first;
    if (count > 0) cell_kernels_.write_triangles(cell_row(n, row), {piece.triangles.data() + first, count});
  });
}

// The crossings of the last slice are incomplete; they become the numbers 0, 1, ... of the next slab, in this order.
void MarchingCubes::list_front(SurfacePiece& piece) {
  front_size_ = 0;
  if (layers_left() == 0) return;
  number_front([&](std::uint32_t before) { piece.incomplete.push_back(before); });
}

// Numbers the crossings of the front. see(number) is told the number that each had in the slab.
template <class See>
void MarchingCubes::number_front(const See& see) {
  Slice& front = slices_.front();
  for (std::size_t at = 0; at < front.base.size(); ++at) {
    const std::uint32_t count = ones(front.cross_x[at]) + ones(front.cross_y[at]);
    for (std::uint32_t n = 0; n < count; ++n) see(front.base[at] + n);
    front.base[at] = front_size_;
    front_size_ += count;
  }
}

void MarchingCubes::serialize(StateWriter& state) const { FrontBits{next_layer_, slices_.front().inside}.write(state); }

void MarchingCubes::serialize(StateReader& state) {
  FrontBits front = FrontBits::read(state, dims_, end_layer_);
  next_layer_ = front.next_layer;
  slices_.front().inside = std::move(front.inside);
  for (std::size_t row = 0; row < rows_; ++row) find_on_slice(row, slices_.front());
  front_size_ = 0;
  if (layers_left() > 0) number_front([](std::uint32_t) {});
}

}  // namespace isoweave
