// Label maps: a mesh for each label, each in a file of its own.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "evidence.hpp"
#include "isoweave/pipeline.hpp"
#include "label_choice.hpp"
#include "mesh_output.hpp"
#include "options.hpp"
#include "report.hpp"

namespace isoweave::cli {

// Passes of --smooth, 0 where it is not given.
int parse_smooth(std::string_view text);

struct LabelsTask {
  const InputOptions& input;
  const OutputOptions& output;
  const RunOptions& run;
  const MeshOptions& options;
  LabelChoice choice;
  std::string names;      // a file of names, or none
  bool numbered = false;  // --segment is given: else a label is the number of its object
  // Gives the options of a label's file, and the task for the report.
  std::function<MeshFileOptions(const LabelName& label)> file;
  std::function<void(Json& report)> describe;
};

// Finds the labels in a first pass over the volume, and meshes them in a second one. A segmentation takes both passes
// for each of its layers.
void mesh_label_files(const LabelsTask& task, const VolumeInfo& info, RunControl control, Evidence& evidence);

}  // namespace isoweave::cli
