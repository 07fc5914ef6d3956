// Rectilinear grids, whose samples lie at coordinates along each axis: volumes where these are evenly spaced. Slices
// that are not are treated as those of DICOM.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "volume/even_slices.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {

using GridCoordinates = std::array<std::vector<double>, 3>;  // of the points along x, y and z

// More along an axis are refused.
inline constexpr std::uint64_t kMostCoordinates = std::uint64_t{1} << 24;

// Reads so many coordinates, stored as samples of a type.
std::vector<double> read_coordinates(ByteStream& stream, SampleType type, bool swap_bytes, std::uint64_t count,
                                     const std::string& path);

// The step of evenly spaced coordinates; 1 for a single one.
double even_step(const std::vector<double>& places);

// The first coordinate that lies farther than a hundredth of a step from even ones, or is no number.
std::optional<std::size_t> first_uneven(const std::vector<double>& places);

// Sets dimensions and place of the samples at the points or, of cells, between them. Along an axis with one point the
// spacing is 1, with a note. Throws BadInput where coordinates along x or y lie farther than a hundredth of a step from
// even ones, and what even_grid throws.
EvenGrid place_on_grid(VolumeInfo& info, const GridCoordinates& points, bool cells, const OpenOptions& options);

// Reads the slices on their grid.
void take_even_slices(OpenedVolume& volume, const EvenGrid& grid);

}  // namespace isoweave
