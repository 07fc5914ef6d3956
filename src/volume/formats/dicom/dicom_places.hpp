// The places of the slices of a DICOM series: parallel planes of one kind, in order along their normal.
#pragma once

#include <string>
#include <vector>

#include "volume/axes.hpp"
#include "volume/formats/dicom/dicom_file.hpp"

namespace isoweave {

// The facts that must be the same on all slices of a series.
struct SliceKindFacts {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  SampleType type = SampleType::kUint8;
  std::string photometric;

  bool operator==(const SliceKindFacts&) const = default;
};

// The directions along rows and down columns, then the distances between samples along them.
struct SlicePlane {
  Vector3 row{};
  Vector3 column{};
  double row_step = 1;
  double column_step = 1;

  Vector3 normal() const { return normal_of(row, column); }
};

// A slice with its place, `depth` along the normal of the slices, and the scaling of its samples.
struct PlacedSlice {
  DicomSlice slice;
  Vector3 position{};
  double depth = 0;
  double slope = 1;
  double intercept = 0;
};

struct PlacedSeries {
  SliceKindFacts facts;
  SlicePlane plane;
  std::vector<PlacedSlice> slices;  // in order of their depths
  std::vector<std::string> notes;   // about images that are left out
};

// The depths that slices lie at, ascending and each once, and the place of every slice among them.
struct Depths {
  std::vector<double> distinct;
  std::vector<std::size_t> of_slice;
};

Depths depths_of(const PlacedSeries& series);

// Throws BadInput where the files cannot hold the samples that the headers speak of: `bytes` of each slice.
void check_sizes(const std::vector<PlacedSlice>& slices, std::uint64_t bytes);

// Throws BadInput where options take another axis for that of slices: DICOM says where its slices lie.
void refuse_slices_from(const OpenOptions& options, const std::string& path);

// Leaves scouts out where most images are of one look, then checks that the slices are parallel and alike.
PlacedSeries place_series(const std::vector<DicomSlice>& series);

}  // namespace isoweave
