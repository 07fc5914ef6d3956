// How many triangles of tiles are left at each error.
#pragma once

#include <cstdint>

#include "isoweave/mesh_options.hpp"
#include "simplify/cost_histogram.hpp"

namespace isoweave {

// The number of triangles to stop at, where a surface of `extracted` triangles is expected; 0: there is none.
std::uint64_t expected_number(const MeshOptions& options, std::uint64_t extracted);

class ForecastCurve {
 public:
  // voxel: the mean one. Tiles are simplified up to the error `most`.
  ForecastCurve(double voxel, double most) : voxel_(voxel), most_(most) {}

  // Adds a tile: the triangles of the full and of the simplified surface where the ends of the tile hardly disturb it,
  // and those of the whole tile that collapses remove, by their costs.
  void add(std::uint64_t all, std::uint64_t left, const CostHistogram& removed);

  // The share of the triangles that is left at the error `most`; 1 without tiles.
  double share_left() const;

  // The head start of a run to a number of triangles: an error that leaves clearly more of them by this curve, of
  // `open` triangles on the open surface and `of_caps` others that stay. 0: none is known.
  double head_start(const MeshOptions& options, std::uint64_t number, double open, double of_caps) const;

  // The same of `wanted` triangles out of `all`. 0 as well where all of them are wanted.
  double head_start(double wanted, double all) const;

 private:
  double error_that_leaves(double share) const;

  double voxel_, most_;
  double all_ = 0, left_ = 0;  // triangles in the middle of tiles
  CostHistogram removed_;      // from tiles
};

}  // namespace isoweave
