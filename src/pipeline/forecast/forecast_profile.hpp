// How the triangles of a surface are spread over the layers of a volume, as a forecast sees it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "extract/cube_rules.hpp"
#include "volume/volume_index.hpp"

namespace isoweave {

// The number of triangles below a height, in layers. Between the middles of two blocks the facts go from those of the
// one to those of the other; outside they stay.
class Profile {
 public:
  Profile(std::vector<double> per_layer, double distance) : per_layer_(std::move(per_layer)), distance_(distance) {
    below_.push_back(per_layer_[0] * distance_ / 2);
    for (std::size_t n = 1; n < per_layer_.size(); ++n) {
      below_.push_back(below_.back() + (per_layer_[n - 1] + per_layer_[n]) / 2 * distance_);
    }
  }

  double below(double height) const {
    const double place = std::max(height, 0.0) / distance_ - 0.5;
    if (place <= 0) return per_layer_[0] * std::max(height, 0.0);
    const std::size_t n = std::min(static_cast<std::size_t>(place), per_layer_.size() - 1);
    const double beyond = place - static_cast<double>(n);
    if (n + 1 == per_layer_.size()) return below_[n] + per_layer_[n] * beyond * distance_;
    const double here = per_layer_[n] + beyond * (per_layer_[n + 1] - per_layer_[n]);
    return below_[n] + (per_layer_[n] + here) / 2 * beyond * distance_;
  }

 private:
  std::vector<double> per_layer_;
  double distance_;
  std::vector<double> below_;  // the middle of each block
};

// The profiles of the open surface, and of the caps.
struct Profiles {
  Profile open, caps;
};

// The crossed bricks in each layer of bricks of a volume with an index.
class BricksOfLayers {
 public:
  BricksOfLayers(const VolumeIndex& index, const IsoRule& rule);

  // The triangles per layer of the volume in each layer of bricks. `per_layer`: those that blocks show, `distance`
  // layers apart. Between the middles of two blocks the triangles per crossed brick go from those of the one to those
  // of the other.
  std::vector<double> spread(const std::vector<double>& per_layer, double distance) const;

 private:
  std::vector<double> crossed_;
};

}  // namespace isoweave
