#include "pipeline/parts/waiting_part.hpp"

#include <algorithm>
#include <utility>

#include "files/state_file.hpp"

namespace isoweave {
namespace {

// Calls visit(label) for the vertices with a receipt of a level, in their order.
template <class Visit>
void for_labels(ZonePart& part, std::size_t level, const Visit& visit) {
  for (Index v = 0; v < part.vertices.size(); ++v) {
    if (level == part.levels.size()) {
      if (part.vertices[v].number != kNotHandedOver) visit(part.vertices[v].id, part.vertices[v].label);
    } else if (part.levels[level][v].number != kNotHandedOver) {
      visit(part.vertices[v].id, part.levels[level][v].label);
    }
  }
}

std::vector<std::uint32_t> labels_by_id(ZonePart& part, std::size_t level) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted;
  for_labels(part, level, [&](std::uint64_t id, std::uint32_t label) { sorted.emplace_back(id, label); });
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::uint32_t> labels;
  labels.reserve(sorted.size());
  for (const auto& [id, label] : sorted) labels.push_back(label);
  return labels;
}

}  // namespace

WaitingPart::WaitingPart(ZonePart part)
    : part_(std::move(part)), vertices_(part_.vertices.size()), triangles_(part_.triangles.size()) {}

WaitingPart::WaitingPart(ZonePart part, PartScratch& file)
    : file_(&file), vertices_(part.vertices.size()), triangles_(part.triangles.size()) {
  for (std::size_t level = 0; level <= part.levels.size(); ++level) labels_.push_back(labels_by_id(part, level));
  StateWriter writer;
  write_part(writer, part);
  place_ = file.put(writer.take());
}

ZonePart WaitingPart::take(const PartShape& shape) {
  if (file_ == nullptr) return std::move(part_);
  StateReader reader(file_->take(place_), "parts that wait in a file", "part of a surface");
  ZonePart part = read_cut_part(reader, shape);
  reader.require_end();
  for (std::size_t level = 0; level < labels_.size(); ++level) {
    auto label = labels_[level].begin();
    for_labels(part, level, [&](std::uint64_t, std::uint32_t& own) { own = *label++; });
  }
  return part;
}

std::uint64_t WaitingPart::bytes() const {
  std::uint64_t bytes = part_.vertices.capacity() * sizeof(Vertex) + part_.triangles.capacity() * sizeof(Triangle) +
                        part_.states.capacity() + part_.normals.capacity() * sizeof(Point) +
                        part_.normal_quadrics.capacity() * sizeof(NormalQuadric) +
                        part_.values.capacity() * sizeof(float);
  for (const Array<LevelVertex>& level : part_.levels) bytes += level.capacity() * sizeof(LevelVertex);
  for (const std::vector<std::uint32_t>& level : labels_) bytes += level.capacity() * sizeof(std::uint32_t);
  return bytes;
}

void WaitingPart::list_labels(std::size_t level, std::vector<std::uint32_t*>& labels) {
  if (file_ == nullptr) {
    for_labels(part_, level, [&](std::uint64_t, std::uint32_t& label) { labels.push_back(&label); });
  } else {
    for (std::uint32_t& label : labels_[level]) labels.push_back(&label);
  }
}

}  // namespace isoweave
