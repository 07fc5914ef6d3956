// Lengths in options: in voxels, or in the unit of the volume or mesh.
#pragma once

#include <optional>
#include <string_view>

#pragma GCC visibility push(default)
namespace isoweave {

// A length. A voxel is the mean side of a volume's voxels; for a mesh it is the square root of twice the mean triangle
// area.
struct Length {
  double value = 0;
  bool in_voxels = false;  // else in the volume's or the mesh's own unit

  static constexpr Length voxels(double value) { return {value, true}; }
  static constexpr Length units(double value) { return {value, false}; }
};

// Parses "0.2vox", "0.05mm", "30um", "500nm", "0.01in" or "0.05", a length in `unit`. Units may be spelled as in volume
// files. A length in another unit is converted to `unit`; an empty `unit` stands for "mm". "0.1%" is that part of
// `diagonal`, which is in `unit`: that of a box_diagonal().
// @throws std::invalid_argument naming the text, for a number that is negative or not finite, for a unit that is not
//   known, and for a percentage where no diagonal is given
Length parse_length(std::string_view text, std::string_view unit, std::optional<double> diagonal = std::nullopt);

}  // namespace isoweave
#pragma GCC visibility pop
