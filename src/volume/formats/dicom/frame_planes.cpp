#include "volume/formats/dicom/frame_planes.hpp"

#include <algorithm>
#include <cmath>

#include "files/header_text.hpp"
#include "files/input_file.hpp"
#include "volume/formats/dicom/dicom_numbers.hpp"

namespace isoweave {
namespace {

// The number of the plane of each depth, if planes are so far apart; empty where a depth lies between two planes.
std::vector<std::int64_t> planes_at(const std::vector<double>& depths, double distance) {
  constexpr double kBeside = 0.05;  // of the distance: positions are written in few digits
  constexpr double kMost = 1 << 17;
  std::vector<std::int64_t> planes{0};
  for (std::size_t n = 1; n < depths.size(); ++n) {
    const double steps = std::round((depths[n] - depths[n - 1]) / distance);
    if (!(steps >= 1 && steps <= kMost)) return {};
    planes.push_back(planes.back() + static_cast<std::int64_t>(steps));
  }
  if (static_cast<double>(planes.back()) > kMost) return {};
  const double mean =
      depths.size() < 2 ? distance : (depths.back() - depths.front()) / static_cast<double>(planes.back());
  for (std::size_t n = 0; n < depths.size(); ++n) {
    const double place = depths.front() + mean * static_cast<double>(planes[n]);
    if (std::abs(depths[n] - place) > kBeside * mean) return {};
  }
  return planes;
}

std::vector<double> gaps_of(const std::vector<double>& depths) {
  std::vector<double> gaps;
  for (std::size_t n = 1; n < depths.size(); ++n) gaps.push_back(depths[n] - depths[n - 1]);
  return gaps;
}

// The planes where they are even, else none.
std::vector<std::int64_t> even_planes(const PlacedSeries& series, const std::vector<double>& depths) {
  const DicomSlice& first = series.slices.front().slice;
  const double said = std::abs(number_or(first.slice_spacing, 0, "Spacing Between Slices", first.path));
  if (said > 0) {
    if (std::vector<std::int64_t> planes = planes_at(depths, said); !planes.empty()) return planes;
  }
  const std::vector<double> gaps = gaps_of(depths);
  return gaps.empty() ? std::vector<std::int64_t>{0} : planes_at(depths, *std::min_element(gaps.begin(), gaps.end()));
}

}  // namespace

FramePlanes frame_planes(const PlacedSeries& series, const std::string& path, const OpenOptions& options) {
  const Depths depths = depths_of(series);
  FramePlanes result;
  std::vector<std::int64_t> planes = even_planes(series, depths.distinct);
  if (planes.empty()) {
    const std::vector<double> gaps = gaps_of(depths.distinct);
    const auto [least, most] = std::minmax_element(gaps.begin(), gaps.end());
    const std::string found = "distances of " + number_text(*least) + " to " + number_text(*most) + " mm";
    if (!options.spacing && options.uneven_slices != UnevenSlices::kMean) {
      bad_input(path, "frames at multiples of one distance, as a segmentation may leave empty ones out", found);
    }
    for (std::size_t n = 0; n < depths.distinct.size(); ++n) planes.push_back(static_cast<std::int64_t>(n));
    result.notes.push_back("frames do not lie at multiples of one distance, and are taken as they are: " + found);
  }
  for (const std::size_t depth : depths.of_slice) result.of_frame.push_back(planes[depth]);
  result.count = planes.back() + 1;
  return result;
}

}  // namespace isoweave
