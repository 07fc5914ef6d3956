// Pieces of the surface of a volume: slabs of slices are read and extracted.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "extract/extractor.hpp"
#include "parallel/parallel.hpp"
#include "pipeline/piece_source.hpp"
#include "pipeline/slab_planner.hpp"
#include "pipeline/surface_field.hpp"
#include "pipeline/task.hpp"
#include "volume/samples.hpp"
#include "volume/slice_window.hpp"

namespace isoweave {

class VolumePieces final : public PieceSource {
 public:
  // Continues from the layer where the extractor is. All arguments must outlive this source.
  VolumePieces(const Task& task, SurfaceField& field, Extractor& extractor, SlabPlanner& planner,
               const Executor& executor);

  // Begins to read the field, and the volume of values, from the layer where the extractor is. Must be called once,
  // before the first piece.
  void open();

  bool complete() const override { return extractor_.layers_left() == 0; }
  void read(const Held& held, MeshReport& report) override;
  void make(SurfacePiece& piece, MeshReport& report) override;
  bool reads_early() const override { return extractor_.takes_slices_early(); }
  std::uint64_t bytes() const override;

  // Whether an exception came from reading. The pieces made so far are whole then.
  bool failed_reading() const { return failed_reading_; }

  std::uint64_t voxels() const { return voxels_; }  // of the pieces made so far
  const SampleRange& range() const { return range_; }
  void set_range(const SampleRange& range) { range_ = range; }

  // Counts the samples on caps from now on, where samples are measured. Must be called before the first piece.
  void count_caps() { counts_caps_ = true; }
  std::uint64_t cap_samples() const { return caps_.samples; }

  // Sets the checksum that the next slice must have: an earlier run was cut off there. Another slice is refused with
  // the name of the state. Must be called before open().
  void expect_next_slice(std::uint32_t crc, const std::string& state);

  // The checksum of the first slice that the next slab needs, or nothing if that slice has not been read.
  std::optional<std::uint32_t> crc_of_next_slice() const;

  std::uint64_t inherited() const override { return extractor_.inherited(); }

  // The state between two slabs, with that of extractor and planner: written, and read before the first one. Throws
  // BadInput.
  template <class State>
  void serialize(State& state) {
    extractor_.serialize(state);
    planner_.serialize(state);
    state.value(range_);
    state.value(voxels_);
    state.value(caps_);
  }

 private:
  // The samples on caps in the slices below `end`: a run that is resumed reads some slices again.
  struct CapSamples {
    std::uint64_t samples = 0;
    std::int64_t end = 0;
  };

  void read_slices();
  void measure_samples(std::int64_t slices);
  void measure_caps(std::int64_t slices);
  void check_expected();

  const Task& task_;
  SurfaceField& field_;
  Extractor& extractor_;
  SlabPlanner& planner_;
  const Executor& executor_;
  std::optional<SliceWindow> window_;
  std::optional<SliceWindow> values_window_;
  SlabPlan plan_;  // of the slices that have been read
  struct {
    SampleRange range;
    std::uint64_t voxels = 0;
    CapSamples caps;  // with those of the pieces made so far
  } read_;            // for the next piece
  SampleRange range_;
  std::uint64_t voxels_ = 0;
  CapSamples caps_;
  bool counts_caps_ = false;
  std::optional<std::uint32_t> expected_crc_;
  std::string state_;  // that told it
  bool failed_reading_ = false;
};

}  // namespace isoweave
