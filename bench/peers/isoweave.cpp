// Ours, through the public headers only.
#include <limits>
#include <memory>
#include <optional>

#include "isoweave/pipeline.hpp"
#include "task.hpp"

namespace bench {
namespace {

using isoweave::Quality;

// Errors, in mean voxels, between which every count of interest lies.
constexpr Steering kErrors{1e-3, 50};

// What stops us: an error, which is sought before, or the number of triangles that a peer gets.
enum class Stop { kError, kTriangles };

template <class Options>
void stop_at(Stop stop, const Goal& goal, Options& options) {
  const bool counts = stop == Stop::kTriangles;
  options.error = isoweave::Length::units(counts ? std::numeric_limits<double>::infinity() : goal.length);
  options.triangles = counts ? goal.triangles : 0;
}

// Open, as the peers make no caps, and without origin and direction, which the peers do not apply.
isoweave::MeshOptions mesh_options(double iso, Quality quality) {
  isoweave::MeshOptions options;
  options.iso = iso;
  options.closed = false;
  options.quality = quality;
  options.space = isoweave::OutputSpace::kIndex;
  return options;
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
    isoweave::MeshOptions options = mesh_options(volume_.iso, Quality::kNormal);
    options.error = isoweave::Length::units(0);
    mesh_volume(*source, mesh_, options, on(threads_));
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
  Simplification(const isoweave::TriangleMesh& full, const Goal& goal, Quality quality, Stop stop)
      : full_(full), goal_(goal), options_{.quality = quality} {
    stop_at(stop, goal, options_);
  }
  void run() override { simplify_mesh(full_, mesh_, options_, on(goal_.threads)); }
  std::size_t triangles() const override { return mesh_.triangles().size(); }
  isoweave::TriangleMesh mesh() const override { return mesh_.copy(); }

 private:
  const isoweave::TriangleMesh& full_;
  Goal goal_;
  isoweave::SimplifyOptions options_;
  isoweave::MeshInMemory mesh_;
};

class Job : public Task {
 public:
  Job(const VolumeFile& file, const Goal& goal, Quality quality, Stop stop)
      : file_(file), goal_(goal), options_(mesh_options(file.iso, quality)) {
    stop_at(stop, goal, options_);
  }
  void run() override {
    isoweave::RunControl control = on(goal_.threads);
    control.reopen = [this] { return open_source(file_); };
    mesh_volume(*open_source(file_), mesh_, options_, control);
  }
  std::size_t triangles() const override { return mesh_.triangles().size(); }
  isoweave::TriangleMesh mesh() const override { return mesh_.copy(); }

 private:
  const VolumeFile& file_;
  Goal goal_;
  isoweave::MeshOptions options_;
  isoweave::MeshInMemory mesh_;
};

void add(Contestants& contestants, const std::string& name, Quality quality, Stop stop = Stop::kError) {
  const std::optional<Steering> steering = stop == Stop::kError ? std::optional(kErrors) : std::nullopt;
  contestants.simplifiers.push_back({name, true,
                                     [=](const isoweave::TriangleMesh& full, const Goal& goal) {
                                       return std::make_unique<Simplification>(full, goal, quality, stop);
                                     },
                                     steering});
  contestants.jobs.push_back(
      {name, true,
       [=](const VolumeFile& file, const Goal& goal) { return std::make_unique<Job>(file, goal, quality, stop); },
       steering});
}

}  // namespace

void add_isoweave(Contestants& contestants) {
  contestants.extractors.push_back({"isoweave", true, [](const HeldVolume& volume, const Goal& goal) {
                                      return std::make_unique<Extraction>(volume, goal);
                                    }});
  add(contestants, "isoweave normal", Quality::kNormal);
  add(contestants, "isoweave normal, to a number", Quality::kNormal, Stop::kTriangles);
  add(contestants, "isoweave fast", Quality::kFast);
  add(contestants, "isoweave fine", Quality::kFine);
}

}  // namespace bench
