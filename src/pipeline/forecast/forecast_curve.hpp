// How many triangles of tiles are left at several errors.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "isoweave/mesh_options.hpp"

namespace isoweave {

class ForecastCurve {
 public:
  // The errors, ascending: `most`, and where `several` are asked for some below it, in steps from a small part of a
  // voxel on.
  ForecastCurve(double voxel, double most, bool several);

  const std::vector<double>& errors() const { return errors_; }

  // Adds the triangles of a tile: all, and those left at each error.
  void add(std::uint64_t all, std::span<const std::uint64_t> left) {
    all_ += static_cast<double>(all);
    for (std::size_t n = 0; n < left.size(); ++n) left_[n] += static_cast<double>(left[n]);
  }

  // The share of the triangles that is left at the last error; 1 without tiles.
  double share_left() const { return all_ > 0 ? std::min(1.0, left_.back() / all_) : 1; }

  // The head start of a run to a number of triangles: an error that leaves clearly more of them by this curve, of
  // `open` triangles on the open surface and `of_caps` others that stay. 0: none is known.
  double head_start(const MeshOptions& options, double open, double of_caps) const;

 private:
  double error_that_leaves(double share) const;

  double voxel_;
  std::vector<double> errors_;
  std::vector<double> left_;  // triangles at each error
  double all_ = 0;
};

}  // namespace isoweave
