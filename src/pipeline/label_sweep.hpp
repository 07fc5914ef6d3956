// The sweep over one label of a label map, in step with those over the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "isoweave/pipeline.hpp"
#include "output/world.hpp"
#include "pipeline/host_slabs.hpp"
#include "pipeline/surface_field.hpp"
#include "volume/slice_window.hpp"

namespace isoweave {

// Adds the report of another map of the same volume, a layer that lies on the first one.
void add_layer(LabelsReport& report, LabelsReport&& layer);

// The mask of a label in a box of the map, read from the slices that a window holds.
class LabelBox final : public SliceSource {
 public:
  LabelBox(const SliceWindow& map, const Region& box, Label label);

  const VolumeInfo& info() const override { return info_; }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override;

  std::int64_t first_slice() const { return box_.first[2]; }

 private:
  const SliceWindow& map_;
  Region box_;
  Label label_;
  VolumeInfo info_;
};

// The box in which the surface around all samples of `box` can be found: extraction and smoothing see beside it what
// they would see in the whole volume.
Region box_to_sweep(const Region& box, const VolumeInfo& volume, const MeshOptions& options);

// Slices of the map below those that sweep_below() takes for new ones, which it may still read.
std::int64_t slices_kept(const MeshOptions& options);

class LabelSweep {
 public:
  // All but the label must stay.
  LabelSweep(const SliceWindow& map, const Region& box, const LabelSink& label, const MeshOptions& options,
             const RunControl& control, const Executor& executor);

  // Sweeps the layers that slices of the map below `end` are enough for. The window holds those since the last call,
  // and slices_kept() before them.
  void sweep_below(std::int64_t end);

  bool is_done() const { return engine_.layers_left() == 0; }
  const SlabRecord& record() const { return record_; }  // of the last slab
  const MeshReport& report() const { return report_; }  // so far

  // The report, once the sweep is done and the sink has everything.
  MeshReport finish();

 private:
  void sweep_slab(std::int64_t layers);

  const MeshOptions& options_;
  const std::uint64_t most_vertices_;  // of a slab
  const Executor executor_;
  LabelBox box_;
  SurfaceField field_;
  World world_;
  MeshSink* sink_;
  HostSlabs engine_;
  SliceWindow window_;
  SlabRecord record_;
  MeshReport report_;
};

}  // namespace isoweave
