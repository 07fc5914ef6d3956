// Slabs that are looked at for their components and forgotten.
#pragma once

#include "extract/marching_cubes.hpp"
#include "pipeline/slab_engine.hpp"
#include "select/component_finder.hpp"

namespace isoweave {

class ComponentSlabs final : public SlabEngine {
 public:
  ComponentSlabs(const VolumeInfo& volume, const IsoRule& rule, ComponentFinder& finder, const Executor& executor)
      : extractor_(volume, {rule, false}, executor), finder_(finder) {}

  std::int64_t layers_left() const override { return extractor_.layers_left(); }
  std::pair<std::int64_t, std::int64_t> slices_for(std::int64_t layers) const override {
    return extractor_.slices_for(layers);
  }
  std::int64_t extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                       MeshReport& report) override;
  void simplify(SlabRecord& record) override;
  void write(SlabRecord&, MeshReport&) override {}
  std::uint64_t held_triangles() const override { return 0; }
  std::uint64_t other_bytes() const override { return finder_.bytes(); }
  void wait_for_sink() override {}
  void finish(MeshReport&) const override {}

  // Throw std::logic_error: this pass is short, and made anew by a run that is resumed.
  void exchange(StateWriter& state) override;
  void exchange(StateReader& state) override;

 private:
  MarchingCubes extractor_;
  ComponentFinder& finder_;
  SurfacePiece piece_;
};

}  // namespace isoweave
