// Counts of a mesh from its triangles alone. Edges are found by sorting: every triangle records its three sides under
// the smaller of their vertices, and the sides of one vertex, a handful, are sorted by the other.
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "isoweave/measure.hpp"
#include "lattice/triangles.hpp"
#include "measure/angles.hpp"
#include "measure/check_around.hpp"
#include "parallel/float_environment.hpp"

namespace isoweave {
namespace {

using measure::operator-;
using Triangle = std::array<std::uint32_t, 3>;

// A corner is numbered 3 * triangle + place; a side has the number of the corner it starts from.
struct Side {
  std::uint32_t high;    // the larger vertex; the smaller one is known from where the side is stored
  bool from_high;        // runs from the larger to the smaller vertex
  std::uint64_t corner;  // where it starts

  bool operator<(const Side& other) const { return high != other.high ? high < other.high : corner < other.corner; }
};

std::uint64_t next_corner(std::uint64_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

// Sides grouped by their smaller vertex: those of vertex v are [first[v], first[v + 1]).
struct SideTable {
  std::vector<std::uint64_t> first;
  std::vector<Side> sides;
};

// Union-find with path halving. The smaller root wins, so the sets do not depend on anything but their members.
template <class Index>
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), Index{0}); }

  Index root(Index i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }

  void unite(Index a, Index b) {
    a = root(a);
    b = root(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<Index> parent_;
};

bool is_degenerate(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

// Calls visit(corner, from, to) for the sides of all triangles with three different vertices.
template <class Visit>
void for_each_side(const TriangleMesh& mesh, Visit&& visit) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    if (is_degenerate(triangle)) continue;
    for (std::size_t i = 0; i < 3; ++i) visit(3 * t + i, triangle[i], triangle[(i + 1) % 3]);
  }
}

SideTable group_sides(const TriangleMesh& mesh) {
  SideTable table;
  table.first.assign(mesh.vertices.size() + 1, 0);
  for_each_side(mesh, [&](std::uint64_t, std::uint32_t from, std::uint32_t to) { ++table.first[std::min(from, to)]; });
  std::uint64_t total = 0;
  for (std::uint64_t& entry : table.first) {
    total += entry;
    entry = total;  // the end of the group for now; storing from the back turns it into the beginning
  }
  table.sides.resize(total);
  for_each_side(mesh, [&](std::uint64_t corner, std::uint32_t from, std::uint32_t to) {
    table.sides[--table.first[std::min(from, to)]] = {std::max(from, to), from > to, corner};
  });
  return table;
}

// Calls visit(low, sides) for every edge, with its smaller vertex and the sides of all triangles along it.
template <class Visit>
void for_each_edge(SideTable& table, Visit&& visit) {
  for (std::size_t low = 0; low + 1 < table.first.size(); ++low) {
    const std::span<Side> group =
        std::span(table.sides).subspan(table.first[low], table.first[low + 1] - table.first[low]);
    std::sort(group.begin(), group.end());
    for (std::size_t begin = 0, end = 0; begin < group.size(); begin = end) {
      while (end < group.size() && group[end].high == group[begin].high) ++end;
      visit(low, group.subspan(begin, end - begin));
    }
  }
}

// Counts how triangles meet at some vertices and along the edges that end there.
class Meetings {
 public:
  // among: per vertex, nonzero for those that count; null: all.
  Meetings(const TriangleMesh& mesh, const std::vector<std::uint8_t>* among)
      : mesh_(mesh), among_(among), corners_(3 * mesh.triangles.size()) {}

  AroundCheck count() {
    count_edges();
    count_fans();
    return result_;
  }

  std::uint64_t vertices() const { return vertices_; }  // named by a triangle

 private:
  bool counts(std::size_t vertex) const { return among_ == nullptr || (*among_)[vertex] != 0; }

  void count_edges() {
    SideTable table = group_sides(mesh_);
    for_each_edge(table, [&](std::size_t low, std::span<const Side> sides) {
      if (sides.size() == 2) join_corners(sides[0], sides[1]);
      if (counts(low) || counts(sides[0].high)) count_edge(sides);
    });
  }

  void count_edge(std::span<const Side> sides) {
    ++result_.edges;
    result_.sides += sides.size();
    if (sides.size() == 1) ++result_.open_edges;
    if (sides.size() == 2 && sides[0].from_high == sides[1].from_high) ++result_.misoriented_edges;
    if (sides.size() > 2) ++result_.nonmanifold_edges;
  }

  // Two triangles that share an edge belong to one fan around each of its ends.
  void join_corners(const Side& a, const Side& b) {
    const auto corner_at = [](const Side& side, bool high) {
      return side.from_high == high ? side.corner : next_corner(side.corner);
    };
    corners_.unite(corner_at(a, true), corner_at(b, true));
    corners_.unite(corner_at(a, false), corner_at(b, false));
  }

  // Counts the fans around every vertex, up to two. Each corner that is still a root stands for one fan. A non-manifold
  // edge joins nothing, so three fans or more end at it. A fan has two ends, so each vertex of such an edge has more
  // than one.
  std::vector<std::uint8_t> find_fans() {
    std::vector<std::uint8_t> fans(mesh_.vertices.size(), 0);
    for_each_side(mesh_, [&](std::uint64_t corner, std::uint32_t vertex, std::uint32_t) {
      if (corners_.root(corner) == corner && fans[vertex] < 2) ++fans[vertex];
    });
    return fans;
  }

  void count_fans() {
    const std::vector<std::uint8_t> fans = find_fans();
    for (std::size_t v = 0; v < fans.size(); ++v) {
      if (fans[v] > 0) ++vertices_;
      if (fans[v] > 1 && counts(v)) ++result_.nonmanifold_vertices;
    }
  }

  const TriangleMesh& mesh_;
  const std::vector<std::uint8_t>* among_;
  DisjointSets<std::uint64_t> corners_;
  AroundCheck result_;
  std::uint64_t vertices_ = 0;
};

class Checker {
 public:
  explicit Checker(const TriangleMesh& mesh) : mesh_(mesh) {}

  MeshCheck run() {
    result_.triangles = mesh_.triangles.size();
    count_degenerate();
    count_meetings();
    count_components();
    measure_surface();
    return result_;
  }

 private:
  void count_degenerate() {
    for (const Triangle& t : mesh_.triangles) {
      const Point& a = mesh_.vertices[t[0]];
      const Point& b = mesh_.vertices[t[1]];
      const Point& c = mesh_.vertices[t[2]];
      if (is_degenerate(t)) {
        ++result_.degenerate_triangles;
      } else if (a == b || b == c || c == a) {
        ++result_.coincident_triangles;
      }
    }
  }

  void count_meetings() {
    Meetings meetings(mesh_, nullptr);
    const AroundCheck all = meetings.count();
    result_.vertices = meetings.vertices();
    result_.unused_vertices = mesh_.vertices.size() - meetings.vertices();
    result_.open_edges = all.open_edges;
    result_.nonmanifold_edges = all.nonmanifold_edges;
    result_.misoriented_edges = all.misoriented_edges;
    result_.nonmanifold_vertices = all.nonmanifold_vertices;
    result_.euler = static_cast<std::int64_t>(result_.vertices) - static_cast<std::int64_t>(all.edges) +
                    static_cast<std::int64_t>(result_.triangles - result_.degenerate_triangles);
  }

  void count_components() {
    DisjointSets<std::uint32_t> sets(mesh_.vertices.size());
    std::vector<std::uint8_t> used(mesh_.vertices.size(), 0);
    for_each_side(mesh_, [&](std::uint64_t, std::uint32_t from, std::uint32_t to) {
      sets.unite(from, to);
      used[from] = 1;
    });
    for (std::uint32_t v = 0; v < used.size(); ++v) {
      if (used[v] != 0 && sets.root(v) == v) ++result_.components;
    }
  }

  // Sums the volumes of tetrahedra over a point of the mesh. Over the origin, a mesh far from it would lose digits.
  void measure_surface() {
    if (mesh_.triangles.empty()) return;
    const measure::Vector apex = measure::corners_of(mesh_, 0)[0];
    double six_volumes = 0;
    measure::AngleSurvey angles;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const measure::TriangleCorners c = measure::corners_of(mesh_, t);
      const double area = measure::area_of(c);
      result_.area += area;
      if (area == 0) ++result_.zero_area_triangles;
      six_volumes += measure::dot(c[0] - apex, measure::cross(c[1] - apex, c[2] - apex));
      const Triangle& v = mesh_.triangles[t];
      if (!is_degenerate(v)) angles.add(c);
      result_.digest += triangle_digest(mesh_.vertices[v[0]], mesh_.vertices[v[1]], mesh_.vertices[v[2]], mesh_.offset);
    }
    result_.volume = six_volumes / 6;
    result_.angles = angles.result();
  }

  const TriangleMesh& mesh_;
  MeshCheck result_;
};

}  // namespace

MeshCheck check_mesh(const TriangleMesh& mesh) {
  const StandardFloats floats;
  measure::require_indices_in_range(mesh);
  return Checker(mesh).run();
}

AroundCheck check_around(const TriangleMesh& mesh, const std::vector<std::uint8_t>& among) {
  return Meetings(mesh, &among).count();
}

}  // namespace isoweave
