#include "volume/formats/dicom/dicom_volume.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "files/header_text.hpp"
#include "files/input_file.hpp"
#include "files/quoted.hpp"
#include "parallel/size.hpp"
#include "volume/even_slices.hpp"
#include "volume/formats/dicom/dicom_axes.hpp"
#include "volume/formats/dicom/dicom_numbers.hpp"
#include "volume/formats/dicom/dicom_places.hpp"
#include "volume/formats/dicom/dicom_segmentation.hpp"
#include "volume/formats/dicom/series_volumes.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

using Slices = std::vector<PlacedSlice>;

bool is_scaled_alike(const Slices& slices) {
  return std::all_of(slices.begin(), slices.end(), [&](const PlacedSlice& slice) {
    return slice.slope == slices.front().slope && slice.intercept == slices.front().intercept;
  });
}

// Sets how samples become values: by the scaling that all slices share, or by that of each slice while it is read.
void set_scaling(VolumeInfo& info, const Slices& slices) {
  if (is_scaled_alike(slices)) {
    if (slices.front().slope == 0) bad_input(slices.front().slice.path, "a Rescale Slope other than 0", "0");
    info.slope = slices.front().slope;
    info.intercept = slices.front().intercept;
    return;
  }
  const double largest_sample = std::ldexp(1.0, 8 * static_cast<int>(sample_bytes(info.type)));
  // The mantissa of a float has 24 bits.
  info.type = sample_bytes(info.type) <= 2 ? SampleType::kFloat32 : SampleType::kFloat64;
  const double largest = info.type == SampleType::kFloat32 ? static_cast<double>(std::numeric_limits<float>::max())
                                                           : std::numeric_limits<double>::max();
  for (const PlacedSlice& slice : slices) {
    if (std::abs(slice.slope) * largest_sample + std::abs(slice.intercept) <= largest) continue;
    bad_input(slice.slice.path, "values that fit in " + std::string(sample_type_name(info.type)),
              "samples scaled by " + number_text(slice.slope) + " and " + number_text(slice.intercept));
  }
  const auto [least, most] =
      std::minmax_element(slices.begin(), slices.end(), [](const auto& a, const auto& b) { return a.slope < b.slope; });
  info.notes.push_back("the scaling differs from slice to slice (Rescale Slope " + number_text(least->slope) + " to " +
                       number_text(most->slope) + "): samples are read as values, slice by slice, in " +
                       std::string(sample_type_name(info.type)));
}

template <class Value>
std::vector<std::byte> values_of(const std::vector<std::byte>& samples, SampleType type, const PlacedSlice& slice) {
  std::vector<std::byte> values(samples.size() / sample_bytes(type) * sizeof(Value));
  auto* const out = reinterpret_cast<Value*>(values.data());
  visit_sample_type(type, [&]<class Sample>() {
    const auto* const in = reinterpret_cast<const Sample*>(samples.data());
    for (std::size_t n = 0; n < samples.size() / sizeof(Sample); ++n) {
      out[n] = static_cast<Value>(slice.slope * static_cast<double>(in[n]) + slice.intercept);
    }
  });
  return values;
}

// One slice as it is handed out: as stored, or as values where `type` is no longer the stored one.
std::vector<std::byte> decoded(const PlacedSlice& slice, SampleType stored, std::size_t stored_bytes, SampleType type) {
  std::vector<std::byte> samples = decode_dicom(slice.slice, stored, stored_bytes);
  if (type == stored) return samples;
  return type == SampleType::kFloat32 ? values_of<float>(samples, stored, slice)
                                      : values_of<double>(samples, stored, slice);
}

std::unique_ptr<ByteStream> samples_of(const VolumeInfo& info, const std::shared_ptr<const PlacedSeries>& series,
                                       const EvenGrid& grid) {
  const auto slice_of = [series](std::int64_t n) -> const PlacedSlice& {
    return series->slices.at(static_cast<std::size_t>(n));
  };
  const SampleType stored = series->facts.type;
  const std::size_t stored_bytes = to_size(info.slice_samples(), sample_bytes(stored));
  const auto open = [slice_of, stored, stored_bytes, type = info.type](std::int64_t n) {
    return std::make_unique<DecodedStream>(
        [slice_of, n, stored, stored_bytes, type] { return decoded(slice_of(n), stored, stored_bytes, type); });
  };
  const auto name = [slice_of](std::int64_t n) { return slice_of(n).slice.path; };
  auto slices =
      std::make_unique<FileSequence>(static_cast<std::int64_t>(series->slices.size()), info.slice_bytes(), open, name);
  return even_slices(std::move(slices), grid, info.type, info.slice_bytes());
}

// The last digit of the positions, in the coordinate that the normal is nearest to. Zeros behind are none.
double rounding_of(const PlacedSeries& series) {
  const Vector3 normal = series.plane.normal();
  const auto along = static_cast<std::size_t>(
      std::max_element(normal.begin(), normal.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }) -
      normal.begin());
  int decimals = 0;
  for (const PlacedSlice& placed : series.slices) {
    if (placed.slice.offset != 0) return 0;
    decimals = std::max(decimals, decimals_of(placed.slice.position, along));
  }
  return std::pow(10.0, -decimals);
}

EvenGrid grid_of(VolumeInfo& info, const PlacedSeries& series, const OpenOptions& options) {
  const Slices& slices = series.slices;
  SlicePlaces places{info.path,
                     {},
                     [&](std::size_t n) { return slices[n].slice.name(); },
                     [&](std::size_t n) { return slices[n].slice.path; }};
  for (const PlacedSlice& slice : slices) places.depths.push_back(slice.depth);
  places.rounding = rounding_of(series);
  // Distances that are given instead of the file's are those of the slices that there are.
  std::vector<std::string> notes;
  EvenGrid grid = even_grid(places, options.spacing ? UnevenSlices::kMean : options.uneven_slices, notes);
  if (options.spacing && !notes.empty()) {
    notes.back() = "the slices do not lie at an even distance: the one that is given is taken for all of them";
  }
  info.notes.insert(info.notes.end(), notes.begin(), notes.end());
  if (grid.is_resampled) info.part += (info.part.empty() ? "" : ", ") + std::string("slices made at an even distance");
  return grid;
}

void note_header(VolumeInfo& info, const DicomSlice& slice) {
  if (!slice.placed_by.empty()) {
    info.notes.push_back("the frames have no places of their own (functional groups): " + slice.placed_by);
  }
  if (slice.photometric == "MONOCHROME1") {
    info.notes.emplace_back("small values are shown bright in this series; samples are read as stored");
  }
  if (slice.has_table) {
    info.notes.emplace_back("the series has a table from samples to values, which is not applied");
  }
}

// One slice is looked at, as notes are read before samples are: the one in the middle, where most is to be seen.
void note_bits(VolumeInfo& info, const PlacedSeries& series) {
  const DicomSlice& slice = series.slices[series.slices.size() / 2].slice;
  const std::size_t bytes = to_size(info.slice_samples(), sample_bytes(series.facts.type));
  if (!has_bits_above(slice, series.facts.type, bytes)) return;
  info.notes.push_back("samples have bits above the " + std::to_string(slice.stored) +
                       " that are said to be stored (Bits Stored), as in " + in_quotes(slice.name()) +
                       ": they are cleared, and values are wrong if they belong to them");
}

}  // namespace

OpenedVolume open_dicom_slices(const std::vector<DicomSlice>& series, const std::string& path,
                               const OpenOptions& options) {
  if (series.front().segmentation) return open_dicom_segmentation(series, path, options);
  PlacedSeries all = place_series(series);
  std::string part;
  choose_volume(all, path, options, part);
  const auto shared = std::make_shared<const PlacedSeries>(std::move(all));
  const PlacedSeries& placed = *shared;
  const Slices& slices = placed.slices;
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = path;
  info.format = "dicom";
  info.part = part;
  info.type = placed.facts.type;
  info.dims = {placed.facts.columns, placed.facts.rows, static_cast<std::int64_t>(slices.size())};
  checked_volume_bytes(info);
  check_sizes(slices, info.slice_bytes());
  info.notes = placed.notes;
  const EvenGrid grid = grid_of(info, placed, options);
  info.dims[2] = grid.count;
  set_dicom_axes(info, placed, grid.count);
  set_scaling(info, slices);
  for (const PlacedSlice& placed_slice : slices) {
    const std::string& file = placed_slice.slice.file;
    if (info.data_files.empty() || info.data_files.back() != file) info.data_files.push_back(file);
  }
  checked_volume_bytes(info);
  note_header(info, slices.front().slice);
  note_bits(info, placed);
  volume.held_bytes = 4 * info.slice_bytes();  // one decoded and as it is stored, two between which others are made
  volume.samples = samples_of(info, shared, grid);
  return volume;
}

}  // namespace isoweave
