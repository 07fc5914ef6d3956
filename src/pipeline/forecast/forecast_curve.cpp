#include "pipeline/forecast/forecast_curve.hpp"

#include <algorithm>
#include <cmath>

#include "isoweave/components.hpp"
#include "pipeline/task.hpp"

namespace isoweave {
namespace {

constexpr double kMostError = 3;  // voxels; tiles are too thin for more
constexpr double kMargin = 0.3;   // triangles that a head start leaves beyond those wanted where few are

}  // namespace

std::uint64_t expected_number(const MeshOptions& options, std::uint64_t extracted) {
  return goal_of(options).of(options.components ? options.components->triangles : extracted);
}

void ForecastCurve::add(std::uint64_t all, std::uint64_t left, const CostHistogram& removed) {
  all_ += static_cast<double>(all);
  left_ += static_cast<double>(left);
  removed_.merge(removed);
}

double ForecastCurve::share_left() const { return all_ > 0 ? std::min(1.0, left_ / all_) : 1; }

double ForecastCurve::head_start(const MeshOptions& options, std::uint64_t number, double open, double of_caps) const {
  auto wanted = static_cast<double>(number);
  if (const auto& chosen = options.components; chosen && chosen->triangles > 0) {
    // Tiles have all components.
    wanted *= 1 + static_cast<double>(chosen->triangles_dropped) / static_cast<double>(chosen->triangles);
  }
  return head_start(wanted - of_caps, open);
}

double ForecastCurve::head_start(double wanted, double all) const {
  if (!(all_ > 0) || wanted >= all) return 0;
  const double share = std::max(wanted / all, 0.0);
  // The more is removed, the more a tile may mislead.
  return std::min(error_that_leaves(share * (1 + kMargin * (1 - share))), kMostError * voxel_);
}

// The highest error at which a share of the triangles is left. The whole tile, with its ends, tells in which order
// triangles go, its middle how many of them.
double ForecastCurve::error_that_leaves(double share) const {
  if (share <= share_left()) return most_;
  const double removed = std::max(1 - share, 0.0) / (1 - share_left()) * static_cast<double>(removed_.items());
  const CostBits cost = removed_.highest_with_below(static_cast<std::uint64_t>(removed));
  return cost == kUnknownCost ? 0 : std::min(std::sqrt(double{cost_value(cost)}) * voxel_, most_);
}

}  // namespace isoweave
