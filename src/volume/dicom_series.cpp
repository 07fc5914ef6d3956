#include "volume/dicom_series.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "volume/dicom_file.hpp"
#include "volume/formats.hpp"
#include "volume/geometry.hpp"
#include "volume/header_text.hpp"
#include "volume/printable.hpp"

namespace isoweave {
namespace {

using Series = std::vector<DicomSlice>;

double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// A slice with its place: `depth` along the normal of the slices.
struct PlacedSlice {
  DicomSlice slice;
  Vector3 position{};
  double depth = 0;
};

// What must be the same on all slices of a series.
struct SliceKindFacts {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  SampleType type = SampleType::kUint8;
  std::string photometric;
  double slope = 1;
  double intercept = 0;

  bool operator==(const SliceKindFacts&) const = default;
};

std::string text_of(const SliceKindFacts& facts) {
  return std::to_string(facts.columns) + " x " + std::to_string(facts.rows) + " " +
         std::string(sample_type_name(facts.type)) + " " + facts.photometric + " scaled by " +
         number_text(facts.slope) + " and " + number_text(facts.intercept);
}

// Numbers between backslashes.
std::vector<double> numbers_of(const std::string& text, std::string_view what, std::size_t count,
                               const std::string& path) {
  std::vector<double> numbers;
  for (std::size_t at = 0; at <= text.size() && numbers.size() <= count;) {
    const std::size_t end = std::min(text.find('\\', at), text.size());
    const auto number = parse_double(trimmed(std::string_view(text).substr(at, end - at)));
    if (!number || !std::isfinite(*number)) break;
    numbers.push_back(*number);
    at = end + 1;
  }
  if (numbers.size() != count) {
    bad_input(path, std::to_string(count) + " numbers as " + std::string(what), text.empty() ? "none" : quoted(text));
  }
  return numbers;
}

double number_or(const std::string& text, double otherwise, std::string_view what, const std::string& path) {
  return text.empty() ? otherwise : numbers_of(text, what, 1, path)[0];
}

SampleType sample_type_of(const DicomSlice& slice) {
  if (slice.bits == 8) return slice.is_signed ? SampleType::kInt8 : SampleType::kUint8;
  if (slice.bits == 16) return slice.is_signed ? SampleType::kInt16 : SampleType::kUint16;
  if (slice.bits == 32) return slice.is_signed ? SampleType::kInt32 : SampleType::kUint32;
  bad_input(slice.path, "8, 16 or 32 bits allocated", std::to_string(slice.bits));
}

SliceKindFacts facts_of(const DicomSlice& slice) {
  if (slice.samples != 1 || !slice.photometric.starts_with("MONOCHROME")) {
    bad_input(slice.path, "grey samples (MONOCHROME1 or 2)",
              quoted(slice.photometric) + " of " + std::to_string(slice.samples) + " samples");
  }
  if (slice.stored < 1 || slice.high >= slice.bits || slice.stored > slice.high + 1) {
    bad_input(slice.path, "bits stored within those allocated",
              std::to_string(slice.stored) + " up to bit " + std::to_string(slice.high));
  }
  SliceKindFacts facts{slice.columns, slice.rows, sample_type_of(slice), slice.photometric};
  facts.slope = number_or(slice.slope, 1, "Rescale Slope", slice.path);
  facts.intercept = number_or(slice.intercept, 0, "Rescale Intercept", slice.path);
  if (facts.slope == 0) bad_input(slice.path, "a Rescale Slope other than 0", "0");
  return facts;
}

// The directions along rows and down columns, then the distances between samples along them.
struct Plane {
  Vector3 row{};
  Vector3 column{};
  double row_step = 1;
  double column_step = 1;

  Vector3 normal() const { return normal_of(row, column); }
};

Plane plane_of(const DicomSlice& slice) {
  const auto cosines = numbers_of(slice.orientation, "Image Orientation (Patient)", 6, slice.path);
  const auto steps = numbers_of(slice.pixel_spacing, "Pixel Spacing", 2, slice.path);
  Plane plane{{cosines[0], cosines[1], cosines[2]}, {cosines[3], cosines[4], cosines[5]}, steps[1], steps[0]};
  constexpr double kSlack = 1e-2;
  const bool orthonormal = std::abs(dot(plane.row, plane.row) - 1) < kSlack &&
                           std::abs(dot(plane.column, plane.column) - 1) < kSlack &&
                           std::abs(dot(plane.row, plane.column)) < kSlack;
  if (!orthonormal) {
    bad_input(slice.path, "orthogonal unit vectors as Image Orientation (Patient)", quoted(slice.orientation));
  }
  return plane;
}

bool is_close(const Plane& a, const Plane& b) {
  constexpr double kSlack = 1e-3;
  bool close = std::abs(a.row_step - b.row_step) <= kSlack * a.row_step &&
               std::abs(a.column_step - b.column_step) <= kSlack * a.column_step;
  for (std::size_t n = 0; n < 3; ++n) {
    close = close && std::abs(a.row[n] - b.row[n]) < kSlack && std::abs(a.column[n] - b.column[n]) < kSlack;
  }
  return close;
}

// Checks that the slices are parallel and alike, and puts them in order along their normal.
std::vector<PlacedSlice> placed(const Series& series) {
  const SliceKindFacts facts = facts_of(series.front());
  const Plane plane = plane_of(series.front());
  std::vector<PlacedSlice> slices;
  for (const DicomSlice& slice : series) {
    const SliceKindFacts found = facts_of(slice);
    if (found != facts) {
      bad_input(slice.path, text_of(facts) + " as in " + quoted(series.front().path), text_of(found));
    }
    if (!is_close(plane, plane_of(slice))) {
      bad_input(slice.path, "the orientation and pixel spacing of " + quoted(series.front().path),
                quoted(slice.orientation + " " + slice.pixel_spacing));
    }
    const auto at = numbers_of(slice.position, "Image Position (Patient)", 3, slice.path);
    const Vector3 position{at[0], at[1], at[2]};
    slices.push_back({slice, position, dot(position, plane.normal())});
  }
  std::stable_sort(slices.begin(), slices.end(),
                   [](const PlacedSlice& a, const PlacedSlice& b) { return a.depth < b.depth; });
  return slices;
}

std::vector<double> gaps_of(const std::vector<PlacedSlice>& slices) {
  std::vector<double> gaps;
  for (std::size_t n = 1; n < slices.size(); ++n) gaps.push_back(slices[n].depth - slices[n - 1].depth);
  return gaps;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void refuse_coinciding(const std::vector<PlacedSlice>& slices, const std::vector<double>& gaps, double usual) {
  constexpr double kSamePlace = 1e-2;
  for (std::size_t n = 0; n < gaps.size(); ++n) {
    if (gaps[n] > kSamePlace * usual && gaps[n] > 0) continue;
    bad_input(slices[n + 1].slice.path, "a position of its own for every slice",
              "that of " + quoted(slices[n].slice.path));
  }
}

// Notes about slices that are not where a regular grid has them.
void note_gaps(VolumeInfo& info, const std::vector<PlacedSlice>& slices, const std::vector<double>& gaps,
               double usual) {
  constexpr double kRegular = 1e-2;
  constexpr double kMissing = 1.5;
  std::int64_t missing = 0;
  std::size_t largest = 0;
  bool uneven = false;
  for (std::size_t n = 0; n < gaps.size(); ++n) {
    if (gaps[n] > kMissing * usual) missing += std::llround(gaps[n] / usual) - 1;
    if (gaps[n] > gaps[largest]) largest = n;
    uneven = uneven || std::abs(gaps[n] - usual) > kRegular * usual;
  }
  if (missing > 0) {
    info.notes.push_back(std::to_string(missing) + " slices seem to be missing: " + number_text(gaps[largest]) +
                         " mm between " + quoted(slices[largest].slice.path) + " and " +
                         quoted(slices[largest + 1].slice.path) + ", usually " + number_text(usual));
  }
  if (uneven) {
    info.notes.push_back("the slices are unevenly spaced, from " +
                         number_text(*std::min_element(gaps.begin(), gaps.end())) + " to " +
                         number_text(gaps[largest]) + " mm; the mean is used");
  }
}

// Notes slices that lie beside the line from the first to the last.
void note_line(VolumeInfo& info, const std::vector<PlacedSlice>& slices, const Vector3& step) {
  constexpr double kBeside = 1e-2;
  const PlacedSlice& first = slices.front();
  const double length = slices.back().depth - first.depth;
  const auto gaps = static_cast<double>(slices.size() - 1);
  double farthest = 0;
  for (const PlacedSlice& slice : slices) {
    const double along = (slice.depth - first.depth) / length * gaps;
    Vector3 beside{};
    for (std::size_t n = 0; n < 3; ++n) beside[n] = slice.position[n] - first.position[n] - along * step[n];
    farthest = std::max(farthest, std::sqrt(dot(beside, beside)));
  }
  if (farthest > kBeside * std::sqrt(dot(step, step))) {
    info.notes.push_back("the slices do not lie on one line: up to " + number_text(farthest) + " mm beside it");
  }
}

// The vector from one slice to the next, by the positions of the first and the last.
Vector3 slice_step(VolumeInfo& info, const std::vector<PlacedSlice>& slices, const Plane& plane) {
  Vector3 step = plane.normal();
  const DicomSlice& first = slices.front().slice;
  if (slices.size() == 1) {
    const std::string& text = first.slice_spacing.empty() ? first.thickness : first.slice_spacing;
    if (text.empty()) info.notes.emplace_back("one slice: its thickness is not given and taken as 1");
    const double thickness = number_or(text, 1, "Slice Thickness", first.path);
    for (double& component : step) component *= thickness;
    return step;
  }
  const std::vector<double> gaps = gaps_of(slices);
  const double usual = median_of(gaps);
  refuse_coinciding(slices, gaps, usual);
  note_gaps(info, slices, gaps, usual);
  for (std::size_t n = 0; n < 3; ++n) {
    step[n] = (slices.back().position[n] - slices.front().position[n]) / static_cast<double>(gaps.size());
  }
  note_line(info, slices, step);
  return step;
}

void set_axes(VolumeInfo& info, const std::vector<PlacedSlice>& slices) {
  const Plane plane = plane_of(slices.front().slice);
  Axes axes;
  for (std::size_t n = 0; n < 3; ++n) {
    axes.steps[0][n] = plane.row[n] * plane.row_step;
    axes.steps[1][n] = plane.column[n] * plane.column_step;
  }
  axes.steps[2] = slice_step(info, slices, plane);
  axes.origin = slices.front().position;
  set_geometry(info.geometry, axes, info.path);
  info.geometry.space = Space::kLps;
  info.geometry.unit = "mm";
}

// Compares the stored samples with what the header makes of them.
void check_sizes(const std::vector<PlacedSlice>& slices, std::uint64_t bytes) {
  constexpr std::uint64_t kPacked = 1 << 20;
  for (const PlacedSlice& placed : slices) {
    const std::uint64_t stored = placed.slice.pixel_bytes();
    if (placed.slice.packed) check_plausible(placed.slice.path, bytes, stored, kPacked);
    if (!placed.slice.packed && stored < bytes) {
      bad_input(placed.slice.path, std::to_string(bytes) + " bytes of samples", std::to_string(stored));
    }
  }
}

OpenedVolume volume_of(const Series& series, const std::string& path) {
  const std::vector<PlacedSlice> slices = placed(series);
  const SliceKindFacts facts = facts_of(slices.front().slice);
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = path;
  info.format = "dicom";
  info.type = facts.type;
  info.dims = {facts.columns, facts.rows, static_cast<std::int64_t>(slices.size())};
  checked_volume_bytes(info);
  check_sizes(slices, info.slice_bytes());
  set_axes(info, slices);
  info.slope = facts.slope;
  info.intercept = facts.intercept;
  if (facts.photometric == "MONOCHROME1") {
    info.notes.emplace_back("small values are shown bright in this series; samples are read as stored");
  }
  if (slices.front().slice.has_table) {
    info.notes.emplace_back("the series has a table from samples to values, which is not applied");
  }
  const auto list = std::make_shared<const std::vector<PlacedSlice>>(slices);
  const auto slice_of = [list](std::int64_t n) -> const DicomSlice& {
    return list->at(static_cast<std::size_t>(n)).slice;
  };
  const auto open = [slice_of, type = info.type, bytes = info.slice_bytes()](std::int64_t n) {
    return std::make_unique<DecodedStream>(
        [slice_of, n, type, bytes] { return decode_dicom(slice_of(n), type, bytes); });
  };
  const auto name = [slice_of](std::int64_t n) { return slice_of(n).path; };
  volume.samples = std::make_unique<FileSequence>(info.dims[2], info.slice_bytes(), open, name);
  return volume;
}

using SeriesByUid = std::map<std::string, Series>;

std::string listing(const SeriesByUid& all) {
  constexpr std::size_t kListed = 20;
  std::string text = std::to_string(all.size()) + " series: ";
  std::size_t n = 0;
  for (const auto& [uid, series] : all) {
    if (n++ == kListed) return text + "; ...";
    text += (n == 1 ? "" : "; ") + (uid.empty() ? "no UID" : uid) + " (" + quoted(series.front().description) + ", " +
            std::to_string(series.size()) + " slices)";
  }
  return text;
}

const Series& chosen_series(const SeriesByUid& all, const std::string& chosen, const std::string& path) {
  if (chosen.empty() && all.size() == 1) return all.begin()->second;
  if (chosen.empty()) bad_input(path, "one series, or the UID of one of them", listing(all));
  const auto found = all.find(chosen);
  if (found == all.end()) bad_input(path, "the series " + quoted(chosen), listing(all));
  return found->second;
}

}  // namespace

OpenedVolume open_dicom_series(const SliceFiles& slices, const std::string& chosen) {
  SeriesByUid all;
  std::int64_t without_image = 0;
  for (const std::string& path : slices.files) {
    const std::vector<DicomSlice> slices_of_file = read_dicom_header(path);
    for (const DicomSlice& slice : slices_of_file) all[slice.series].push_back(slice);
    if (slices_of_file.empty()) ++without_image;
  }
  if (all.empty()) bad_input(slices.path, "DICOM images", std::to_string(without_image) + " files without one");
  OpenedVolume volume = volume_of(chosen_series(all, chosen, slices.path), slices.path);
  std::vector<std::string>& notes = volume.info.notes;
  notes.insert(notes.begin(), slices.notes.begin(), slices.notes.end());
  if (without_image > 0) {
    notes.push_back(std::to_string(without_image) + " DICOM files hold no image and are left out");
  }
  return volume;
}

OpenedVolume open_dicom_file(const std::string& path, const std::string& chosen) {
  const std::vector<DicomSlice> self = read_dicom_header(path);
  if (self.empty()) bad_input(path, "a DICOM image", "a DICOM file without one");
  const std::string& uid = self.front().series;
  if (!chosen.empty() && chosen != uid) bad_input(path, "the series " + quoted(chosen), quoted(uid));
  Series series;
  std::size_t files = 0;
  for (const std::string& name : dicom_files_beside(path)) {
    const std::vector<DicomSlice> slices = read_dicom_header(name);
    if (slices.empty() || slices.front().series != uid) continue;
    ++files;
    series.insert(series.end(), slices.begin(), slices.end());
  }
  OpenedVolume volume = volume_of(series, path);
  if (files > 1) {
    volume.info.notes.push_back("the series of this file: " + std::to_string(files) + " files of its folder");
  }
  return volume;
}

}  // namespace isoweave
