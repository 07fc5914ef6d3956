#include "mesh/read/polygons.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "lattice/vec3.hpp"

namespace isoweave::mesh_io {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

Vec3 position(const TriangleMesh& mesh, std::uint32_t vertex) {
  const Point& p = mesh.vertices[vertex];
  return {p[0], p[1], p[2]};
}

// Twice the area as a vector.
Vec3 area_of(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3 a = position(mesh, t[0]);
  return cross(position(mesh, t[1]) - a, position(mesh, t[2]) - a);
}

// Whether every triangle of a fan faces the same way as the polygon as a whole, but for rounding.
bool lies_flat(const TriangleMesh& mesh, std::span<const Triangle> fan, const Vec3& area) {
  constexpr double kRounding = 1e-6;
  const double least = -kRounding * dot(area, area);
  return std::all_of(fan.begin(), fan.end(), [&](const Triangle& t) { return dot(area_of(mesh, t), area) >= least; });
}

// A corner of a polygon seen along its normal.
struct Corner {
  double x, y;
  std::uint32_t vertex;
};

bool same_place(const Corner& a, const Corner& b) { return a.x == b.x && a.y == b.y; }

// Twice the area of a triangle; above 0 where its corners go round to the left.
double turn(const Corner& a, const Corner& b, const Corner& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The corners of a fan, projected along the axis that is nearest to the normal, and going round to the left.
std::vector<Corner> corners_of(const TriangleMesh& mesh, std::span<const Triangle> fan, const Vec3& normal) {
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  const auto seen = [&](std::uint32_t vertex) -> Corner {
    const Vec3 p = position(mesh, vertex);
    if (x >= y && x >= z) return normal.x > 0 ? Corner{p.y, p.z, vertex} : Corner{p.z, p.y, vertex};
    if (y >= z) return normal.y > 0 ? Corner{p.z, p.x, vertex} : Corner{p.x, p.z, vertex};
    return normal.z > 0 ? Corner{p.x, p.y, vertex} : Corner{p.y, p.x, vertex};
  };
  std::vector<Corner> corners{seen(fan.front()[0]), seen(fan.front()[1])};
  for (const Triangle& t : fan) corners.push_back(seen(t[2]));
  return corners;
}

// Cuts ears off a polygon: triangles over three consecutive corners that have no other corner in them.
class EarCutter {
 public:
  explicit EarCutter(std::vector<Corner> corners) : ring_(std::move(corners)), looks_(kLooks * ring_.size()) {}

  // Fills `triangles`, as many as there are corners less two; false where the polygon crosses itself, or seems to.
  bool cut(std::span<Triangle> triangles) {
    std::size_t at = 0;
    for (Triangle& triangle : triangles) {
      if (!find_ear(at)) return false;
      triangle = {before(at).vertex, ring_[at].vertex, after(at).vertex};
      ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(at));
      if (at == ring_.size()) at = 0;
    }
    return true;
  }

 private:
  // A bound on the time that a polygon takes: for a thousand corners, about as many looks as there are pairs of them.
  static constexpr std::size_t kLooks = 1000;

  const Corner& before(std::size_t at) const { return ring_[at == 0 ? ring_.size() - 1 : at - 1]; }
  const Corner& after(std::size_t at) const { return ring_[at + 1 == ring_.size() ? 0 : at + 1]; }

  // Moves on to the next ear. An ear without area, between corners on a line, is taken where there is no other.
  bool find_ear(std::size_t& at) {
    for (const bool flat : {false, true}) {
      for (std::size_t n = 0; n < ring_.size(); ++n) {
        const double area = turn(before(at), ring_[at], after(at));
        if ((flat ? area == 0 : area > 0) && is_empty(at)) return true;
        at = at + 1 == ring_.size() ? 0 : at + 1;
      }
    }
    return false;
  }

  // Whether no other corner lies in the ear or on its border. Corners at the places of the ear's own corners do not
  // count.
  bool is_empty(std::size_t at) {
    const Corner &a = before(at), &b = ring_[at], &c = after(at);
    if (looks_ < ring_.size()) return false;
    looks_ -= ring_.size();
    return std::none_of(ring_.begin(), ring_.end(), [&](const Corner& p) {
      return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0 && !same_place(p, a) && !same_place(p, b) &&
             !same_place(p, c);
    });
  }

  std::vector<Corner> ring_;
  std::size_t looks_;
};

}  // namespace

void Polygons::end(std::uint64_t corners) {
  if (corners < 4) return;
  const Fan fan{mesh_.triangles.size() - (static_cast<std::size_t>(corners) - 2), static_cast<std::size_t>(corners)};
  if (has_vertices(fan)) {
    cut(fan);
  } else {
    waiting_.push_back(fan);
  }
}

void Polygons::finish() {
  for (const Fan& fan : waiting_) cut(fan);
  waiting_.clear();
  if (crossed_ == 0) return;
  mesh_.notes.push_back(std::to_string(crossed_) + " polygons cross themselves: their triangles overlap");
}

bool Polygons::has_vertices(const Fan& fan) const {
  const auto begin = mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(fan.first);
  return std::all_of(begin, begin + static_cast<std::ptrdiff_t>(fan.corners - 2), [&](const Triangle& t) {
    return std::max({t[0], t[1], t[2]}) < mesh_.vertices.size();
  });
}

void Polygons::cut(const Fan& fan) {
  const std::span<Triangle> triangles = std::span(mesh_.triangles).subspan(fan.first, fan.corners - 2);
  Vec3 area;
  for (const Triangle& t : triangles) area = area + area_of(mesh_, t);
  if (lies_flat(mesh_, triangles, area)) return;
  std::vector<Triangle> ears(triangles.size());
  if (EarCutter(corners_of(mesh_, triangles, area)).cut(ears)) {
    std::copy(ears.begin(), ears.end(), triangles.begin());
  } else {
    ++crossed_;
  }
}

}  // namespace isoweave::mesh_io
