// The fastest pair of libraries that one can have today: flying edges, then meshoptimizer, in slabs or not.
#include "meshoptimizer.hpp"
#include "task.hpp"
#include "vtk_data.hpp"
#include "vtk_jobs.hpp"

namespace bench {
namespace {

class MeshoptimizerJob : public Task {
 public:
  MeshoptimizerJob(const VolumeFile& file, const Goal& goal) : file_(file), goal_(goal) {}
  void run() override {
    isoweave::TriangleMesh full = to_mesh(flying_edges(file_, goal_.threads));
    const std::vector<unsigned> indices = flat_indices(full);
    full.triangles = {};
    indices_ = meshoptimizer_simplify(indices, full.vertices, goal_.triangles, 0);
    vertices_ = std::move(full.vertices);
  }
  std::size_t triangles() const override { return indices_.size() / 3; }
  isoweave::TriangleMesh mesh() const override { return {vertices_, to_triangles(indices_), {}}; }

 private:
  const VolumeFile& file_;
  Goal goal_;
  std::vector<unsigned> indices_;
  std::vector<isoweave::Point> vertices_;
};

}  // namespace

void add_vtk_meshoptimizer_job(Contestants& contestants) {
  contestants.jobs.push_back({"VTK flying edges + meshoptimizer", true, [](const VolumeFile& file, const Goal& goal) {
                                return std::make_unique<MeshoptimizerJob>(file, goal);
                              }});
}

}  // namespace bench
