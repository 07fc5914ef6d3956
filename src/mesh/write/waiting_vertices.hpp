// The vertices of a mesh that waits in a file, by their numbers. Most of those that follow one another in triangles are
// near in the file, so some blocks of the file are kept in memory.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "isoweave/mesh.hpp"
#include "mesh/write/packed_object.hpp"

namespace isoweave {

class WaitingVertices {
 public:
  // positions: reads a file of `count` of them. It must outlive this.
  WaitingVertices(const ByteReader& positions, std::uint64_t count)
      : positions_(positions), count_(count), blocks_(kBlocks) {}

  // Throws CannotWrite where the file cannot be read.
  Point at(std::uint64_t vertex);

 private:
  static constexpr std::uint64_t kBlockVertices = 1024;
  static constexpr std::uint64_t kBlocks = 1024;
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};

  struct Block {
    std::uint64_t number = kNone;
    std::vector<Point> points;
  };

  const ByteReader& positions_;
  std::uint64_t count_;
  std::vector<Block> blocks_;  // that of a number is where its remainder says
};

}  // namespace isoweave
