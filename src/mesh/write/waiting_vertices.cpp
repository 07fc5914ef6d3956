#include "mesh/write/waiting_vertices.hpp"

#include <algorithm>
#include <span>

#include "parallel/size.hpp"

namespace isoweave {

Point WaitingVertices::at(std::uint64_t vertex) {
  const std::uint64_t number = vertex / kBlockVertices;
  Block& block = blocks_[to_size(number % kBlocks)];
  if (block.number != number) {
    const std::uint64_t first = number * kBlockVertices;
    block.points.resize(to_size(std::min(kBlockVertices, count_ - first)));
    block.number = kNone;
    positions_(first * sizeof(Point), std::as_writable_bytes(std::span(block.points)));
    block.number = number;
  }
  return block.points[to_size(vertex % kBlockVertices)];
}

}  // namespace isoweave
