#include "measure/angles.hpp"

#include <numbers>

namespace isoweave::measure {
namespace {

constexpr double kCotangentOf5Degrees = 11.430052302761343;

// The cotangents of 6, 12, ... 54 degrees: the limits between the bins of the smallest angle, which is at most 60.
constexpr std::array<double, 9> kCotangentsOfBins{9.514364454222584,  4.704630109478455,  3.077683537175254,
                                                  2.246036773904216,  1.7320508075688774, 1.3763819204711736,
                                                  1.1106125148291929, 0.9004040442978399, 0.726542528005361};

struct Extremes {
  double sharpest, bluntest;
};

// The cotangents of the smallest and the largest angle.
Extremes extreme_cotangents(const TriangleCorners& triangle) {
  const Vector ab = triangle[1] - triangle[0];
  const Vector bc = triangle[2] - triangle[1];
  const Vector ca = triangle[0] - triangle[2];
  const Vector normal = cross(ab, bc);
  const double twice_area = std::sqrt(dot(normal, normal));
  if (!(twice_area > 0)) return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  // Two sides' lengths times the cosine between them over the same lengths times the sine.
  const std::array<double, 3> dots{-dot(ca, ab), -dot(ab, bc), -dot(bc, ca)};
  return {std::max({dots[0], dots[1], dots[2]}) / twice_area, std::min({dots[0], dots[1], dots[2]}) / twice_area};
}

double degrees(double cotangent) { return std::atan2(1.0, cotangent) * 180 / std::numbers::pi; }

}  // namespace

void AngleSurvey::add(const TriangleCorners& triangle) {
  const auto [sharpest, bluntest] = extreme_cotangents(triangle);
  largest_cotangent_ = std::max(largest_cotangent_, sharpest);
  least_cotangent_ = std::min(least_cotangent_, bluntest);
  ++counts_.triangles;
  if (sharpest > kCotangentOf5Degrees) ++counts_.under_5_degrees;
  std::size_t bin = 0;
  while (bin < kCotangentsOfBins.size() && sharpest <= kCotangentsOfBins[bin]) ++bin;
  ++counts_.smallest_in_bins[bin];
}

TriangleAngles AngleSurvey::result() const {
  TriangleAngles result = counts_;
  if (result.triangles > 0) {
    result.smallest = degrees(largest_cotangent_);
    result.largest = degrees(least_cotangent_);
  }
  return result;
}

}  // namespace isoweave::measure
