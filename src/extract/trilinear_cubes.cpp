#include "extract/trilinear_cubes.hpp"

#include <algorithm>
#include <limits>

#include "extract/cell_cases.hpp"
#include "extract/polygon_lists.hpp"
#include "extract/trilinear_rules.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

constexpr std::uint32_t kCentreSlot = 3;
constexpr std::uint32_t kWaistSlot = 4;  // the first of six

using Triangle = std::array<std::uint32_t, 3>;
using Numbers = std::array<std::uint32_t, 16>;

const std::array<bool, 256>& differing_cases() {
  static const std::array<bool, 256> kDiffers = [] {
    std::array<bool, 256> differs{};
    for (std::uint32_t cell = 0; cell < 256; ++cell) differs[cell] = may_differ(cell);
    return differs;
  }();
  return kDiffers;
}

// The samples around a row of cells.
template <class T>
class CornerRows {
 public:
  CornerRows(const SampleView<T>& samples, const IsoRule& rule, std::int64_t j, std::int64_t k)
      : rows_{samples.row(j, k), samples.row(j + 1, k), samples.row(j, k + 1), samples.row(j + 1, k + 1)},
        iso_(samples.iso()),
        above_(rule.above) {}

  // The values at the corners of the cell that begins with sample i.
  CornerValues values(std::int64_t i) const {
    CornerValues values;
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const double sample = rows_[corner / 2][i + static_cast<std::int64_t>(corner % 2)];
      values[corner] = above_ ? sample - iso_ : iso_ - sample;
    }
    return values;
  }

 private:
  std::array<SampleRow<T>, 4> rows_;
  double iso_;
  bool above_;
};

// A closed line of vertices.
struct Ring {
  std::array<std::uint32_t, kCellEdges> number{};
  std::array<Vec3, kCellEdges> place{};
  std::size_t size = 0;

  void add(std::uint32_t vertex, const Vec3& at) {
    number[size] = vertex;
    place[size++] = at;
  }

  void turn_around() {
    std::reverse(number.begin(), number.begin() + static_cast<std::ptrdiff_t>(size));
    std::reverse(place.begin(), place.begin() + static_cast<std::ptrdiff_t>(size));
  }

  // Twice the area that it encloses, as a vector.
  Vec3 area() const {
    Vec3 sum;
    for (std::size_t n = 0; n < size; ++n) sum = sum + cross(place[n] - place[0], place[(n + 1) % size] - place[0]);
    return sum;
  }
};

// The way once around a loop and once around a ring, corner by corner. It never goes around one of them at a single
// corner of the other: the side there would be used four times.
class StripPath {
 public:
  StripPath(std::size_t loop, std::size_t ring) : loop_(loop), ring_(ring) {}

  bool is_done() const { return m_ == loop_ && n_ == ring_; }
  std::pair<std::size_t, std::size_t> at() const { return {m_, n_}; }

  // Goes on along the loop if that is wanted and can be, else along the ring. Returns whether it was the loop.
  bool step(bool along_loop) {
    along_loop = n_ == ring_ || (m_ < loop_ && along_loop);
    if (m_ + 1 == loop_ && n_ == loop_from_ && n_ < ring_) along_loop = false;
    if (n_ + 1 == ring_ && m_ == ring_from_ && m_ < loop_) along_loop = true;
    if (along_loop) {
      if (m_++ == 0) loop_from_ = n_;
    } else {
      if (n_++ == 0) ring_from_ = m_;
    }
    return along_loop;
  }

 private:
  static constexpr std::size_t kNowhere = ~std::size_t{0};

  std::size_t loop_, ring_;
  std::size_t m_ = 0, n_ = 0;                                // steps along the loop and the ring
  std::size_t loop_from_ = kNowhere, ring_from_ = kNowhere;  // of the other one, at the first step
};

// The corners of two rings that are nearest to each other, the first ones of those.
std::pair<std::size_t, std::size_t> nearest(const Ring& a, const Ring& b) {
  std::pair<std::size_t, std::size_t> best{0, 0};
  const auto distance = [&](std::size_t m, std::size_t n) { return squared_distance(a.place[m], b.place[n]); };
  for (std::size_t m = 0; m < a.size; ++m) {
    for (std::size_t n = 0; n < b.size; ++n) {
      if (distance(m, n) < distance(best.first, best.second)) best = {m, n};
    }
  }
  return best;
}

}  // namespace

TrilinearCubes::TrilinearCubes(const VolumeInfo& volume, const ExtractOptions& options, const Executor& executor)
    : MarchingCubes(volume, options, VertexNumbering::of_cubes(options.whole(volume)), executor) {}

bool TrilinearCubes::has_choices(const CellRow& cells) const {
  bool found = false;
  for (std::size_t w = 0; w < cells.words && !found; ++w) {
    if (cells.crossed[w] == 0) continue;
    for (const unsigned half : {0U, 1U}) {
      for_cells(cells, w, half, [&](int, std::uint32_t cell) { found = found || differing_cases()[cell]; });
    }
  }
  return found;
}

void TrilinearCubes::count_cells(const SliceWindow& window, const Row& at, RowCounts& counts) const {
  MarchingCubes::count_cells(window, at, counts);
  if (!has_choices(cell_row(at))) return;
  visit_sample_type(sample_type(), [&]<class T>() { count_choices<T>(window, at, counts); });
}

// Counts what cells with choices have more than those of marching cubes, or less.
template <class T>
void TrilinearCubes::count_choices(const SliceWindow& window, const Row& at, RowCounts& counts) const {
  const SampleView<T> samples(window, options().rule.iso);
  const CornerRows<T> rows(samples, options().rule, static_cast<std::int64_t>(at.row) - 1,
                           slab().next_layer() + static_cast<std::int64_t>(at.n));
  const CellRow cells = cell_row(at);
  for (std::size_t w = 0; w < cells.words; ++w) {
    if (cells.crossed[w] == 0) continue;
    for (const unsigned half : {0U, 1U}) {
      for_cells(cells, w, half, [&](int bit, std::uint32_t cell) {
        if (!differing_cases()[cell]) return;
        const auto i = static_cast<std::int64_t>(64 * w + 32 * half) + bit - 1;
        const CellTopology topology = topology_of(cell, rows.values(i));
        counts.triangles += topology.triangles() - kCaseTable[cell].triangles;
        counts.vertices += topology.vertices();
      });
    }
  }
}

void TrilinearCubes::write_cells(const SliceWindow& window, const Row& at, SurfacePiece& piece) const {
  if (!has_choices(cell_row(at))) return MarchingCubes::write_cells(window, at, piece);
  visit_sample_type(sample_type(), [&]<class T>() { write_row<T>(window, at, piece); });
}

// Writes a row of cells, one after the other.
template <class T>
class TrilinearCubes::RowWriter {
 public:
  RowWriter(const TrilinearCubes& cubes, const SliceWindow& window, const Row& at, SurfacePiece& piece)
      : cubes_(cubes),
        piece_(piece),
        samples_(window, cubes.options().rule.iso),
        low_{-1, static_cast<std::int64_t>(at.row) - 1, cubes.slab().next_layer() + static_cast<std::int64_t>(at.n)},
        rows_(samples_, cubes.options().rule, low_[1], low_[2]),
        places_(cubes.places(piece)),
        polygons_(places_),
        vertex_(cubes.first_inside(at)),
        triangle_(piece.triangles.data() + cubes.triangles_of(at.number).first) {}

  void write(std::size_t bit, std::uint32_t cell, const Numbers& numbers) {
    low_[0] = static_cast<std::int64_t>(bit) - 1;
    if (differing_cases()[cell]) return write_choice(cell, numbers);
    std::uint32_t* const corners = triangle_->data();
    const std::uint8_t* place = kCornerPlaces[cell].data();
    for (std::size_t t = 0; t < kCaseTable[cell].triangles; ++t, ++triangle_) {
      for (std::uint32_t& corner : *triangle_) corner = numbers[*place++];
    }
    polygons_.add(cell, corners);
    polygons_.make_room();
  }

  // Chooses the diagonals that are left.
  void finish() { polygons_.choose(); }

 private:
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) { *triangle_++ = {a, b, c}; }

  void write_choice(std::uint32_t cell, const Numbers& numbers) {
    values_ = rows_.values(low_[0]);
    const CellTopology topology = topology_of(cell, values_);
    for (std::size_t n = 0; n < topology.loops; ++n) {
      if (topology.is_in_tunnel(n)) continue;
      const Ring ring = ring_of(topology.loop[n], numbers);
      if (topology.has_centre[n]) {
        add_fan(ring);
      } else {
        add_polygon(topology.loop[n], ring);
      }
    }
    if (topology.has_tunnel) add_tunnel(topology, numbers);
  }

  Ring ring_of(const CellLoop& loop, const Numbers& numbers) const {
    Ring ring;
    for (std::size_t n = 0; n < static_cast<std::size_t>(loop.size); ++n) {
      const std::uint32_t number = numbers[corner_place(static_cast<std::size_t>(loop.edges[n]))];
      ring.add(number, places_(number));
    }
    return ring;
  }

  // Adds the triangles of a loop between its own vertices, with the diagonals of marching cubes.
  void add_polygon(const CellLoop& loop, const Ring& ring) {
    if (loop.size == 5 && table_rules::ear_of(loop) >= 0) return add_without_ear(loop, ring);
    const ShortestDiagonals<kCellEdges> shortest(ring.size, [&](std::size_t a, std::size_t b) {
      return table_rules::share_face(loop.edges[a], loop.edges[b]) ? std::numeric_limits<double>::infinity()
                                                                   : squared_distance(ring.place[a], ring.place[b]);
    });
    shortest.for_each_triangle(
        [&](std::size_t a, std::size_t b, std::size_t c) { add(ring.number[a], ring.number[b], ring.number[c]); });
  }

  void add_without_ear(const CellLoop& loop, const Ring& ring) {
    const auto ear = static_cast<std::size_t>(table_rules::ear_of(loop));
    const auto n = [&](std::size_t step) { return ring.number[(ear + step) % 5]; };
    const auto place = [&](std::size_t step) { return ring.place[(ear + step) % 5]; };
    const bool from_2 = squared_distance(place(2), place(4)) < squared_distance(place(1), place(3));
    add(n(0), n(1), n(4));
    add(n(1), n(2), from_2 ? n(4) : n(3));
    add(from_2 ? n(2) : n(1), n(3), n(4));
  }

  // Adds the triangles of a loop around a vertex in its middle.
  void add_fan(const Ring& ring) {
    Vec3 sum;
    for (std::size_t n = 0; n < ring.size; ++n) sum = sum + in_cell(ring.place[n]);
    const Vec3 mean = (1 / static_cast<double>(ring.size)) * sum;
    const std::uint32_t centre = add_vertex(nearby_zero(values_, mean, kCrossingMargin), kCentreSlot);
    for (std::size_t n = 0; n < ring.size; ++n) add(ring.number[n], ring.number[(n + 1) % ring.size], centre);
  }

  // Adds the strips between two loops and the waist of the tunnel between them.
  void add_tunnel(const CellTopology& topology, const Numbers& numbers) {
    Ring waist;
    std::uint32_t slot = kWaistSlot;
    for (const Vec3& at : waist_of(values_)) {
      const std::uint32_t number = add_vertex(clamped(at), slot++);
      waist.add(number, places_(number));
    }
    const Ring first = ring_of(topology.loop[topology.tunnel[0]], numbers);
    const Ring second = ring_of(topology.loop[topology.tunnel[1]], numbers);
    if (dot(first.area() - second.area(), waist.area()) < 0) waist.turn_around();
    add_strip(first, waist);
    waist.turn_around();
    add_strip(second, waist);
  }

  // Adds the strip between a loop and a ring that goes around as the loop does. It begins where they are nearest, and
  // goes on along the shorter of two sides.
  void add_strip(const Ring& loop, const Ring& ring) {
    const auto distance = [&](std::size_t m, std::size_t n) {
      return squared_distance(loop.place[m % loop.size], ring.place[n % ring.size]);
    };
    const std::pair<std::size_t, std::size_t> start = nearest(loop, ring);
    const std::size_t first = start.first, second = start.second;
    const auto on_loop = [&](std::size_t m) { return loop.number[(first + m) % loop.size]; };
    const auto on_ring = [&](std::size_t n) { return ring.number[(second + n) % ring.size]; };
    StripPath path(loop.size, ring.size);
    while (!path.is_done()) {
      const auto [m, n] = path.at();
      const bool nearer = distance(first + m + 1, second + n) <= distance(first + m, second + n + 1);
      if (path.step(nearer)) {
        add(on_loop(m), on_loop(m + 1), on_ring(n));
      } else {
        add(on_loop(m), on_ring(n + 1), on_ring(n));
      }
    }
  }

  // A place of the piece, in the unit cell.
  Vec3 in_cell(const Vec3& place) const {
    const auto& spacing = cubes_.spacing();
    const Vec3 low = whole_low();
    return {place.x / spacing[0] - low.x, place.y / spacing[1] - low.y, place.z / spacing[2] - low.z};
  }

  static Vec3 clamped(const Vec3& at) {
    const auto within = [](double x) {
      return x > kCrossingMargin ? std::min(x, 1 - kCrossingMargin) : kCrossingMargin;
    };
    return {within(at.x), within(at.y), within(at.z)};
  }

  // The sample at which the cell begins, in the whole volume.
  Vec3 whole_low() const {
    const auto& first = cubes_.first_sample();
    return {static_cast<double>(first[0] + low_[0]), static_cast<double>(first[1] + low_[1]),
            static_cast<double>(first[2] + low_[2])};
  }

  // Makes a vertex at a place in the unit cell. Returns its number.
  std::uint32_t add_vertex(const Vec3& at, std::uint32_t slot) {
    const std::size_t index = cubes_.index_of(vertex_);
    const auto& spacing = cubes_.spacing();
    const auto& first = cubes_.first_sample();
    const Vec3 place = whole_low() + at;
    piece_.positions[index] = {place.x * spacing[0], place.y * spacing[1], place.z * spacing[2]};
    piece_.ids[index] = cubes_.numbering().id(first[0] + low_[0], first[1] + low_[1], first[2] + low_[2], slot);
    if (cubes_.options().normals) {
      piece_.normals[index] = cell_normal(samples_, low_, at, spacing, cubes_.options().rule.above);
    }
    return vertex_++;
  }

  const TrilinearCubes& cubes_;
  SurfacePiece& piece_;
  SampleView<T> samples_;
  std::array<std::int64_t, 3> low_;  // sample at which the cell begins
  CornerRows<T> rows_;
  CornerValues values_{};
  VertexPlaces places_;
  PolygonLists polygons_;
  std::uint32_t vertex_;  // the next one inside a cell
  Triangle* triangle_;    // the next one
};

template <class T>
void TrilinearCubes::write_row(const SliceWindow& window, const Row& at, SurfacePiece& piece) const {
  RowWriter<T> writer(*this, window, at, piece);
  for_cell_numbers(cell_row(at), [&](std::size_t bit, std::uint32_t cell, const Numbers& numbers) {
    writer.write(bit, cell, numbers);
  });
  writer.finish();
}

}  // namespace isoweave
