// Label maps: a mesh for each label, each in a file of its own.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "evidence.hpp"
#include "isoweave/pipeline.hpp"
#include "mesh_output.hpp"
#include "options.hpp"
#include "report.hpp"

namespace isoweave::cli {

// The labels that --labels names; none for all. Throws std::invalid_argument for anything else.
std::vector<std::int64_t> parse_labels(std::string_view text);

// Passes of --smooth, 0 where it is not given.
int parse_smooth(std::string_view text);

// The output of a label: a.ply becomes a_label1.ply.
OutputOptions label_output(const OutputOptions& output, std::int64_t label);

struct LabelsTask {
  const InputOptions& input;
  const OutputOptions& output;
  const RunOptions& run;
  const MeshOptions& options;
  std::vector<std::int64_t> labels;  // none: all
  bool numbered = false;             // --segment is given: else a label is the number of its object
  // What the file of a label is to say, and what the report is to say of the task.
  std::function<MeshFileOptions(std::int64_t label)> file;
  std::function<void(Json& report)> describe;
};

// Finds the labels in a first pass over the volume, and meshes them in a second one.
void mesh_label_files(const LabelsTask& task, SliceSource& volume, RunControl control, Evidence& evidence);

}  // namespace isoweave::cli
