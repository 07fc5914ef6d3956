// Extraction and simplification on a device: samples go there, final triangles come back, and the zone stays there.
#pragma once

#include <utility>

#include "device/device_engine.hpp"
#include "extract/extractor.hpp"
#include "output/final_output.hpp"
#include "pipeline/back_end.hpp"

namespace isoweave {

// The extracted surface stays on the device, so pieces are empty.
class DeviceExtractor final : public Extractor {
 public:
  // The engine must outlive the extractor.
  explicit DeviceExtractor(DeviceEngine& engine) : engine_(engine) {}

  VertexNumbering numbering() const override { return engine_.numbering(); }
  std::int64_t layers_left() const override { return engine_.layers_left(); }
  std::pair<std::int64_t, std::int64_t> slices_for(std::int64_t layers) const override {
    return engine_.slices_for(layers);
  }
  SlabCounts extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                     SurfacePiece& piece) override;
  std::int64_t most_layers() const override { return engine_.most_layers(); }
  std::uint64_t room_for_vertices(std::uint64_t cap) const override { return engine_.room_for_vertices(cap); }
  bool takes_slices_early() const override { return true; }
  void take_slices(const SliceWindow& window, std::int64_t layers) override { engine_.upload(window, layers); }

  std::uint64_t inherited() const override { return engine_.inherited(); }
  void serialize(StateWriter& state) const override { engine_.write_extraction(state); }
  void serialize(StateReader& state) override { engine_.read_extraction(state); }

 private:
  DeviceEngine& engine_;
};

class DeviceBackEnd final : public BackEnd {
 public:
  // All arguments but the task must outlive the back end.
  DeviceBackEnd(DeviceEngine& engine, const SimplifyTask& task, const World& world, MeshSink& sink,
                const Executor& executor, bool measure)
      : engine_(engine), task_(task), output_(world, sink, executor, measure) {}

  void simplify(const SurfacePiece& piece, bool complete, SlabRecord& record) override;
  void write(const SurfacePiece& piece, SlabRecord& record, MeshReport& report) override;
  Held held() const override { return {}; }
  void wait_for_sinks() override { output_.wait(); }
  void finish(MeshReport& report) const override;

  std::uint64_t inherited() const override { return engine_.front_size(); }
  void serialize(StateWriter& state) const override;
  void serialize(StateReader& state) override;

 private:
  DeviceEngine& engine_;
  const SimplifyTask task_;
  FinalOutput output_;
};

}  // namespace isoweave
