// The rules of simplification, written a second time from docs/determinism.md: one queue over a complete surface, maps
// for what meets what. It shares no header with the library but public ones.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "isoweave/mesh.hpp"
#include "isoweave/simplify_options.hpp"
#include "plain_rules/quadrics.hpp"

namespace isoweave::plain {

struct Corner {
  Vector place{};
  std::uint64_t id = 0;
  Point normal{};
  float value = 0;
};

// A surface as it was extracted. Only corners that a triangle names are a part of it.
struct Surface {
  std::vector<Corner> corners{};
  std::vector<std::array<std::size_t, 3>> triangles{};
  std::uint64_t row = 0, plane = 0;  // points of the padded lattice; 0: ids are positions in a file
  double face = 1;                   // of a mean voxel: length squared
  double layer = 1;                  // height of a voxel, or what takes its place
};

struct Options {
  Quality quality = Quality::kNormal;
  double error = 0;             // lengths
  double most_distance = 0;     // 0: no such bound
  std::uint64_t triangles = 0;  // to stop at; 0: no such number
  bool drop_specks = false;
  bool normals_count = false;
};

// What is left, and what was done.
struct Outcome {
  Surface surface{};
  std::uint64_t collapses = 0, postponed = 0, rekeyed = 0, specks = 0, locked = 0;
  double dearest = 0;  // length: of the collapses as they were made
};

Outcome simplify(const Surface& surface, const Options& options);

}  // namespace isoweave::plain
