#include "extract/edge_extractor.hpp"

#include <algorithm>

#include "extract/cube_rules.hpp"
#include "parallel/size.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

// Calls visit(bit within the row) for every set bit of word w.
template <class Visit>
void for_each_bit(std::uint64_t word, std::size_t w, Visit&& visit) {
  for (; word != 0; word &= word - 1) visit(static_cast<std::int64_t>(64 * w) + std::countr_zero(word));
}

// Calls visit<direction>(place among the directions) for each of them.
template <auto kDirections, class Visit>
void for_directions(const Visit& visit) {
  [&]<std::size_t... N>(std::index_sequence<N...>) { (visit.template operator()<kDirections[N]>(N), ...); }
  (std::make_index_sequence<kDirections.size()>{});
}

}  // namespace

template <class Edges>
template <std::size_t kDirections>
void EdgeExtractor<Edges>::Crossings<kDirections>::resize(std::size_t words) {
  for (std::vector<std::uint64_t>& direction : along) direction.resize(words);
  base.resize(words);
}

template <class Edges>
template <std::size_t kDirections>
std::uint32_t EdgeExtractor<Edges>::Crossings<kDirections>::count(std::size_t word) const {
  std::uint32_t count = 0;
  for (const std::vector<std::uint64_t>& direction : along) count += ones(direction[word]);
  return count;
}

template <class Edges>
EdgeExtractor<Edges>::EdgeExtractor(const VolumeInfo& volume, const ExtractOptions& options,
                                    const VertexNumbering& numbering, const Executor& executor)
    : numbering_(numbering),
      first_(options.part_of.value_or(PartOfLattice{}).first),
      type_(volume.type),
      spacing_(volume.geometry.spacing),
      options_(options),
      slab_(volume, options.rule, options.cells_of(volume), 0, executor),
      on_slices_(1) {
  on_slices_[0].resize(slab_.plane_words());
}

template <class Edges>
std::pair<std::int64_t, std::int64_t> EdgeExtractor<Edges>::slices_for(std::int64_t layers) const {
  const std::int64_t margin = options_.normals ? 1 : 0;
  return {slab_.next_layer() - margin, slab_.next_layer() + layers + 1 + margin};
}

template <class Edges>
SlabCounts EdgeExtractor<Edges>::extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                                         SurfacePiece& piece) {
  piece.clear();
  piece.inherited = front_size_;
  auto count = to_size(layers);
  resize(count);
  slab_.classify(window, count);
  count_rows(window, count);
  count = layers_within(rows_, slab_.rows(), most_vertices);
  rows_.resize(count * slab_.rows());
  make_room(rows_, count, options_.normals, piece);
  visit_sample_type(type_, [&]<class T>() {
    if (needs_places()) emit_front<T>(window);
    emit_vertices<T>(window, count, piece);
  });
  slab_.for_rows(count, [&](std::size_t n, std::size_t row, std::size_t number) {
    if (triangles_of(number).second > 0) write_cells(window, {n, row, number}, piece);
  });
  slab_.advance(count);
  std::swap(on_slices_.front(), on_slices_[count]);
  list_front(piece);
  if (layers_left() > 0) piece.complete_below = static_cast<double>(first_[2] + slab_.next_layer()) * spacing_[2];
  return {static_cast<std::int64_t>(count), piece.cells_crossed, piece.triangles.size(), piece.positions.size()};
}

template <class Edges>
void EdgeExtractor<Edges>::resize(std::size_t layers) {
  on_slices_.resize(layers + 1);
  in_layers_.resize(layers);
  for (std::size_t n = 0; n < layers; ++n) {
    on_slices_[n + 1].resize(slab_.plane_words());
    in_layers_[n].resize(slab_.plane_words());
  }
  crossed_.resize(to_size(to_size(layers, slab_.rows()), slab_.words()));
  rows_.resize(to_size(layers, slab_.rows()));
}

template <class Edges>
void EdgeExtractor<Edges>::find_on_slice(std::ptrdiff_t n, std::size_t row, OnSlice& slice) const {
  for_directions<Edges::kOnSlice>(
      [&]<std::uint8_t Direction>(std::size_t d) { slab_.find_along<Direction>(n, row, slice.along[d]); });
}

template <class Edges>
void EdgeExtractor<Edges>::find_in_layer(std::ptrdiff_t n, std::size_t row, InLayer& layer) const {
  for_directions<Edges::kInLayer>(
      [&]<std::uint8_t Direction>(std::size_t d) { slab_.find_along<Direction>(n, row, layer.along[d]); });
}

// Counts the crossings of a row of layer n, and of the slice above it.
template <class Edges>
std::uint32_t EdgeExtractor<Edges>::count_crossings(std::size_t n, std::size_t row) const {
  std::uint32_t count = 0;
  for (std::size_t w = row * slab_.words(); w < (row + 1) * slab_.words(); ++w) {
    count += in_layers_[n].count(w) + on_slices_[n + 1].count(w);
  }
  return count;
}

template <class Edges>
std::uint32_t EdgeExtractor<Edges>::first_inside(const Row& at) const {
  return front_size_ + rows_[at.number].vertices + count_crossings(at.n, at.row);
}

// Counts the crossings in the faces of an open volume. The surface's border runs through them, so there are as many
// open edges as such crossings.
template <class Edges>
std::uint32_t EdgeExtractor<Edges>::crossings_on_border(std::size_t n, std::size_t row) const {
  const auto is_end = [](std::int64_t at, std::int64_t size) { return at == 0 || at == size - 1; };
  const bool end_slice = is_end(slab_.next_layer() + static_cast<std::int64_t>(n) + 1, slab_.dims()[2]);
  const bool end_row = is_end(static_cast<std::int64_t>(row) - 1, slab_.dims()[1]);
  std::uint32_t count = 0;
  const auto add = [&](std::uint8_t direction, const std::vector<std::uint64_t>& crossings) {
    const bool in_face = ((direction & 4) == 0 && end_slice) || ((direction & 2) == 0 && end_row);
    if (!in_face && (direction & 1) != 0) return;
    for (std::size_t w = 0; w < slab_.words(); ++w) {
      const std::uint64_t word = crossings[row * slab_.words() + w];
      count += ones(in_face ? word : word & slab_.end_mask()[w]);
    }
  };
  for (std::size_t d = 0; d < Edges::kOnSlice.size(); ++d) add(Edges::kOnSlice[d], on_slices_[n + 1].along[d]);
  for (std::size_t d = 0; d < Edges::kInLayer.size(); ++d) add(Edges::kInLayer[d], in_layers_[n].along[d]);
  return count;
}

// Finds the crossings of every row, and counts them and what lies in the cells.
template <class Edges>
void EdgeExtractor<Edges>::count_rows(const SliceWindow& window, std::size_t layers) {
  slab_.for_rows(layers, [&](std::size_t n, std::size_t row, std::size_t number) {
    find_in_layer(static_cast<std::ptrdiff_t>(n), row, in_layers_[n]);
    find_on_slice(static_cast<std::ptrdiff_t>(n) + 1, row, on_slices_[n + 1]);
    RowCounts counts;
    counts.vertices = count_crossings(n, row);
    if (!options_.rule.closed) counts.on_border = crossings_on_border(n, row);
    const std::span crossed(&crossed_[number * slab_.words()], slab_.words());
    counts.cells = slab_.find_crossed(static_cast<std::ptrdiff_t>(n), row, crossed);
    if (counts.cells > 0) count_cells(window, {n, row, number}, counts);
    rows_[number] = counts;
  });
}

// Numbers the crossings of a row word by word: those of the layer below the slice, then those on it.
template <class Edges>
void EdgeExtractor<Edges>::number_row(std::size_t n, std::size_t row, std::uint32_t base) {
  for (std::size_t w = row * slab_.words(); w < (row + 1) * slab_.words(); ++w) {
    in_layers_[n].base[w] = base;
    base += in_layers_[n].count(w);
    on_slices_[n + 1].base[w] = base;
    base += on_slices_[n + 1].count(w);
  }
}

// The vertices that are being made, by their numbers: what is null is not wanted.
template <class Edges>
struct EdgeExtractor<Edges>::Vertices {
  std::uint32_t first;  // number
  Vec3* positions;
  std::uint64_t* ids;
  Point* normals;
};

// A row of lattice edges of a direction, between the samples of two rows, or of one row for direction x.
template <class Edges>
template <class T, std::uint8_t Direction>
struct EdgeExtractor<Edges>::EdgeRow {
  SampleRow<T> low, high;       // high[i], where edges go along x high[i + 1], is the other end of the edge from low[i]
  const std::uint64_t* inside;  // the bits of the lower ends
  std::int64_t j, k;            // of the lower ends
  std::uint64_t first_id;       // of bit 0
};

// Makes the places of the inherited vertices again.
template <class Edges>
template <class T>
void EdgeExtractor<Edges>::emit_front(const SliceWindow& window) {
  const SampleView<T> samples(window, options_.rule.iso);
  front_places_.resize(front_size_);
  const Vertices out{0, front_places_.data(), nullptr, nullptr};
  slab_.for_rows(1, [&](std::size_t, std::size_t row, std::size_t) {
    emit_row<T, Edges::kOnSlice>(samples, on_slices_[0], 0, row, out);
  });
}

// Numbers the crossings, after the inherited ones, and makes their vertices.
template <class Edges>
template <class T>
void EdgeExtractor<Edges>::emit_vertices(const SliceWindow& window, std::size_t layers, SurfacePiece& piece) {
  const SampleView<T> samples(window, options_.rule.iso);
  const Vertices out{front_size_, piece.positions.data(), piece.ids.data(),
                     options_.normals ? piece.normals.data() : nullptr};
  slab_.for_rows(layers, [&](std::size_t n, std::size_t row, std::size_t number) {
    const std::uint32_t first = rows_[number].vertices;
    if (first == rows_[number + 1].vertices) return;  // no cell asks for numbers there
    number_row(n, row, front_size_ + first);
    emit_row<T, Edges::kInLayer>(samples, in_layers_[n], n, row, out);
    emit_row<T, Edges::kOnSlice>(samples, on_slices_[n + 1], n + 1, row, out);
  });
}

// Makes the vertices of the edges that begin in a row of slice n of the slab, direction by direction.
template <class Edges>
template <class T, auto kDirections>
void EdgeExtractor<Edges>::emit_row(const SampleView<T>& samples, const Crossings<kDirections.size()>& crossings,
                                    std::size_t n, std::size_t row, const Vertices& out) const {
  for_directions<kDirections>([&]<std::uint8_t Direction>(std::size_t d) {
    const EdgeRow<T, Direction> edges = edges_of<T, Direction>(samples, n, row);
    for (std::size_t w = 0; w < slab_.words(); ++w) {
      const std::size_t at = row * slab_.words() + w;
      if (crossings.along[d][at] == 0) continue;
      std::uint32_t number = crossings.base[at];
      for (std::size_t before = 0; before < d; ++before) number += ones(crossings.along[before][at]);
      emit_word(samples, edges, w, crossings.along[d][at], number, out);
    }
  });
}

template <class Edges>
template <class T, std::uint8_t Direction>
auto EdgeExtractor<Edges>::edges_of(const SampleView<T>& samples, std::size_t n, std::size_t row) const
    -> EdgeRow<T, Direction> {
  const std::int64_t j = static_cast<std::int64_t>(row) - 1;
  const std::int64_t k = slab_.next_layer() + static_cast<std::int64_t>(n);
  return {samples.row(j, k),
          samples.row(j + (Direction >> 1 & 1), k + (Direction >> 2)),
          slab_.inside(static_cast<std::ptrdiff_t>(n), row),
          j,
          k,
          numbering_.id(first_[0] - 1, first_[1] + j, first_[2] + k, slot_of_direction<Edges>(Direction))};
}

// Makes the vertices of the crossings of one word, numbered from `number` on.
template <class Edges>
template <class T, std::uint8_t Direction>
void EdgeExtractor<Edges>::emit_word(const SampleView<T>& samples, const EdgeRow<T, Direction>& edges, std::size_t w,
                                     std::uint64_t crossings, std::uint32_t number, const Vertices& out) const {
  constexpr bool kX = (Direction & 1) != 0, kY = (Direction & 2) != 0, kZ = (Direction & 4) != 0;
  const auto j = static_cast<double>(first_[1] + edges.j);
  const auto k = static_cast<double>(first_[2] + edges.k);
  std::size_t at = number - out.first;
  for_each_bit(crossings, w, [&](std::int64_t bit) {
    const std::int64_t i = bit - 1;
    const double f0 = edges.low[i];
    const double f1 = edges.high[kX ? i + 1 : i];
    const bool low_inside = (edges.inside[w] >> (bit & 63) & 1) != 0;
    const double t = crossing_parameter(f0, f1, samples.iso(), low_inside);
    const auto low = static_cast<double>(first_[0] + i);
    out.positions[at] = {(kX ? low + t : low) * spacing_[0], (kY ? j + t : j) * spacing_[1],
                         (kZ ? k + t : k) * spacing_[2]};
    if (out.ids != nullptr) out.ids[at] = edges.first_id + numbering_.slots * static_cast<std::uint64_t>(bit);
    if (out.normals != nullptr) {
      const Crossing crossing{{i, edges.j, edges.k}, Direction, f0, f1, t, low_inside};
      out.normals[at] = normal_at(samples, crossing, spacing_, options_.rule.above);
    }
    ++at;
  });
}

// The crossings of the last slice are incomplete; they become the numbers 0, 1, ... of the next slab, in this order.
template <class Edges>
void EdgeExtractor<Edges>::list_front(SurfacePiece& piece) {
  front_size_ = 0;
  if (layers_left() == 0) return;
  number_front([&](std::uint32_t before) { piece.incomplete.push_back(before); });
}

// Numbers the crossings of the front. see(number) is told the number that each had in the slab.
template <class Edges>
template <class See>
void EdgeExtractor<Edges>::number_front(const See& see) {
  OnSlice& front = on_slices_.front();
  for (std::size_t at = 0; at < front.base.size(); ++at) {
    const std::uint32_t count = front.count(at);
    for (std::uint32_t n = 0; n < count; ++n) see(front.base[at] + n);
    front.base[at] = front_size_;
    front_size_ += count;
  }
}

template <class Edges>
void EdgeExtractor<Edges>::serialize(StateReader& state) {
  slab_.serialize(state);
  for (std::size_t row = 0; row < slab_.rows(); ++row) find_on_slice(0, row, on_slices_.front());
  front_size_ = 0;
  if (layers_left() > 0) number_front([](std::uint32_t) {});
}

template class EdgeExtractor<CubeEdges>;
template class EdgeExtractor<KuhnEdges>;

}  // namespace isoweave
