// Sorts the triangles of nodes in bounded memory: sorted runs wait in a file, and are merged. A few are sorted in
// memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "files/waiting_bytes.hpp"
#include "mesh/write/node_grid.hpp"

namespace isoweave {

class TriangleSorter {
 public:
  struct Limits {
    std::size_t at_once = std::size_t{1} << 20;  // triangles that are sorted in memory
    std::size_t ways = 64;                       // runs that are merged at a time
    std::size_t ahead = std::size_t{1} << 12;    // triangles of each run that are read at a time
  };

  // path: the name in messages. Runs wait in a file beside it, which is made where there is more than one.
  explicit TriangleSorter(const std::string& path) : TriangleSorter(path, Limits{}) {}
  TriangleSorter(const std::string& path, const Limits& limits);

  void add(std::span<const NodeTriangle> triangles);

  // Calls take for all triangles, in their order, and forgets them.
  void take_all(const std::function<void(const NodeTriangle&)>& take);

 private:
  struct Run {
    std::uint64_t first = 0;  // byte
    std::uint64_t count = 0;  // triangles
  };
  class Reader;

  void write_run();
  void write(std::span<const NodeTriangle> triangles);
  void merge(std::span<const Run> runs, const std::function<void(const NodeTriangle&)>& take);
  Run merge_into_one(std::span<const Run> runs);

  WaitingFile file_;
  Limits limits_;
  std::vector<NodeTriangle> held_;
  std::vector<Run> runs_;
};

}  // namespace isoweave
