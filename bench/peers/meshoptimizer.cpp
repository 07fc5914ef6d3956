#include "meshoptimizer.hpp"

#include <meshoptimizer.h>

#include <algorithm>

namespace bench {
namespace {

class MeshoptimizerTask : public Task {
 public:
  MeshoptimizerTask(const isoweave::TriangleMesh& full, const Goal& goal) : full_(full), goal_(goal) {}
  std::size_t triangles() const override { return indices_.size() / 3; }
  isoweave::TriangleMesh mesh() const override { return {full_.vertices, to_triangles(indices_), {}}; }

 protected:
  const isoweave::TriangleMesh& full_;
  Goal goal_;
  std::vector<unsigned> indices_;
};

class Quadric : public MeshoptimizerTask {
 public:
  using MeshoptimizerTask::MeshoptimizerTask;
  void run() override { indices_ = meshoptimizer_simplify(flat_indices(full_), full_.vertices, goal_.triangles, 0); }
};

class Sloppy : public MeshoptimizerTask {
 public:
  using MeshoptimizerTask::MeshoptimizerTask;
  void run() override {
    const std::span<const unsigned> indices = flat_indices(full_);
    indices_.resize(indices.size());
    indices_.resize(meshopt_simplifySloppy(indices_.data(), indices.data(), indices.size(), full_.vertices[0].data(),
                                           full_.vertices.size(), sizeof(isoweave::Point), goal_.triangles * 3,
                                           kAnyError, nullptr));
  }
};

}  // namespace

std::vector<unsigned> meshoptimizer_simplify(std::span<const unsigned> indices,
                                             const std::vector<isoweave::Point>& vertices, std::size_t target_triangles,
                                             unsigned options) {
  std::vector<unsigned> left(indices.size());
  if (indices.empty()) return left;
  target_triangles = std::min(target_triangles, indices.size() / 3);  // more is an assertion
  left.resize(meshopt_simplify(left.data(), indices.data(), indices.size(), vertices[0].data(), vertices.size(),
                               sizeof(isoweave::Point), target_triangles * 3, kAnyError, options, nullptr));
  return left;
}

void add_meshoptimizer(Contestants& contestants) {
  contestants.simplifiers.push_back({"meshoptimizer", false, [](const isoweave::TriangleMesh& full, const Goal& goal) {
                                       return std::make_unique<Quadric>(full, goal);
                                     }});
  contestants.simplifiers.push_back(
      {"meshoptimizer sloppy", false,
       [](const isoweave::TriangleMesh& full, const Goal& goal) { return std::make_unique<Sloppy>(full, goal); }});
}

}  // namespace bench
