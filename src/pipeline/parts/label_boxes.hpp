// Boxes of a label map that hold whole labels, so that each label is meshed in one of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "isoweave/volume.hpp"

namespace isoweave {

// The box of `size` samples along each axis that holds a box, as its first sample along each axis. It begins at a
// multiple of the size along each axis where that holds it, else half a size further; nothing where neither does.
std::optional<std::array<std::int64_t, 3>> place_of(const Region& box, std::int64_t size);

// Labels that are meshed together, by their numbers in a list, and the box that holds all of their boxes.
struct LabelGroup {
  std::vector<std::size_t> labels;
  Region box;
};

struct GroupedLabels {
  std::vector<LabelGroup> groups;  // by their places: along k, then j, then i
  std::vector<std::size_t> large;  // labels that no box of the size holds
};

// Groups labels by their boxes to be swept; those of an empty box are in no group.
GroupedLabels group_labels(std::span<const Region> boxes, std::int64_t size);

}  // namespace isoweave
