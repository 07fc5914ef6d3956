// mesh --labels --one-file -o NAME.precomputed: all labels of a map as objects of one folder, millions of them as well.
#pragma once

#include "verbs/mesh_labels.hpp"

namespace isoweave::cli {

// As mesh_label_files.
void mesh_label_objects(const LabelsTask& task, const VolumeInfo& info, RunControl control, Evidence& evidence);

}  // namespace isoweave::cli
