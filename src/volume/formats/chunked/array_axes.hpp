// Which axes of an array of any number of dimensions are i, j and k of a volume.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "isoweave/volume.hpp"

namespace isoweave {

struct ArrayAxis {
  std::int64_t size = 1;
  std::string name;  // "x", "z", "channel", ... in any case; empty where the file gives none
};

// More dimensions than this are refused.
inline constexpr std::size_t kMostAxes = 16;
inline constexpr std::size_t kNoAxis = std::numeric_limits<std::size_t>::max();

struct AxisChoice {
  std::array<std::size_t, 3> axis{kNoAxis, kNoAxis, kNoAxis};   // of the array, for i, j and k; kNoAxis: one sample
  std::array<std::size_t, 3> place{kNoAxis, kNoAxis, kNoAxis};  // where headers say their places, see SliceAxis
  std::vector<std::int64_t> at;                                 // index along every axis of the array; 0 along i, j, k
  std::vector<std::string> notes;
  std::string part;  // what was chosen, for VolumeInfo::part

  // Dimensions of the volume.
  std::array<std::int64_t, 3> dims(const std::vector<ArrayAxis>& axes) const;
};

// `axes` from the slowest to the fastest. Axes named x, y, z are i, j, k in whatever order; of axes of channels and of
// time the index in `options` is taken, else the first with a note; any other must have one sample. Axes without names
// are k, j, i; where there are more than three, those of one sample are left out, and --channel and --time say what the
// leading ones are. Throws BadInput naming `path` where that does not leave a volume.
AxisChoice choose_axes(std::vector<ArrayAxis> axes, const OpenOptions& options, std::string_view path);

// Takes the names of dimensions, which files have for their own use (netCDF-4, xarray). Where x and y are among them,
// the one other axis of several samples is that of slices, with a note. Names that leave axes unknown beside x and y
// are left out, with a note.
void take_dimension_names(std::vector<ArrayAxis>& axes, std::vector<ArrayAxis> named, std::vector<std::string>& notes);

}  // namespace isoweave
