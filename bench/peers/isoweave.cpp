// Ours, through the public headers only.
#include <algorithm>
#include <functional>
#include <memory>
#include <span>

#include "isoweave/pipeline.hpp"
#include "task.hpp"

namespace bench {
namespace {

using isoweave::Quality;

// Errors, in mean voxels, between which every count of interest lies.
constexpr Steering kErrors{1e-3, 50};

std::array<std::uint32_t, 3> narrow(const std::array<std::uint64_t, 3>& triangle) {
  return {static_cast<std::uint32_t>(triangle[0]), static_cast<std::uint32_t>(triangle[1]),
          static_cast<std::uint32_t>(triangle[2])};
}

// A part of the mesh in memory that nobody has cleared: peers do not clear theirs either.
template <class T>
class HeldArray {
 public:
  template <class From, class Change>
  HeldArray(std::span<const From> from, const Change& change)
      : elements_(std::make_unique_for_overwrite<T[]>(from.size())), size_(from.size()) {
    std::transform(from.begin(), from.end(), elements_.get(), change);
  }
  std::span<const T> span() const { return {elements_.get(), size_}; }

 private:
  std::unique_ptr<T[]> elements_;
  std::size_t size_;
};

// Holds the whole mesh in memory, as all peers do, in the pieces in which it comes.
class HoldingSink : public isoweave::MeshSink {
 public:
  void append(const isoweave::MeshPiece& piece) override {
    pieces_.push_back({{piece.vertices, std::identity()}, {piece.triangles, narrow}});
    triangles_ += piece.triangles.size();
  }
  void finish() override {}
  std::size_t triangles() const { return triangles_; }
  isoweave::TriangleMesh mesh() const {
    isoweave::TriangleMesh whole;
    for (const Piece& piece : pieces_) {
      const auto vertices = piece.vertices.span();
      const auto triangles = piece.triangles.span();
      whole.vertices.insert(whole.vertices.end(), vertices.begin(), vertices.end());
      whole.triangles.insert(whole.triangles.end(), triangles.begin(), triangles.end());
    }
    return whole;
  }

 private:
  struct Piece {
    HeldArray<isoweave::Point> vertices;
    HeldArray<std::array<std::uint32_t, 3>> triangles;
  };

  std::vector<Piece> pieces_;
  std::size_t triangles_ = 0;
};

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
    mesh_volume(*source, sink_, mesh_options(volume_.iso, 0, Quality::kNormal), on(threads_));
  }
  std::size_t triangles() const override { return sink_.triangles(); }
  isoweave::TriangleMesh mesh() const override { return sink_.mesh(); }

 private:
  const HeldVolume& volume_;
  int threads_;
  HoldingSink sink_;
};

class Simplification : public Task {
 public:
  Simplification(const isoweave::TriangleMesh& full, const Goal& goal, Quality quality)
      : full_(full), goal_(goal), quality_(quality) {}
  void run() override {
    simplify_mesh(full_, sink_, {.error = {goal_.length, false}, .quality = quality_}, on(goal_.threads));
  }
  std::size_t triangles() const override { return sink_.triangles(); }
  isoweave::TriangleMesh mesh() const override { return sink_.mesh(); }

 private:
  const isoweave::TriangleMesh& full_;
  Goal goal_;
  Quality quality_;
  HoldingSink sink_;
};

class Job : public Task {
 public:
  Job(const VolumeFile& file, const Goal& goal, Quality quality) : file_(file), goal_(goal), quality_(quality) {}
  void run() override {
    mesh_volume(*open_source(file_), sink_, mesh_options(file_.iso, goal_.length, quality_), on(goal_.threads));
  }
  std::size_t triangles() const override { return sink_.triangles(); }
  isoweave::TriangleMesh mesh() const override { return sink_.mesh(); }

 private:
  const VolumeFile& file_;
  Goal goal_;
  Quality quality_;
  HoldingSink sink_;
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
