#include "mesh/write/whole_mesh_sink.hpp"

#include <cmath>
#include <sstream>

#include "mesh/write/glb_scene.hpp"
#include "mesh/write/mesh_format.hpp"

namespace isoweave {
namespace {

constexpr double kSteps = 65535;

}  // namespace

WholeMeshSink::WholeMeshSink(const MeshTarget& target, const MeshFileOptions& options, std::uint64_t most_triangles)
    : MeshFileSink(target, options),
      most_triangles_(most_triangles),
      positions_(open_side("positions.part")),
      faces_(open_side("faces.part")) {
  if (options.normals) normals_ = &open_side("normals.part");
}

void WholeMeshSink::write_piece(const MeshPiece& piece) {
  check_count_fits(path(), "vertices", this->vertices(), piece.vertices.size());
  check_count_fits(path(), "triangles", this->triangles(), piece.triangles.size(), most_triangles_);
  narrow_.clear();
  for (const Triangle64& t : piece.triangles) {
    narrow_.push_back(
        {static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]), static_cast<std::uint32_t>(t[2])});
  }
  positions_.write(std::as_bytes(piece.vertices));
  faces_.write(std::as_bytes(std::span(narrow_)));
  if (normals_ != nullptr) normals_->write(std::as_bytes(piece.normals));
}

void WholeMeshSink::complete() {
  narrow_ = {};
  TriangleMesh mesh;
  mesh.vertices = read_all<Point>(positions_, vertices());
  mesh.triangles = read_all<std::array<std::uint32_t, 3>>(faces_, triangles());
  if (normals_ != nullptr) mesh.normals = read_all<Point>(*normals_, vertices());
  write_mesh(std::move(mesh));
}

Grid16 Grid16::around(std::span<const Point> points) {
  Grid16 grid;
  if (points.empty()) return grid;
  Bounds bounds;
  bounds.add(points);
  double longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.origin[axis] = bounds.low[axis];
    longest = std::max(longest, double{bounds.high[axis]} - double{bounds.low[axis]});
  }
  if (longest > 0) grid.step = longest / kSteps;
  return grid;
}

std::array<std::uint16_t, 3> Grid16::place(const Point& point) const {
  std::array<std::uint16_t, 3> steps{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = std::round((double{point[axis]} - origin[axis]) / step);
    steps[axis] = static_cast<std::uint16_t>(std::clamp(at, 0.0, kSteps));
  }
  return steps;
}

// With some room for the 32 bits that the box has in files, and the digits in which this is told.
double Grid16::error() const { return 1.02 * std::sqrt(3.0) / 2 * step; }

std::string rounding_note(const std::string& path, const Grid16& grid, const std::string& unit) {
  std::ostringstream text;
  text.precision(3);
  text << path << ": positions were rounded to 1/65535 of the longest side, by at most " << grid.error();
  if (!unit.empty()) text << ' ' << unit;
  return text.str();
}

}  // namespace isoweave
