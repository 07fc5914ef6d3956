#include "mesh/read/vtk_mesh.hpp"

#include <cmath>
#include <limits>

namespace isoweave::mesh_io {

namespace {

// VTK's numbers of kinds of cells.
enum CellKind : std::uint64_t {
  kEmpty,
  kVertex,
  kPolyVertex,
  kLine,
  kPolyLine,
  kTriangle,
  kStrip,
  kPolygon,
  kPixel,
  kQuad
};

}  // namespace

// The points so far as doubles.
void VtkMesh::widen() {
  if (is_wide_) return;
  is_wide_ = true;
  for (const Point& point : mesh_.vertices) wide_.push_back({point[0], point[1], point[2]});
  mesh_.vertices = {};
}

void VtkMesh::add_points(VtkNumbers& numbers, std::uint64_t count, bool narrow) {
  before_ += points_;
  points_ = count;
  if (count > kMostVertices - before_) input_.fail("has more than 4294967295 vertices");
  if (count > 0) ++pieces_;
  if (!narrow) widen();
  for (std::uint64_t n = 0; n < count; ++n) {
    WidePoint point{};
    for (double& coordinate : point) {
      coordinate = numbers.real();
      if (std::abs(coordinate) <= double{std::numeric_limits<float>::max()}) continue;
      input_.fail("vertex " + std::to_string(before_ + n) + " has a coordinate that is not a finite number of 32 bits");
    }
    if (is_wide_) {
      wide_.push_back(point);
    } else {
      mesh_.vertices.push_back(
          {static_cast<float>(point[0]), static_cast<float>(point[1]), static_cast<float>(point[2])});
    }
  }
}

void VtkMesh::add_normals(VtkNumbers& numbers) {
  for (std::uint64_t n = 0; n < points_; ++n) {
    Point normal{};
    for (float& coordinate : normal) coordinate = static_cast<float>(numbers.real());
    mesh_.normals.push_back(normal);
  }
}

void VtkMesh::add_values(VtkNumbers& numbers) {
  for (std::uint64_t n = 0; n < points_; ++n) mesh_.values.push_back(static_cast<float>(numbers.real()));
}

std::uint32_t VtkMesh::checked(std::uint64_t corner) const {
  if (corner >= points_) {
    input_.fail("a cell refers to point " + std::to_string(corner) + ", there are " + std::to_string(points_));
  }
  return static_cast<std::uint32_t>(before_ + corner);
}

void VtkMesh::add_polygon(std::span<const std::uint64_t> corners) {
  PolygonFan fan(mesh_.triangles);
  for (const std::uint64_t corner : corners) fan.add(checked(corner));
  polygons_.end(corners.size());
  if (corners.size() < 3) leftovers.left_out(1, kFewCorners);
}

void VtkMesh::add_strip(std::span<const std::uint64_t> corners) {
  std::array<std::uint32_t, 3> last{};
  for (std::size_t n = 0; n < corners.size(); ++n) {
    last = {last[1], last[2], checked(corners[n])};
    // A corner that is repeated joins two strips.
    if (n < 2 || last[0] == last[1] || last[1] == last[2] || last[0] == last[2]) continue;
    // Every other triangle of a strip is turned over.
    mesh_.triangles.push_back(n % 2 == 0 ? last : std::array{last[1], last[0], last[2]});
  }
  if (corners.size() < 3) leftovers.left_out(1, kFewCorners);
}

void VtkMesh::add_cell(std::uint64_t kind, std::span<const std::uint64_t> corners) {
  if (kind == kTriangle || kind == kPolygon || kind == kQuad) {
    add_polygon(corners);
  } else if (kind == kStrip) {
    add_strip(corners);
  } else if (kind == kPixel && corners.size() == 4) {
    add_polygon(std::array{corners[0], corners[1], corners[3], corners[2]});
  } else if (kind <= kPolyLine) {
    leftovers.left_out(1, kind >= kLine ? kLineCells : kPointCells);
  } else {
    input_.fail("expected cells that are triangles or polygons, found type " + std::to_string(kind) +
                " (extract the surface first: vtkDataSetSurfaceFilter, or Extract Surface of ParaView)");
  }
}

TriangleMesh VtkMesh::finish(const MeshPlace& place) {
  const std::uint64_t vertices = before_ + points_;
  if (!mesh_.normals.empty() && mesh_.normals.size() != vertices) {
    mesh_.normals.clear();
    leftovers.not_kept("normals, which some pieces lack");
  }
  if (!mesh_.values.empty() && mesh_.values.size() != vertices) {
    mesh_.values.clear();
    leftovers.not_kept("scalars, which some pieces lack");
  }
  if (pieces_ > 1) {
    mesh_.notes.push_back(std::to_string(pieces_) +
                          " pieces are joined: points where they meet are there more than once");
  }
  leftovers.note(mesh_);
  place.put_into(mesh_);
  if (is_wide_) set_vertices(mesh_, wide_, place.offset());
  check_mesh_numbers(input_, mesh_);
  polygons_.finish();
  return std::move(mesh_);
}

}  // namespace isoweave::mesh_io
