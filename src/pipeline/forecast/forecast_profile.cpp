#include "pipeline/forecast/forecast_profile.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "volume/crossed_bricks.hpp"

namespace isoweave {

BricksOfLayers::BricksOfLayers(const VolumeIndex& index, const IsoRule& rule) {
  const std::array open{IndexedSurface{rule.iso, rule.above, false, 0}};
  const CrossedBricks bricks(index, open);
  for (std::int64_t k = 0; k < bricks.size()[2]; ++k) crossed_.push_back(static_cast<double>(bricks.crossed_in(k)));
}

std::vector<double> BricksOfLayers::spread(const std::vector<double>& per_layer, double distance) const {
  // Bricks at the place of a block's middle; where none is crossed the ratio of all blocks counts.
  std::vector<double> crossed;
  for (std::size_t n = 0; n < per_layer.size(); ++n) {
    const double brick = (static_cast<double>(n) + 0.5) * distance / static_cast<double>(kBrick);
    crossed.push_back(crossed_[std::min(static_cast<std::size_t>(brick), crossed_.size() - 1)]);
  }
  const double all = std::accumulate(crossed.begin(), crossed.end(), 0.0);
  const double mean = all > 0 ? std::accumulate(per_layer.begin(), per_layer.end(), 0.0) / all : 0;
  const auto ratio = [&](std::size_t n) { return crossed[n] > 0 ? per_layer[n] / crossed[n] : mean; };
  std::vector<double> spread;
  for (std::size_t k = 0; k < crossed_.size(); ++k) {
    const double middle = (static_cast<double>(k) + 0.5) * static_cast<double>(kBrick);
    const double place = std::clamp(middle / distance - 0.5, 0.0, static_cast<double>(per_layer.size() - 1));
    const auto n = std::min(static_cast<std::size_t>(place), per_layer.size() - 1);
    const double beyond = place - static_cast<double>(n);
    const double next = ratio(std::min(n + 1, per_layer.size() - 1));
    spread.push_back(crossed_[k] * (ratio(n) + beyond * (next - ratio(n))));
  }
  return spread;
}

}  // namespace isoweave
