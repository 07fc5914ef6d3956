#include "plain_rules/clusters.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace isoweave::plain {
namespace {

using Number = long double;
using Vector = std::array<Number, 3>;

struct Plane {
  Vector normal;
  Number offset;  // normal . x of its points
  Number weight;
};

struct Members {
  std::vector<Plane> planes;
  std::vector<std::pair<Vector, Number>> corners;
};

Number dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector vector_of(const Point& p) { return {p[0], p[1], p[2]}; }

// The solution of three linear equations, by elimination with the largest pivot.
Vector solve(std::array<std::array<Number, 4>, 3> rows) {
  for (std::size_t n = 0; n < 3; ++n) {
    std::size_t pivot = n;
    for (std::size_t r = n + 1; r < 3; ++r) pivot = std::abs(rows[r][n]) > std::abs(rows[pivot][n]) ? r : pivot;
    std::swap(rows[n], rows[pivot]);
    for (std::size_t r = 0; r < 3; ++r) {
      if (r == n) continue;
      const Number factor = rows[r][n] / rows[n][n];
      for (std::size_t c = n; c < 4; ++c) rows[r][c] -= factor * rows[n][c];
    }
  }
  return {rows[0][3] / rows[0][0], rows[1][3] / rows[1][1], rows[2][3] / rows[2][2]};
}

// Least squares: the planes, and the mean of the corners with a thousandth of their weight in each direction.
Vector best_place(const Members& members, const Vector& middle) {
  Number weight = 0;
  Vector mean{};
  for (const auto& [corner, part] : members.corners) {
    weight += part;
    for (std::size_t n = 0; n < 3; ++n) mean[n] += part * corner[n];
  }
  if (weight == 0) return middle;
  for (Number& coordinate : mean) coordinate /= weight;
  std::array<std::array<Number, 4>, 3> rows{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (const Plane& plane : members.planes) {
      for (std::size_t c = 0; c < 3; ++c) rows[r][c] += plane.weight * plane.normal[r] * plane.normal[c];
      rows[r][3] += plane.weight * plane.normal[r] * plane.offset;
    }
    rows[r][r] += weight / 1000;
    rows[r][3] += weight / 1000 * mean[r];
  }
  return solve(rows);
}

Vector place_of(const Members& members, const Cell& cell, const std::array<double, 3>& low, double side) {
  Vector middle{};
  for (std::size_t n = 0; n < 3; ++n) middle[n] = low[n] + static_cast<Number>(cell[n]) * side;
  Vector place = best_place(members, middle);
  const Number most = side * (0.5L - 1.0L / 256);
  for (std::size_t n = 0; n < 3; ++n) place[n] = std::clamp(place[n], middle[n] - most, middle[n] + most);
  return place;
}

void add_triangle(const std::array<Vector, 3>& corners, const std::array<Cell, 3>& cells,
                  std::map<Cell, Members>& members) {
  Vector u, v;
  for (std::size_t n = 0; n < 3; ++n) u[n] = corners[1][n] - corners[0][n], v[n] = corners[2][n] - corners[0][n];
  Vector normal{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const Number length = std::sqrt(dot(normal, normal));
  for (Number& coordinate : normal) coordinate = length > 0 ? coordinate / length : 0;
  for (std::size_t c = 0; c < 3; ++c) {
    members[cells[c]].planes.push_back({normal, dot(normal, corners[0]), length / 6});
    members[cells[c]].corners.emplace_back(corners[c], length / 6);
  }
}

}  // namespace

Cell cell_of(const Point& point, const std::array<double, 3>& low, double side) {
  Cell cell{};
  for (std::size_t n = 0; n < 3; ++n) cell[n] = std::lround((double{point[n]} - low[n]) / side);
  return cell;
}

Clustered cluster(const TriangleMesh& mesh, const std::array<double, 3>& low, double side) {
  Clustered result;
  std::map<Cell, Members> members;
  for (const auto& t : mesh.triangles) {
    std::array<Vector, 3> corners;
    std::array<Cell, 3> cells;
    for (std::size_t c = 0; c < 3; ++c) {
      corners[c] = vector_of(mesh.vertices[t[c]]);
      cells[c] = cell_of(mesh.vertices[t[c]], low, side);
    }
    add_triangle(corners, cells, members);
    if (cells[0] == cells[1] || cells[1] == cells[2] || cells[2] == cells[0]) {
      ++result.collapsed;
      continue;
    }
    std::rotate(cells.begin(), std::min_element(cells.begin(), cells.end()), cells.end());
    if (!result.triangles.insert(cells).second) ++result.repeated;
  }
  result.cells = members.size();
  std::set<Cell> used;
  for (const auto& triangle : result.triangles) used.insert(triangle.begin(), triangle.end());
  Number squares = 0;
  Number weight = 0;
  for (const Cell& cell : used) {
    const Vector place = place_of(members[cell], cell, low, side);
    for (std::size_t n = 0; n < 3; ++n) result.vertices[cell][n] = static_cast<double>(place[n]);
    for (const Plane& plane : members[cell].planes) {
      const Number distance = dot(plane.normal, place) - plane.offset;
      squares += plane.weight * distance * distance;
      weight += plane.weight;
    }
  }
  result.plane_rms = weight > 0 ? static_cast<double>(std::sqrt(squares / weight)) : 0;
  return result;
}

}  // namespace isoweave::plain
