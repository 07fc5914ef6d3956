// Lengths in options: in voxels, or in the unit of what is meshed.
#pragma once

#include <string_view>

#pragma GCC visibility push(default)
namespace isoweave {

// A length. Voxels: of a volume the mean side of one, of a mesh the square root of twice the mean triangle area.
struct Length {
  double value = 0;
  bool in_voxels = false;  // else in the volume's or the mesh's own unit

  static constexpr Length voxels(double value) { return {value, true}; }
  static constexpr Length units(double value) { return {value, false}; }
};

// Parses "0.2vox", "0.05mm", "30um", "500nm", "0.01in" or "0.05" (the volume's own unit). Units are spelled in any way
// that volumes spell them. Their lengths are converted to `unit` ("mm" where the volume does not say). Throws
// std::invalid_argument naming the text.
Length parse_length(std::string_view text, std::string_view unit);

}  // namespace isoweave
#pragma GCC visibility pop
