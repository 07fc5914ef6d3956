#include "volume/formats/dicom/dicom_axes.hpp"

#include <algorithm>
#include <cmath>

#include "files/header_text.hpp"
#include "volume/formats/dicom/dicom_numbers.hpp"

namespace isoweave {
namespace {

using Slices = std::vector<PlacedSlice>;

// Notes slices that lie beside the line from the first to the last.
void note_line(VolumeInfo& info, const Slices& slices, const Vector3& step) {
  constexpr double kBeside = 1e-2;
  const PlacedSlice& first = slices.front();
  const PlacedSlice& last = slices.back();
  double farthest = 0;
  for (const PlacedSlice& slice : slices) {
    const double along = (slice.depth - first.depth) / (last.depth - first.depth);
    Vector3 beside{};
    for (std::size_t n = 0; n < 3; ++n) {
      beside[n] = slice.position[n] - first.position[n] - along * (last.position[n] - first.position[n]);
    }
    farthest = std::max(farthest, length_of(beside));
  }
  if (farthest > kBeside * length_of(step)) {
    info.notes.push_back("the slices do not lie on one line: up to " + number_text(farthest) + " mm beside it");
  }
}

// The vector across the only slice there is.
Vector3 thickness_of(VolumeInfo& info, const DicomSlice& slice, const SlicePlane& plane) {
  const std::string& text = slice.slice_spacing.empty() ? slice.thickness : slice.slice_spacing;
  if (text.empty()) info.notes.emplace_back("one slice: its thickness is not given and taken as 1");
  // The sign of a distance says on which side other slices would lie.
  const double thickness = std::abs(number_or(text, 1, "Slice Thickness", slice.path));
  Vector3 step = plane.normal();
  for (double& component : step) component *= thickness;
  return step;
}

// The vector from one of `count` slices to the next, by the positions of the first slice and the last.
Vector3 slice_step(VolumeInfo& info, const PlacedSeries& series, std::int64_t count) {
  const Slices& slices = series.slices;
  if (count == 1) return thickness_of(info, slices.front().slice, series.plane);
  Vector3 step{};
  for (std::size_t n = 0; n < 3; ++n) {
    step[n] = (slices.back().position[n] - slices.front().position[n]) / static_cast<double>(count - 1);
  }
  note_line(info, slices, step);
  return step;
}

}  // namespace

void set_dicom_axes(VolumeInfo& info, const PlacedSeries& series, std::int64_t count) {
  const SlicePlane& plane = series.plane;
  Axes axes;
  for (std::size_t n = 0; n < 3; ++n) {
    axes.steps[0][n] = plane.row[n] * plane.row_step;
    axes.steps[1][n] = plane.column[n] * plane.column_step;
  }
  axes.steps[2] = slice_step(info, series, count);
  axes.origin = series.slices.front().position;
  set_geometry(info.geometry, axes, info.path);
  info.geometry.space = Space::kLps;
  if (series.slices.front().slice.has_unit) info.geometry.unit = "mm";
}

}  // namespace isoweave
