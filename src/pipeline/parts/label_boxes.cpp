#include "pipeline/parts/label_boxes.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "pipeline/labels_sweep.hpp"

namespace isoweave {
namespace {

void widen(Region& box, const Region& other) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.first[axis] = std::min(box.first[axis], other.first[axis]);
    box.end[axis] = std::max(box.end[axis], other.end[axis]);
  }
}

}  // namespace

std::optional<std::array<std::int64_t, 3>> place_of(const Region& box, std::int64_t size) {
  std::array<std::int64_t, 3> place{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t first = box.first[axis];
    place[axis] = first - first % size;
    if (box.end[axis] <= place[axis] + size) continue;
    place[axis] += size / 2;
    if (first < place[axis] || box.end[axis] > place[axis] + size) return std::nullopt;
  }
  return place;
}

GroupedLabels group_labels(std::span<const Region> boxes, std::int64_t size) {
  using Place = std::array<std::int64_t, 3>;
  std::map<Place, LabelGroup> groups;
  GroupedLabels grouped;
  for (std::size_t n = 0; n < boxes.size(); ++n) {
    if (is_empty(boxes[n])) continue;
    const std::optional<Place> place = place_of(boxes[n], size);
    if (!place) {
      grouped.large.push_back(n);
      continue;
    }
    LabelGroup& group = groups[{(*place)[2], (*place)[1], (*place)[0]}];
    group.labels.empty() ? void(group.box = boxes[n]) : widen(group.box, boxes[n]);
    group.labels.push_back(n);
  }
  for (auto& [place, group] : groups) grouped.groups.push_back(std::move(group));
  return grouped;
}

}  // namespace isoweave
