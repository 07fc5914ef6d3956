// The fastest pair of libraries that one can have today: flying edges, then meshoptimizer, in slabs or not.
#include "meshoptimizer.hpp"
#include "task.hpp"
#include "vtk_data.hpp"
#include "vtk_jobs.hpp"

namespace bench {
namespace {

// Whoever joins the two libraries pays for the way from the one's arrays to the other's.
class MeshoptimizerJob : public Task {
 public:
  MeshoptimizerJob(const VolumeFile& file, const Goal& goal) : file_(file), goal_(goal) {}
  std::size_t triangles() const override { return result_.indices.size() / 3; }
  isoweave::TriangleMesh mesh() const override { return result_.to_mesh(); }

 protected:
  const VolumeFile& file_;
  Goal goal_;
  FlatMesh result_;
};

class WholeMeshJob : public MeshoptimizerJob {
 public:
  using MeshoptimizerJob::MeshoptimizerJob;
  void run() override {
    isoweave::TriangleMesh full = to_mesh(flying_edges(file_, goal_.threads));
    result_.indices = meshoptimizer_simplify(flat_indices(full), full.vertices, goal_.triangles, 0);
    result_.vertices = std::move(full.vertices);
  }
};

class SlabsJob : public MeshoptimizerJob {
 public:
  using MeshoptimizerJob::MeshoptimizerJob;
  void run() override { result_ = meshoptimizer_simplify_in_slabs(to_mesh(flying_edges(file_, goal_.threads)), goal_); }
};

}  // namespace

void add_vtk_meshoptimizer_job(Contestants& contestants) {
  contestants.jobs.push_back({"VTK flying edges + meshoptimizer", true, [](const VolumeFile& file, const Goal& goal) {
                                return std::make_unique<WholeMeshJob>(file, goal);
                              }});
  contestants.jobs.push_back(
      {"VTK flying edges + meshoptimizer in slabs", true,
       [](const VolumeFile& file, const Goal& goal) { return std::make_unique<SlabsJob>(file, goal); }});
}

}  // namespace bench
