// A part that waits for its block: in memory, or in a scratch file.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "pipeline/parts/part_scratch.hpp"
#include "simplify/zone_part.hpp"

namespace isoweave {

class WaitingPart {
 public:
  // Keeps the part in memory.
  explicit WaitingPart(ZonePart part);

  // Keeps the part in a file, which must outlive it. Labels of components stay in memory, as they change. Throws
  // CannotWrite.
  WaitingPart(ZonePart part, PartScratch& file);

  // Takes the part out. shape: what it must be like. Throws BadInput for a file that has changed.
  ZonePart take(const PartShape& shape);

  std::uint64_t vertices() const { return vertices_; }
  std::uint64_t triangles() const { return triangles_; }
  std::uint64_t bytes() const;  // in memory

  // Lists the labels of a level that belong to a receipt: of the last mesh, that is the number of the others.
  void list_labels(std::size_t level, std::vector<std::uint32_t*>& labels);

 private:
  ZonePart part_;                                   // unless it is in a file
  PartScratch* file_ = nullptr;                     // null: in memory
  PartScratch::Place place_;                        // in the file
  std::vector<std::vector<std::uint32_t>> labels_;  // per level, of the vertices with receipts, by ascending ids
  std::uint64_t vertices_ = 0, triangles_ = 0;
};

}  // namespace isoweave
