// Brings a mesh into the unit, the space and the offset of another one.
#include <stdexcept>

#include "files/length_units.hpp"
#include "mesh/write/mesh_file_sink.hpp"

namespace isoweave {
namespace {

void scale(TriangleMesh& mesh, double factor) {
  for (Point& vertex : mesh.vertices) {
    for (float& coordinate : vertex) coordinate = static_cast<float>(double{coordinate} * factor);
  }
  for (double& coordinate : mesh.offset) coordinate *= factor;
}

// From LPS to RAS and back: half a turn about z.
void turn(TriangleMesh& mesh) {
  for (std::vector<Point>* points : {&mesh.vertices, &mesh.normals}) {
    for (Point& point : *points) point = {-point[0], -point[1], point[2]};
  }
  mesh.offset = {-mesh.offset[0], -mesh.offset[1], mesh.offset[2]};
}

bool is_known_once(const std::string& a, const std::string& b) { return a.empty() != b.empty(); }

std::string assumed_note(const char* what, const std::string& a, const std::string& b) {
  return std::string("only one of the meshes says its ") + what + ", " + (a.empty() ? b : a) +
         ": that of the other one is taken for the same";
}

}  // namespace

void move_to_offset(TriangleMesh& mesh, const std::array<double, 3>& offset) {
  if (mesh.offset == offset) return;
  for (Point& vertex : mesh.vertices) {
    const std::array<double, 3> place = placed(vertex, mesh.offset);
    for (std::size_t axis = 0; axis < 3; ++axis) vertex[axis] = static_cast<float>(place[axis] - offset[axis]);
  }
  mesh.offset = offset;
}

std::vector<std::string> match_place(TriangleMesh& mesh, const TriangleMesh& other) {
  std::vector<std::string> notes;
  if (!mesh.space.empty() && !other.space.empty() && (mesh.space == "index") != (other.space == "index")) {
    throw std::invalid_argument("expected meshes in one space, found " + other.space + " and " + mesh.space);
  }
  if (is_known_once(mesh.space, other.space)) notes.push_back(assumed_note("space", mesh.space, other.space));
  if (is_known_once(mesh.unit, other.unit)) notes.push_back(assumed_note("unit", mesh.unit, other.unit));
  if (!mesh.space.empty() && !other.space.empty() && mesh.space != other.space) {
    turn(mesh);
    notes.push_back("turned from " + mesh.space + " to " + other.space);
    mesh.space = other.space;
  }
  if (mesh.unit.empty() || other.unit.empty() || mesh.unit == other.unit) return notes;
  const std::optional<double> factor = unit_in(mesh.unit, other.unit);
  if (!factor)
    throw std::invalid_argument("expected units mm, um, nm, m or in, found " + mesh.unit + " and " + other.unit);
  scale(mesh, *factor);
  notes.push_back("converted from " + mesh.unit + " to " + other.unit);
  mesh.unit = other.unit;
  return notes;
}

}  // namespace isoweave
