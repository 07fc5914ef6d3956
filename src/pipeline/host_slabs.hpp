// Slabs on processors.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "extract/marching_cubes.hpp"
#include "output/final_output.hpp"
#include "output/full_output.hpp"
#include "pipeline/slab_engine.hpp"
#include "select/component_filter.hpp"
#include "simplify/count_target.hpp"

namespace isoweave {

class HostSlabs final : public SlabEngine {
 public:
  struct Options {
    ExtractOptions extract;
    SimplifierOptions simplify;
    bool simplifies = true;
    std::uint64_t triangles = 0;                  // to stop at; 0: no such number
    double voxel = 1;                             // mean side
    std::string unit;                             // of the volume's lengths; may be empty
    const ComponentChoice* components = nullptr;  // that are kept; null: all
    bool measure = true;
    SweepObserver* observer = nullptr;
  };

  // A sink for each level of options.simplify. stop: set, and simplify() throws Interrupted, if it is not null.
  HostSlabs(const VolumeInfo& volume, const Options& options, const World& world, std::span<MeshSink* const> sinks,
            const Executor& executor, const std::atomic<bool>* stop);

  std::int64_t layers_left() const override { return extractor_.layers_left(); }
  std::pair<std::int64_t, std::int64_t> slices_for(std::int64_t layers) const override {
    return extractor_.slices_for(layers);
  }
  std::int64_t extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                       MeshReport& report) override;
  void take_values(const SliceWindow& window) override;
  void simplify(SlabRecord& record) override;
  void write(SlabRecord& record, MeshReport& report) override;
  std::uint64_t zone_bytes() const override { return zone_bytes_; }
  std::uint64_t held_triangles() const override { return options_.simplifies ? simplifier_.live_triangles() : 0; }
  void view_undecided(const SweepObserver::Visitor& visitor) const override;
  void wait_for_sink() override;
  void finish(MeshReport& report) const override;
  void exchange(StateWriter& state) override { exchange_with(state); }
  void exchange(StateReader& state) override { exchange_with(state); }

 private:
  template <class Archive>
  void exchange_with(Archive& archive) {
    extractor_.exchange(archive);
    if (filter_) filter_->exchange(archive);
    simplifier_.exchange(archive);
    for (const auto& output : outputs_) output->exchange(archive);
    full_output_.exchange(archive);
  }

  const std::string path_;  // of the volume
  Options options_;
  const World& world_;
  const Executor& executor_;
  const Lattice lattice_;
  const std::array<double, 3> spacing_;
  MarchingCubes extractor_;
  std::optional<ComponentFilter> filter_;
  Simplifier simplifier_;
  std::optional<CountTarget> target_;
  std::vector<std::unique_ptr<FinalOutput>> outputs_;  // per level
  FullOutput full_output_;
  SurfacePiece piece_;
  std::uint64_t zone_bytes_ = 0;  // with the last slab
};

// How the surface of a field is extracted and simplified; `volume` is the whole that the options speak of.
HostSlabs::Options host_options(const VolumeInfo& volume, const IsoRule& rule, const MeshOptions& options,
                                const RunControl& control);

}  // namespace isoweave
