// Lengths on the command line, and whether the unit that they are given in can have been meant.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "isoweave/length.hpp"
#include "isoweave/mesh.hpp"
#include "isoweave/volume.hpp"

namespace isoweave::cli {

// The volume or mesh that lengths belong to. All members but `unit` are in its unit.
struct LengthBasis {
  std::string unit;              // empty: not said, which is mm
  std::array<double, 3> size{};  // of its box
  double diagonal = 0;           // of its box: a length may be a percentage of it
  double least = 0;              // no shape is smaller
  bool is_volume = false;
};

LengthBasis length_basis(const VolumeInfo& volume);
LengthBasis length_basis(const TriangleMesh& mesh);

// Stands for an input that has not been opened, while options are searched for errors.
LengthBasis unknown_basis();

// Parses a length, with the option's name in its message. Refuses lengths that cannot be an error.
Length parse_error_length(std::string_view option, const std::string& text, const LengthBasis& basis);

// Parses a length in the same way, and refuses 0 as well.
Length parse_positive_length(std::string_view option, const std::string& text, const LengthBasis& basis);

// A length as it was given.
struct GivenLength {
  std::string_view option;
  std::string text;  // empty: not given
};

// Says what unit is assumed where the input `path` does not say its own and that matters: where a length is in a metric
// unit, or the output says how large its unit is (`stated`). Warns of each length that is too large or too small for
// the input, unless it is in voxels or in percent: it may be in another unit than was meant.
void tell_lengths(const std::string& path, const std::vector<GivenLength>& lengths, bool stated,
                  const LengthBasis& basis);

}  // namespace isoweave::cli
