#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <stdexcept>

#include "task.hpp"

namespace bench {
namespace {

namespace sms = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Vertex = Mesh::Vertex_index;

Mesh to_cgal(const isoweave::TriangleMesh& full) {
  Mesh mesh;
  const auto vertices = static_cast<Mesh::size_type>(full.vertices.size());
  const auto triangles = static_cast<Mesh::size_type>(full.triangles.size());
  mesh.reserve(vertices, vertices + triangles, triangles);
  for (const auto& [x, y, z] : full.vertices) mesh.add_vertex({x, y, z});
  for (const auto& [a, b, c] : full.triangles) {
    if (mesh.add_face(Vertex(a), Vertex(b), Vertex(c)) == Mesh::null_face()) {
      throw std::runtime_error("CGAL does not take the mesh: not manifold");
    }
  }
  return mesh;
}

// CGAL's own predicate counts edges, of which a collapse on a border takes two for one triangle.
class TriangleCount {
 public:
  explicit TriangleCount(std::size_t most) : most_(most) {}

  template <class Cost, class Profile>
  bool operator()(const Cost&, const Profile& profile, std::size_t, std::size_t) const {
    return profile.surface_mesh().number_of_faces() <= most_;
  }

 private:
  std::size_t most_;
};

class EdgeCollapse : public Task {
 public:
  EdgeCollapse(const isoweave::TriangleMesh& full, const Goal& goal)
      : mesh_(to_cgal(full)), triangles_(goal.triangles) {}
  std::size_t triangles() const override { return mesh_.number_of_faces(); }
  isoweave::TriangleMesh mesh() const override;

 protected:
  TriangleCount stop() const { return TriangleCount(triangles_); }

  Mesh mesh_;

 private:
  std::size_t triangles_;
};

isoweave::TriangleMesh EdgeCollapse::mesh() const {
  isoweave::TriangleMesh result;
  std::vector<std::uint32_t> number(mesh_.number_of_vertices() + mesh_.number_of_removed_vertices());
  for (const Vertex v : mesh_.vertices()) {
    number[v] = static_cast<std::uint32_t>(result.vertices.size());
    const Kernel::Point_3& point = mesh_.point(v);
    result.vertices.push_back(
        {static_cast<float>(point.x()), static_cast<float>(point.y()), static_cast<float>(point.z())});
  }
  for (const Mesh::Face_index face : mesh_.faces()) {
    std::array<std::uint32_t, 3> corners{};
    std::size_t corner = 0;
    for (const Vertex v : mesh_.vertices_around_face(mesh_.halfedge(face))) corners[corner++] = number[v];
    result.triangles.push_back(corners);
  }
  return result;
}

class GarlandHeckbert : public EdgeCollapse {
 public:
  using EdgeCollapse::EdgeCollapse;
  void run() override {
    const sms::GarlandHeckbert_plane_policies<Mesh, Kernel> policies(mesh_);
    sms::edge_collapse(mesh_, stop(),
                       CGAL::parameters::get_cost(policies.get_cost()).get_placement(policies.get_placement()));
  }
};

class LindstromTurk : public EdgeCollapse {
 public:
  using EdgeCollapse::EdgeCollapse;
  void run() override {
    sms::edge_collapse(mesh_, stop(),
                       CGAL::parameters::get_cost(sms::LindstromTurk_cost<Mesh>())
                           .get_placement(sms::LindstromTurk_placement<Mesh>()));
  }
};

}  // namespace

void add_cgal(Contestants& contestants) {
  contestants.simplifiers.push_back(
      {"CGAL Garland-Heckbert", false, [](const isoweave::TriangleMesh& full, const Goal& goal) {
         return std::make_unique<GarlandHeckbert>(full, goal);
       }});
  contestants.simplifiers.push_back(
      {"CGAL Lindstrom-Turk", false, [](const isoweave::TriangleMesh& full, const Goal& goal) {
         return std::make_unique<LindstromTurk>(full, goal);
       }});
}

}  // namespace bench
