// The labels that mesh --labels finds in a label map, in a pass before any is meshed.
#pragma once

#include <atomic>
#include <span>
#include <vector>

#include "verbs/mesh_labels.hpp"

namespace isoweave::cli {

// A label that is meshed.
struct MeshedLabel {
  LabelName name;
  LabelExtent extent;
};

// A map of labels that do not overlap: a layer of a segmentation, or the whole map.
struct LabelLayer {
  InputOptions input;
  std::vector<MeshedLabel> labels;
};

// Whether all labels go into one folder as objects with numbers, as many as there are.
bool is_container(const LabelsTask& task);

// Whether labels are the numbers of their objects in the file.
bool numbers_objects(const LabelsTask& task);

// Refuses labels that cannot be numbers of objects.
void check_numbers(const LabelsTask& task, std::span<const LabelName> labels);

// Finds the labels that are asked for, layer by layer, in a pass over each. chosen: those asked for one by one.
std::vector<LabelLayer> find_layers(const LabelsTask& task, const LabelBook& book, std::span<const LabelName> chosen,
                                    const std::atomic<bool>* stop);

}  // namespace isoweave::cli
