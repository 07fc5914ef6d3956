#include "pipeline/forecast/forecast_curve.hpp"

#include <algorithm>
#include <cmath>

#include "isoweave/components.hpp"

namespace isoweave {
namespace {

constexpr double kLeastError = 0.0025;  // voxels; scans in steps lose half of their triangles below 0.01
constexpr double kMostError = 3;        // voxels; tiles are too thin for more
constexpr double kStep = 4;
constexpr double kMargin = 0.4;  // triangles that a head start leaves beyond those wanted where few are

}  // namespace

ForecastCurve::ForecastCurve(double voxel, double most, bool several) : voxel_(voxel) {
  const double end = several ? std::min(most, kMostError * voxel) : 0;
  for (double error = kLeastError * voxel; error < end; error *= kStep) {
    errors_.push_back(error);
  }
  errors_.push_back(most);
  left_.resize(errors_.size(), 0);
}

double ForecastCurve::head_start(const MeshOptions& options, double open, double of_caps) const {
  if (!(open > 0)) return 0;
  auto wanted = static_cast<double>(options.triangles);
  if (const auto& chosen = options.components; chosen && chosen->triangles > 0) {
    // Tiles have all components.
    wanted *= 1 + static_cast<double>(chosen->triangles_dropped) / static_cast<double>(chosen->triangles);
  }
  const double share = std::clamp((wanted - of_caps) / open, 0.0, 1.0);
  // The more is removed, the more a tile may mislead.
  return std::min(error_that_leaves(share * (1 + kMargin * (1 - share))), kMostError * voxel_);
}

// The highest error at which a share of the triangles is left. 0 where that is a lower error than the tiles show.
double ForecastCurve::error_that_leaves(double share) const {
  const double wanted = std::max(share * all_, 1.0);
  std::size_t n = errors_.size();
  while (n > 0 && left_[n - 1] < wanted) --n;
  if (n == 0 || n == errors_.size()) return n == 0 ? 0 : errors_.back();
  // Between two errors the number goes as a power of the error.
  const double fall = std::log(left_[n - 1] / std::max(left_[n], 1.0));
  const double part = fall > 0 ? std::log(left_[n - 1] / wanted) / fall : 0;
  return errors_[n - 1] * std::pow(errors_[n] / errors_[n - 1], part);
}

}  // namespace isoweave
