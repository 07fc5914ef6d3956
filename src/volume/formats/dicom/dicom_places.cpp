#include "volume/formats/dicom/dicom_places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>

#include "files/input_file.hpp"
#include "files/quoted.hpp"
#include "volume/formats/dicom/dicom_numbers.hpp"
#include "volume/formats/dicom/dicom_scouts.hpp"

namespace isoweave {
namespace {

double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

std::string text_of(const SliceKindFacts& facts) {
  return std::to_string(facts.columns) + " x " + std::to_string(facts.rows) + " " +
         std::string(sample_type_name(facts.type)) + " " + facts.photometric;
}

SampleType sample_type_of(const DicomSlice& slice) {
  if (slice.bits == 1 && slice.packed) bad_input(slice.path, "samples of 1 bit as they are", "packed ones");
  if (slice.bits == 1) return SampleType::kUint8;
  if (slice.bits == 8) return slice.is_signed ? SampleType::kInt8 : SampleType::kUint8;
  if (slice.bits == 16) return slice.is_signed ? SampleType::kInt16 : SampleType::kUint16;
  if (slice.bits == 32) return slice.is_signed ? SampleType::kInt32 : SampleType::kUint32;
  bad_input(slice.path, "1, 8, 16 or 32 bits allocated", std::to_string(slice.bits));
}

// Refuses packed samples that no decoder is there for, by the name of their family. Files of other series in a folder
// may have them.
void refuse_unread_syntax(const DicomSlice& slice) {
  struct Family {
    std::string_view begin, name;
  };
  static constexpr std::array<Family, 3> kFamilies{{{"1.2.840.10008.1.2.4.10", "MPEG or HEVC"},
                                                    {"1.2.840.10008.1.2.4.11", "JPEG XL"},
                                                    {"1.2.840.10008.1.2.4.20", "High-Throughput JPEG 2000"}}};
  for (const Family& family : kFamilies) {
    const bool is_of_family = slice.syntax.size() == family.begin.size() + 1 && slice.syntax.starts_with(family.begin);
    if (!is_of_family) continue;
    bad_input(slice.path, "a transfer syntax of plain, deflated, JPEG, JPEG-LS, JPEG 2000 or RLE samples",
              in_quotes(slice.syntax) + " (" + std::string(family.name) + ")");
  }
}

SliceKindFacts facts_of(const DicomSlice& slice) {
  refuse_unread_syntax(slice);
  // Colours of a label map are for show: its samples are numbers.
  const bool shows = slice.photometric.starts_with("MONOCHROME") ||
                     (slice.photometric == "PALETTE COLOR" && slice.segmentation != nullptr);
  if (slice.samples != 1 || !shows) {
    bad_input(slice.path, "grey samples (MONOCHROME1 or 2)",
              in_quotes(slice.photometric) + " of " + std::to_string(slice.samples) + " samples");
  }
  if (slice.stored < 1 || slice.high >= slice.bits || slice.stored > slice.high + 1) {
    bad_input(slice.path, "bits stored within those allocated",
              std::to_string(slice.stored) + " up to bit " + std::to_string(slice.high));
  }
  return {slice.columns, slice.rows, sample_type_of(slice), slice.photometric};
}

SlicePlane plane_of(const DicomSlice& slice) {
  const auto cosines = numbers_of(slice.orientation, "Image Orientation (Patient)", 6, slice.path);
  const auto steps = numbers_of(slice.pixel_spacing, "Pixel Spacing", 2, slice.path);
  SlicePlane plane{{cosines[0], cosines[1], cosines[2]}, {cosines[3], cosines[4], cosines[5]}, steps[1], steps[0]};
  constexpr double kSlack = 1e-2;
  const bool orthonormal = std::abs(dot(plane.row, plane.row) - 1) < kSlack &&
                           std::abs(dot(plane.column, plane.column) - 1) < kSlack &&
                           std::abs(dot(plane.row, plane.column)) < kSlack;
  if (!orthonormal) {
    bad_input(slice.path, "orthogonal unit vectors as Image Orientation (Patient)", in_quotes(slice.orientation));
  }
  return plane;
}

bool is_close(const SlicePlane& a, const SlicePlane& b) {
  constexpr double kSlack = 1e-3;
  bool close = std::abs(a.row_step - b.row_step) <= kSlack * a.row_step &&
               std::abs(a.column_step - b.column_step) <= kSlack * a.column_step;
  for (std::size_t n = 0; n < 3; ++n) {
    close = close && std::abs(a.row[n] - b.row[n]) < kSlack && std::abs(a.column[n] - b.column[n]) < kSlack;
  }
  return close;
}

PlacedSlice placed(DicomSlice slice, const Vector3& normal) {
  PlacedSlice result;
  const auto at = numbers_of(slice.position, "Image Position (Patient)", 3, slice.path);
  for (std::size_t n = 0; n < 3; ++n) result.position[n] = at[n] + slice.offset * normal[n];
  result.depth = dot(result.position, normal);
  if (!std::isfinite(result.depth)) bad_input(slice.path, "a finite position", in_quotes(slice.position));
  result.slope = number_or(slice.slope, 1, "Rescale Slope", slice.path);
  result.intercept = number_or(slice.intercept, 0, "Rescale Intercept", slice.path);
  result.slice = std::move(slice);
  return result;
}

// Refuses an image that holds slices beside one another, as Siemens writes functional MR: it is no slice itself. Images
// that were cut up may still say so, but then they lie in several places.
void refuse_mosaic(const std::vector<DicomSlice>& slices) {
  const DicomSlice& first = slices.front();
  const bool in_one_place = std::all_of(slices.begin(), slices.end(), [&](const DicomSlice& slice) {
    return slice.position == first.position && slice.offset == first.offset;
  });
  if (!in_one_place || first.image_type.find("MOSAIC") == std::string::npos) return;
  bad_input(first.path, "one slice in an image",
            "a mosaic of slices (Image Type), which is not read (dcm2niix turns it into NIfTI)");
}

// Drops slices that are copies of others in the same place: exports hold images twice.
void drop_copies(PlacedSeries& series) {
  using Identity = std::tuple<std::string_view, std::size_t, Vector3>;  // image, frame, position
  std::map<Identity, const DicomSlice*> first;
  std::vector<bool> is_dropped;
  std::string copy;
  for (const PlacedSlice& placed : series.slices) {
    const DicomSlice& slice = placed.slice;
    const auto [found, is_new] = first.emplace(Identity{slice.image, slice.frame, placed.position}, &slice);
    is_dropped.push_back(!is_new && is_copy(*found->second, slice));
    if (is_dropped.back()) copy = in_quotes(slice.name());
  }
  std::vector<PlacedSlice> kept;
  for (std::size_t n = 0; n < is_dropped.size(); ++n) {
    if (!is_dropped[n]) kept.push_back(std::move(series.slices[n]));
  }
  const std::size_t dropped = series.slices.size() - kept.size();
  series.slices = std::move(kept);
  if (dropped == 0) return;
  series.notes.push_back(
      std::to_string(dropped) +
      (dropped == 1 ? " image is a copy of another and is" : " images are copies of others and are") +
      " left out, as " + copy);
}

}  // namespace

Depths depths_of(const PlacedSeries& series) {
  constexpr double kSame = 1e-3;  // of the distance of samples in a plane
  const double slack = kSame * std::min(series.plane.row_step, series.plane.column_step);
  Depths depths;
  for (const PlacedSlice& slice : series.slices) {
    if (depths.distinct.empty() || slice.depth - depths.distinct.back() > slack) depths.distinct.push_back(slice.depth);
    depths.of_slice.push_back(depths.distinct.size() - 1);
  }
  return depths;
}

void check_sizes(const std::vector<PlacedSlice>& slices, std::uint64_t bytes) {
  constexpr std::uint64_t kPacked = 1 << 20;
  for (const PlacedSlice& placed : slices) {
    const std::uint64_t stored = placed.slice.pixel_bytes();
    if (placed.slice.packed) check_plausible(placed.slice.path, bytes, stored, kPacked);
    const std::uint64_t plain = placed.slice.plain_bytes();
    if (!placed.slice.packed && stored < plain) {
      bad_input(placed.slice.path, std::to_string(plain) + " bytes of samples", std::to_string(stored));
    }
  }
}

void refuse_slices_from(const OpenOptions& options, const std::string& path) {
  if (options.slices_from == SliceAxis::kSlices) return;
  bad_input(path, "a file that does not say where its slices lie, for --slices-from", "DICOM, which does");
}

PlacedSeries place_series(const std::vector<DicomSlice>& series) {
  PlacedSeries result;
  std::vector<DicomSlice> slices = without_scouts(series, result.notes);
  refuse_mosaic(slices);
  const DicomSlice first = slices.front();
  result.facts = facts_of(first);
  result.plane = plane_of(first);
  for (DicomSlice& slice : slices) {
    const SliceKindFacts found = facts_of(slice);
    if (found != result.facts) {
      bad_input(slice.path, text_of(result.facts) + " as in " + in_quotes(first.name()), text_of(found));
    }
    if (!is_close(result.plane, plane_of(slice))) {
      bad_input(slice.path, "the orientation and pixel spacing of " + in_quotes(first.name()),
                in_quotes(slice.orientation + " " + slice.pixel_spacing));
    }
    result.slices.push_back(placed(std::move(slice), result.plane.normal()));
  }
  std::stable_sort(result.slices.begin(), result.slices.end(),
                   [](const PlacedSlice& a, const PlacedSlice& b) { return a.depth < b.depth; });
  drop_copies(result);
  return result;
}

}  // namespace isoweave
