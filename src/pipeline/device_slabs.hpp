// Slabs on a device: what is final comes back, the rest stays there.
#pragma once

#include <memory>

#include "device/device_engine.hpp"
#include "output/surface_output.hpp"
#include "pipeline/slab_engine.hpp"

namespace isoweave {

class DeviceSlabs final : public SlabEngine {
 public:
  DeviceSlabs(std::unique_ptr<DeviceEngine> engine, bool normals, const World& world, MeshSink& sink,
              const Executor& executor, bool measure)
      : engine_(std::move(engine)), normals_(normals), output_(world, sink, executor, measure) {}

  std::int64_t layers_left() const override { return engine_->layers_left(); }
  std::pair<std::int64_t, std::int64_t> slices_for(std::int64_t layers) const override {
    return engine_->slices_for(layers);
  }
  std::uint64_t room_for_vertices(std::uint64_t cap) const override { return engine_->room_for_vertices(cap); }
  std::int64_t most_layers() const override { return engine_->most_layers(); }
  std::int64_t extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                       MeshReport& report) override;
  bool takes_slices_early() const override { return true; }
  void take_slices(const SliceWindow& window, std::int64_t layers) override { engine_->upload(window, layers); }
  void simplify(SlabRecord& record) override;
  void write(SlabRecord& record, MeshReport& report) override;
  std::uint64_t held_triangles() const override { return 0; }
  void wait_for_sink() override { output_.wait(); }
  void finish(MeshReport& report) const override;

  // Throw std::logic_error: what a device holds is not saved.
  void exchange(StateWriter& state) override;
  void exchange(StateReader& state) override;

 private:
  std::unique_ptr<DeviceEngine> engine_;
  bool normals_;
  SurfaceOutput output_;
  FinalPiece piece_;
};

}  // namespace isoweave
