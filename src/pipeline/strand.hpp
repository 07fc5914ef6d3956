// A strand: the loop over one of several surfaces that come out of one sweep, in step with the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "extract/make_extractor.hpp"
#include "isoweave/pipeline.hpp"
#include "output/world.hpp"
#include "pipeline/host_back_end.hpp"
#include "pipeline/loop.hpp"
#include "pipeline/surface_field.hpp"
#include "volume/slice_window.hpp"

namespace isoweave {

// The slices that a strand makes its surface of.
struct StrandSource {
  std::unique_ptr<SliceSource> slices;     // read from the window of the sweep
  std::int64_t first_slice = 0;            // of the volume
  std::optional<PartOfLattice> part_of{};  // where the slices are a part of the volume's
  const SliceWindow* window = nullptr;     // that has the same slices; null: none has
};

// The number of slices of the volume below the new ones that a strand with a window of its own may still read.
std::int64_t slices_kept(const SurfaceOptions& options);

// The pieces of the surface of a strand: as many layers at a time as there are slices for.
class StrandPieces final : public PieceSource {
 public:
  // All arguments must outlive this source. shared: a window that has the slices of the field; null: this source has
  // one of its own. slab: the most layers of a piece; 0: any number.
  StrandPieces(SurfaceField& field, Extractor& extractor, const SliceWindow* shared, std::int64_t slab,
               bool simplifies);

  // Slices of the strand below this one can be read.
  void set_end(std::int64_t end) { end_ = end; }

  // The number of layers that can be taken now.
  std::int64_t layers_ready() const;

  bool complete() const override { return extractor_.layers_left() == 0; }
  void read(const Held& held, MeshReport& report) override;
  void make(SurfacePiece& piece, MeshReport& report) override;
  std::uint64_t bytes() const override { return own_ ? own_->bytes() : 0; }

 private:
  SurfaceField& field_;
  Extractor& extractor_;
  const SliceWindow* const shared_;
  const std::int64_t slab_;
  const bool simplifies_;
  std::optional<SliceWindow> own_;
  std::int64_t end_ = 0;
  std::int64_t layers_ = 0;  // of the next piece
  std::uint64_t most_vertices_ = 0;
};

class Strand {
 public:
  // All arguments but the source must outlive the strand. The executor may be a temporary.
  Strand(StrandSource source, MeshSink& sink, const Task& task, const RunControl& control, const Executor& executor);

  // Sweeps the layers for which the slices of the volume below `end` are enough. The window of the sweep holds the
  // slices since the last call and, before them, slices_kept(), or those from first_needed() on where it is shared.
  void sweep_below(std::int64_t end);

  // The first slice of a shared window that the next layer needs.
  std::int64_t first_needed() const { return extractor_->slices_for(1).first; }

  bool is_done() const { return loop_.complete(); }
  const SlabRecord& record() const { return record_; }  // of the last slab
  const MeshReport& report() const { return report_; }  // so far

  // The report, once the strand is done and the sink has everything.
  MeshReport finish();

 private:
  const Executor executor_;
  StrandSource source_;
  SurfaceField field_;
  World world_;
  MeshSink* sink_;
  std::unique_ptr<Extractor> extractor_;
  HostBackEnd back_end_;
  StrandPieces pieces_;
  Loop loop_;
  SlabRecord record_;
  MeshReport report_;
};

}  // namespace isoweave
