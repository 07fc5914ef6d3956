#include "simplify/zone_part.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "simplify/part_linker.hpp"

namespace isoweave {
namespace {

// The vertices and triangles that a zone holds, in the order of a part.
class PartOrder {
 public:
  PartOrder(const ZoneView& zone, std::span<const Index> front) : zone_(zone), place_(zone.vertices.size(), kNone) {
    list_vertices(front);
    list_triangles();
  }

  std::span<const Index> vertices() const { return vertices_; }
  std::span<const Index> triangles() const { return triangles_; }
  Index place(Index v) const { return place_[v]; }

 private:
  struct NamedVertex {
    std::uint64_t id;
    Index vertex;
  };

  // Lists the vertices that are held: those of triangles, and those to which later pieces add.
  void list_vertices(std::span<const Index> front) {
    for (const Index v : front) place_[v] = 0;
    for (const Triangle& triangle : zone_.triangles) {
      if (triangle.sides[0].vertex == kNone) continue;
      for (const HalfEdge& side : triangle.sides) place_[side.vertex] = 0;
    }
    std::vector<NamedVertex> held;
    held.reserve(place_.size() - static_cast<std::size_t>(std::count(place_.begin(), place_.end(), kNone)));
    for (Index v = 0; v < place_.size(); ++v) {
      if (place_[v] != kNone) held.push_back({zone_.vertices[v].id, v});
    }
    std::sort(held.begin(), held.end(), [](const NamedVertex& a, const NamedVertex& b) { return a.id < b.id; });
    vertices_.resize(held.size());
    for (std::size_t n = 0; n < held.size(); ++n) {
      vertices_[n] = held[n].vertex;
      place_[held[n].vertex] = static_cast<Index>(n);
    }
  }

  // Groups the triangles by their first vertices, and sorts the few of each by the second one. No two triangles have
  // both in common, in this order.
  void list_triangles() {
    std::vector<Index> end(vertices_.size() + 1, 0);
    each_triangle([&](Index first) { ++end[place(zone_.origin(first)) + 1]; });
    std::partial_sum(end.begin(), end.end(), end.begin());
    triangles_.resize(end.back());
    each_triangle([&](Index first) { triangles_[end[place(zone_.origin(first))]++] = first; });
    Index begin = 0;
    for (const Index group_end : std::span(end).first(vertices_.size())) {
      std::sort(triangles_.begin() + begin, triangles_.begin() + group_end,
                [&](Index a, Index b) { return place(zone_.destination(a)) < place(zone_.destination(b)); });
      begin = group_end;
    }
  }

  // Calls visit(half-edge from the first vertex) for all triangles.
  template <class Visit>
  void each_triangle(const Visit& visit) const {
    for (Index t = 0; t < zone_.triangle_count(); ++t) {
      if (!zone_.alive(half_edge(t, 0))) continue;
      Index first = half_edge(t, 0);
      for (Index c = 1; c < 3; ++c) {
        if (place(zone_.origin(half_edge(t, c))) < place(zone_.origin(first))) first = half_edge(t, c);
      }
      visit(first);
    }
  }

  const ZoneView& zone_;
  std::vector<Index> place_;      // per vertex of the zone; kNone: it is not held
  std::vector<Index> vertices_;   // of the zone
  std::vector<Index> triangles_;  // by the half-edges from their first vertices
};

// The three half-edges of a triangle from one of them on.
std::array<Index, 3> sides_from(Index h) { return {h, next(h), previous(h)}; }

bool all_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool all_finite(const Quadric& q) {
  return all_finite(Vec3{q.xx, q.xy, q.xz}) && all_finite(Vec3{q.yy, q.yz, q.zz}) && all_finite(q.b) &&
         std::isfinite(q.c);
}

bool all_finite(const NormalQuadric& q) {
  return all_finite(q.gradient[0]) && all_finite(q.gradient[1]) && all_finite(q.gradient[2]) && all_finite(q.offset) &&
         std::isfinite(q.weight);
}

bool all_finite(const Point& p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); }

using LevelsAndBounds = std::array<std::uint8_t, 4>;

// Reads the fields of a part, each of which is checked by itself.
class PartReader {
 public:
  PartReader(StateReader& state, const PartShape& shape) : state_(state), shape_(shape) {}

  ZonePart read() {
    read_vertices();
    read_attributes();
    part_.levels.resize(shape_.ends.size() - 1);
    for (std::size_t level = 0; level < part_.levels.size(); ++level) read_level(level);
    read_triangles();
    read_front();
    return std::move(part_);
  }

 private:
  std::size_t vertices() const { return part_.vertices.size(); }

  void read_vertices() {
    const std::size_t count = state_.count(sizeof(std::uint64_t));
    state_.require(count < (Index{1} << 31), "fewer vertices than a zone may hold");
    part_.vertices.resize(count);
    part_.states.resize(count);
    std::fill(part_.vertices.begin(), part_.vertices.end(), Vertex());
    state_.each<std::uint64_t>(count, [&](std::size_t n, std::uint64_t id) {
      state_.require(n == 0 || part_.vertices[n - 1].id < id, "ids that ascend");
      state_.require(id < shape_.end_id, "ids of the volume's vertices");
      part_.vertices[n].id = id;
    });
    state_.each<Vec3>(count, [&](std::size_t n, const Vec3& position) {
      state_.require(lies_within(position, shape_.farthest), "positions that are not far away from the volume");
      part_.vertices[n].position = position;
    });
    state_.each<Quadric>(count, [&](std::size_t n, const Quadric& quadric) {
      state_.require(all_finite(quadric), "quadrics that are finite");
      part_.vertices[n].quadric = quadric;
    });
    read_receipts(
        shape_.ends.back(), [&](std::size_t n) -> std::uint64_t& { return part_.vertices[n].number; },
        [&](std::size_t n) -> std::uint32_t& { return part_.vertices[n].label; },
        [&](std::size_t n, bool final) { part_.states[n] = final ? VertexState::kFinal : VertexState::kComplete; });
  }

  template <class Number, class Label, class SetFinal>
  void read_receipts(const Receipt& end, const Number& number, const Label& label, const SetFinal& set_final) {
    state_.each<std::uint8_t>(vertices(), [&](std::size_t n, std::uint8_t final) {
      state_.require(final <= 1, "vertices that are final or not");
      set_final(n, final == 1);
    });
    state_.each<std::uint64_t>(vertices(), [&](std::size_t n, std::uint64_t value) {
      state_.require(value == kNotHandedOver || value < end.number, "numbers of vertices that have been written");
      number(n) = value;
    });
    state_.each<std::uint32_t>(vertices(), [&](std::size_t n, std::uint32_t value) {
      state_.require(number(n) == kNotHandedOver || value < std::max<std::uint32_t>(end.label, 1),
                     "labels of components");
      label(n) = value;
    });
  }

  void read_attributes() {
    const auto read_all = [&](bool has, auto& array, const char* what) {
      using T = std::remove_cvref_t<decltype(array[0])>;
      array.resize(has ? vertices() : 0);
      state_.each<T>(array.size(), [&](std::size_t n, const T& value) {
        if constexpr (!std::is_same_v<T, float>) state_.require(all_finite(value), what);
        array[n] = value;
      });
    };
    read_all(shape_.normals, part_.normals, "normals that are finite");
    read_all(shape_.normal_quadrics, part_.normal_quadrics, "quadrics of normals that are finite");
    read_all(shape_.values, part_.values, "");
  }

  void read_level(std::size_t level) {
    Array<LevelVertex>& facts = part_.levels[level];
    facts.resize(vertices());
    std::fill(facts.begin(), facts.end(), LevelVertex());
    read_receipts(
        shape_.ends[level], [&](std::size_t n) -> std::uint64_t& { return facts[n].number; },
        [&](std::size_t n) -> std::uint32_t& { return facts[n].label; },
        [&](std::size_t n, bool final) { facts[n].final = final; });
  }

  void read_triangles() {
    using Three = std::array<std::uint32_t, 3>;
    const std::size_t count = state_.count(sizeof(Three));
    state_.require(count < kWritten / 4, "fewer triangles than a zone may hold");
    part_.triangles.resize(count);
    std::fill(part_.triangles.begin(), part_.triangles.end(), Triangle());
    const auto side = [&](std::size_t t, std::size_t c) -> HalfEdge& { return part_.triangles[t].sides[c]; };
    state_.each<Three>(count, [&](std::size_t t, const Three& corners) {
      for (std::size_t c = 0; c < 3; ++c) {
        state_.require(corners[c] < vertices() && corners[c] != corners[(c + 1) % 3], "triangles of three vertices");
        side(t, c).vertex = corners[c];
      }
    });
    state_.each<std::array<Key, 3>>(count, [&](std::size_t t, const std::array<Key, 3>& keys) {
      for (std::size_t c = 0; c < 3; ++c) side(t, c).key = keys[c];
    });
    state_.each<Three>(count, [&](std::size_t t, const Three& ties) { part_.triangles[t].tie_low = ties; });
    state_.each<std::uint8_t>(count, [&](std::size_t t, std::uint8_t written) {
      state_.require(written < 8, "bits for three sides");
      for (std::size_t c = 0; c < 3; ++c) side(t, c).twin = (written >> c & 1) != 0 ? kWritten : kNone;
    });
    state_.each<LevelsAndBounds>(count, [&](std::size_t t, const LevelsAndBounds& of) {
      state_.require(of[0] < shape_.ends.size(), "triangles of the levels of the run");
      part_.triangles[t].levels = of[0];
      part_.triangles[t].bounds = {of[1], of[2], of[3]};
    });
  }

  void read_front() {
    const std::size_t count = state_.count(sizeof(Index));
    part_.front.resize(count);
    state_.each<Index>(count, [&](std::size_t n, Index v) {
      state_.require(v < vertices() && part_.states[v] == VertexState::kComplete,
                     "a front of vertices that are not final");
      part_.states[v] = VertexState::kIncomplete;
      part_.front[n] = v;
    });
  }

  StateReader& state_;
  const PartShape& shape_;
  ZonePart part_;
};

}  // namespace

ZoneView ZonePart::view() {
  const auto show = [](auto& array) { return std::span(array.data(), array.size()); };
  ZoneView view;
  view.vertices = show(vertices);
  view.states = show(states);
  view.normals = show(normals);
  view.normal_quadrics = show(normal_quadrics);
  view.values = show(values);
  view.triangles = show(triangles);
  return view;
}

void write_part(StateWriter& state, const ZoneView& zone, std::span<const Array<LevelVertex>> levels,
                std::span<const Index> front) {
  const PartOrder order(zone, front);
  const auto each_vertex = [&](const auto& field) {
    state.each(order.vertices().size(), [&](std::size_t n) { return field(order.vertices()[n]); });
  };
  const auto each_triangle = [&](const auto& field) {
    state.each(order.triangles().size(), [&](std::size_t n) { return field(sides_from(order.triangles()[n])); });
  };
  state.value(static_cast<std::uint64_t>(order.vertices().size()));
  each_vertex([&](Index v) { return zone.vertices[v].id; });
  each_vertex([&](Index v) { return zone.vertices[v].position; });
  each_vertex([&](Index v) { return zone.vertices[v].quadric; });
  each_vertex([&](Index v) { return static_cast<std::uint8_t>(zone.states[v] == VertexState::kFinal); });
  each_vertex([&](Index v) { return zone.vertices[v].number; });
  each_vertex([&](Index v) { return zone.vertices[v].label; });
  if (!zone.normals.empty()) each_vertex([&](Index v) { return zone.normals[v]; });
  if (!zone.normal_quadrics.empty()) each_vertex([&](Index v) { return zone.normal_quadrics[v]; });
  if (!zone.values.empty()) each_vertex([&](Index v) { return zone.values[v]; });
  for (const Array<LevelVertex>& level : levels) {
    each_vertex([&](Index v) { return static_cast<std::uint8_t>(level[v].final); });
    each_vertex([&](Index v) { return level[v].number; });
    each_vertex([&](Index v) { return level[v].label; });
  }
  using Sides = std::array<Index, 3>;
  const auto of_each = [](const Sides& sides, const auto& field) {
    return std::array{field(sides[0]), field(sides[1]), field(sides[2])};
  };
  state.value(static_cast<std::uint64_t>(order.triangles().size()));
  each_triangle(
      [&](const Sides& sides) { return of_each(sides, [&](Index h) { return order.place(zone.origin(h)); }); });
  each_triangle([&](const Sides& sides) { return of_each(sides, [&](Index h) { return zone.key(h); }); });
  each_triangle([&](const Sides& sides) { return of_each(sides, [&](Index h) { return zone.tie_low(h); }); });
  each_triangle([&](const Sides& sides) {
    unsigned written = 0;
    for (std::size_t c = 0; c < 3; ++c) written |= unsigned{zone.twin(sides[c]) == kWritten} << c;
    return static_cast<std::uint8_t>(written);
  });
  each_triangle([&](const Sides& sides) {
    const Triangle& triangle = zone.triangles[sides[0] >> 2];
    LevelsAndBounds of{triangle.levels};
    for (std::size_t c = 0; c < 3; ++c) of[c + 1] = triangle.bounds[sides[c] & 3];
    return of;
  });
  state.value(static_cast<std::uint64_t>(front.size()));
  state.each(front.size(), [&](std::size_t n) { return order.place(front[n]); });
}

void write_part(StateWriter& state, ZonePart& part) {
  std::vector<Index> incomplete;
  for (Index v = 0; v < part.states.size(); ++v) {
    if (part.states[v] == VertexState::kIncomplete) incomplete.push_back(v);
  }
  write_part(state, part.view(), part.levels, incomplete);
}

ZonePart read_cut_part(StateReader& state, const PartShape& shape) {
  ZonePart part = PartReader(state, shape).read();
  part.front = {};
  return part;
}

ZonePart read_part(StateReader& state, const PartShape& shape) {
  ZonePart part = PartReader(state, shape).read();
  const Executor alone(1);
  link_part(part, shape.retire, PartScope::kAll, alone,
            [&](bool holds, const char* what) { state.require(holds, what); });
  return part;
}

}  // namespace isoweave
