// mesh --labels: a mesh for each label, each in a file of its own, or all in one file or folder.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "isoweave/pipeline.hpp"
#include "options/input_volume.hpp"
#include "options/output_mesh.hpp"
#include "options/run.hpp"
#include "report/evidence.hpp"
#include "report/report.hpp"
#include "verbs/mesh_label_choice.hpp"

namespace isoweave::cli {

struct LabelsTask {
  const InputOptions& input;
  const OutputOptions& output;
  const RunOptions& run;
  const MeshOptions& options;
  LabelChoice choice;
  // Samples along each side of the boxes in which labels are meshed; none: one sweep.
  std::optional<std::int64_t> blocks;
  std::string names;              // a file of names, or none
  std::uint64_t min_samples = 0;  // labels of fewer are left out, where all are asked for
  bool numbered = false;          // --segment is given: else a label is the number of its object
  // Gives the options of a label's file, and the task for the report.
  std::function<MeshFileOptions(const LabelName& label)> file;
  std::function<void(Json& report)> describe;
};

// Finds the labels in a first pass over the volume, and meshes them in a second one. A segmentation takes both passes
// for each of its layers.
void mesh_label_files(const LabelsTask& task, const VolumeInfo& info, RunControl control, Evidence& evidence);

}  // namespace isoweave::cli
