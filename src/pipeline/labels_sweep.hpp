// A sweep over a label map, or over a box of it: each slice is read once and handed to every label whose box holds a
// part of it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "isoweave/pipeline.hpp"
#include "pipeline/strands.hpp"
#include "volume/labels.hpp"

namespace isoweave {

// The options for the mask of a label, which has the values 0 and 1 whatever the iso-value of the volume was to be.
MeshOptions mask_options(const MeshOptions& options);

// Resolves the meshes of labels of a map. Throws what mesh_labels throws for its options and its volume.
Task resolve_labels(SliceSource& map, const std::array<double, 3>& offset, const MeshOptions& options,
                    const RunControl& control);

// Whether float32 may have rounded a label; a warning of it where some may be, and the map has such samples.
bool may_be_rounded(Label label);
void warn_of_floats(const VolumeInfo& map, bool may_be_rounded, MeshReport& report);

// The box in which the surface around all samples of `box` lies. At its border, extraction and smoothing see the same
// samples as in the whole volume.
Region box_to_sweep(const Region& box, const VolumeInfo& volume, const SurfaceOptions& options);

// Throws std::invalid_argument for a box of a label that is not within the map.
void check_box(const VolumeInfo& map, Label label, const Region& box);

bool is_empty(const Region& box);

// Warns of a mesh without triangles.
void warn_of_empty_label(const VolumeInfo& map, Label label, MeshReport& report);

class LabelsSweep final : public StrandGuide {
 public:
  // part: the map, or the box of it that begins at `first` and holds all boxes to be swept of the labels. task: of the
  // whole map. All arguments must outlive the sweep.
  LabelsSweep(SliceSource& part, const std::array<std::int64_t, 3>& first, const Task& task,
              std::span<const LabelSink> labels, const RunControl& control);

  // The reports, in the order of the labels. No sink is finished.
  LabelsReport run();

  std::unique_ptr<Strand> begin(std::size_t n, const SliceWindow& window, const Executor& executor) const override;
  NextSlices next(std::int64_t done) const override;

 private:
  Region in_part(Region box) const;
  void make_strands();
  std::int64_t next_layers(std::int64_t done) const;
  void finish_labels();

  LabelNumbers numbers_;
  const std::array<std::int64_t, 3> first_;
  const Task& task_;
  const VolumeInfo& volume_;  // the whole map
  const RunControl& control_;
  const std::span<const LabelSink> labels_;
  std::vector<Region> boxes_;  // that are swept; empty: the label does not occur
  LabelsReport report_;
  StrandsSweep sweep_;
};

}  // namespace isoweave
