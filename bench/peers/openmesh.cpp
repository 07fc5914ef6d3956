#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <stdexcept>

#include "task.hpp"

namespace bench {
namespace {

using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;

class OpenMeshTask : public Task {
 public:
  OpenMeshTask(const isoweave::TriangleMesh& full, const Goal& goal) : goal_(goal) {
    for (const auto& [x, y, z] : full.vertices) mesh_.add_vertex(Mesh::Point(x, y, z));
    for (const auto& [a, b, c] : full.triangles) {
      const auto vertex = [](std::uint32_t v) { return Mesh::VertexHandle(static_cast<int>(v)); };
      if (!mesh_.add_face(vertex(a), vertex(b), vertex(c)).is_valid()) {
        throw std::runtime_error("OpenMesh does not take the mesh: not manifold");
      }
    }
  }
  void run() override {
    OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh_);
    OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
    decimater.add(quadric);
    decimater.module(quadric).unset_max_err();
    decimater.initialize();
    decimater.decimate_to_faces(0, goal_.triangles);
    mesh_.garbage_collection();
  }
  std::size_t triangles() const override { return mesh_.n_faces(); }
  isoweave::TriangleMesh mesh() const override;

 private:
  Mesh mesh_;
  Goal goal_;
};

isoweave::TriangleMesh OpenMeshTask::mesh() const {
  isoweave::TriangleMesh result;
  for (const Mesh::VertexHandle v : mesh_.vertices()) {
    const Mesh::Point& point = mesh_.point(v);
    result.vertices.push_back({point[0], point[1], point[2]});
  }
  for (const Mesh::FaceHandle face : mesh_.faces()) {
    std::array<std::uint32_t, 3> corners{};
    std::size_t corner = 0;
    for (auto v = mesh_.cfv_iter(face); v.is_valid(); ++v) corners[corner++] = static_cast<std::uint32_t>(v->idx());
    result.triangles.push_back(corners);
  }
  return result;
}

}  // namespace

void add_openmesh(Contestants& contestants) {
  contestants.simplifiers.push_back({"OpenMesh", false, [](const isoweave::TriangleMesh& full, const Goal& goal) {
                                       return std::make_unique<OpenMeshTask>(full, goal);
                                     }});
}

}  // namespace bench
