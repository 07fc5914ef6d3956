// The loop over one label of a label map, in step with the loops over the other labels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "extract/make_extractor.hpp"
#include "isoweave/pipeline.hpp"
#include "output/world.hpp"
#include "pipeline/host_back_end.hpp"
#include "pipeline/loop.hpp"
#include "pipeline/surface_field.hpp"
#include "volume/label_box.hpp"
#include "volume/slice_window.hpp"

namespace isoweave {

// The box in which the surface around all samples of `box` lies. At its border, extraction and smoothing see the same
// samples as in the whole volume.
Region box_to_sweep(const Region& box, const VolumeInfo& volume, const SurfaceOptions& options);

// The number of slices of the map that sweep_below() may still read below the new ones.
std::int64_t slices_kept(const SurfaceOptions& options);

// The pieces of the surface of one label: as many layers at a time as there are slices for.
class LabelPieces final : public PieceSource {
 public:
  // All arguments must outlive this source. slab: the most layers of a piece; 0: any number.
  LabelPieces(SurfaceField& field, Extractor& extractor, std::int64_t slab, bool simplifies);

  // Slices of the label's box below this one can be read.
  void set_end(std::int64_t end) { end_ = end; }

  // The number of layers that can be taken now.
  std::int64_t layers_ready() const;

  bool complete() const override { return extractor_.layers_left() == 0; }
  void read(const Held& held, MeshReport& report) override;
  void make(SurfacePiece& piece, MeshReport& report) override;
  std::uint64_t bytes() const override { return window_.bytes(); }

 private:
  SurfaceField& field_;
  Extractor& extractor_;
  const std::int64_t slab_;
  const std::uint64_t most_vertices_;
  SliceWindow window_;
  std::int64_t end_ = 0;
  std::int64_t layers_ = 0;  // that have been read
};

class LabelSweep {
 public:
  // All arguments but the label must outlive the sweep.
  LabelSweep(const SliceWindow& map, const Region& box, const LabelSink& label, const Task& task,
             const RunControl& control, const Executor& executor);

  // Sweeps the layers for which the slices of the map below `end` are enough. The window holds the slices since the
  // last call, and slices_kept() slices before them.
  void sweep_below(std::int64_t end);

  bool is_done() const { return loop_.complete(); }
  const SlabRecord& record() const { return record_; }  // of the last slab
  const MeshReport& report() const { return report_; }  // so far

  // The report, once the sweep is done and the sink has everything.
  MeshReport finish();

 private:
  const Executor executor_;
  LabelBox box_;
  SurfaceField field_;
  World world_;
  MeshSink* sink_;
  std::unique_ptr<Extractor> extractor_;
  HostBackEnd back_end_;
  LabelPieces pieces_;
  Loop loop_;
  SlabRecord record_;
  MeshReport report_;
};

}  // namespace isoweave
