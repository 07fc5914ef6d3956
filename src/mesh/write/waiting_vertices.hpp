// The vertices of a mesh that waits in a file, by their numbers. Most of those that follow one another in triangles are
// near in the file, so some blocks of the file are kept in memory.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "files/atomic_file.hpp"
#include "isoweave/mesh.hpp"

namespace isoweave {

class WaitingVertices {
 public:
  // file: of `count` positions. It must outlive this.
  WaitingVertices(OutputDescriptor& file, std::uint64_t count) : file_(file), count_(count), blocks_(kBlocks) {}

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

  OutputDescriptor& file_;
  std::uint64_t count_;
  std::vector<Block> blocks_;  // that of a number is where its remainder says
};

}  // namespace isoweave
