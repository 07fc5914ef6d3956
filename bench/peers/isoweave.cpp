// Ours, through the public headers only.
#include <memory>

#include "isoweave/pipeline.hpp"
#include "task.hpp"

namespace bench {
namespace {

using isoweave::Quality;

// Errors, in mean voxels, between which every count of interest lies.
constexpr Steering kErrors{1e-3, 50};

// Open, as the peers make no caps, and without origin and direction, which the peers do not apply.
isoweave::MeshOptions mesh_options(double iso, double error, Quality quality) {
  return {
      .iso = iso, .closed = false, .error = {error, false}, .quality = quality, .space = isoweave::OutputSpace::kIndex};
}

isoweave::RunControl on(int threads) {
  isoweave::RunControl control;
  control.threads = threads;
  control.measure = false;  // nor do the peers
  return control;
}

class Extraction : public Task {
 public:
  Extraction(const HeldVolume& volume, const Goal& goal) : volume_(volume), threads_(goal.threads) {}
  void run() override {
    const std::unique_ptr<isoweave::SliceSource> source = volume_in_memory(volume_.info, volume_.samples);
    mesh_volume(*source, mesh_, mesh_options(volume_.iso, 0, Quality::kNormal), on(threads_));
  }
  std::size_t triangles() const override { return mesh_.triangles().size(); }
  isoweave::TriangleMesh mesh() const override { return mesh_.copy(); }

 private:
  const HeldVolume& volume_;
  int threads_;
  isoweave::MeshInMemory mesh_;
};

class Simplification : public Task {
 public:
  Simplification(const isoweave::TriangleMesh& full, const Goal& goal, Quality quality)
      : full_(full), goal_(goal), quality_(quality) {}
  void run() override {
    simplify_mesh(full_, mesh_, {.error = {goal_.length, false}, .quality = quality_}, on(goal_.threads));
  }
  std::size_t triangles() const override { return mesh_.triangles().size(); }
  isoweave::TriangleMesh mesh() const override { return mesh_.copy(); }

 private:
  const isoweave::TriangleMesh& full_;
  Goal goal_;
  Quality quality_;
  isoweave::MeshInMemory mesh_;
};

class Job : public Task {
 public:
  Job(const VolumeFile& file, const Goal& goal, Quality quality) : file_(file), goal_(goal), quality_(quality) {}
  void run() override {
    mesh_volume(*open_source(file_), mesh_, mesh_options(file_.iso, goal_.length, quality_), on(goal_.threads));
  }
  std::size_t triangles() const override { return mesh_.triangles().size(); }
  isoweave::TriangleMesh mesh() const override { return mesh_.copy(); }

 private:
  const VolumeFile& file_;
  Goal goal_;
  Quality quality_;
  isoweave::MeshInMemory mesh_;
};

void add_quality(Contestants& contestants, const std::string& name, Quality quality) {
  contestants.simplifiers.push_back({name, true,
                                     [quality](const isoweave::TriangleMesh& full, const Goal& goal) {
                                       return std::make_unique<Simplification>(full, goal, quality);
                                     },
                                     kErrors});
  contestants.jobs.push_back(
      {name, true,
       [quality](const VolumeFile& file, const Goal& goal) { return std::make_unique<Job>(file, goal, quality); },
       kErrors});
}

}  // namespace

void add_isoweave(Contestants& contestants) {
  contestants.extractors.push_back({"isoweave", true, [](const HeldVolume& volume, const Goal& goal) {
                                      return std::make_unique<Extraction>(volume, goal);
                                    }});
  add_quality(contestants, "isoweave normal", Quality::kNormal);
  add_quality(contestants, "isoweave fast", Quality::kFast);
  add_quality(contestants, "isoweave fine", Quality::kFine);
}

}  // namespace bench
