// The pages of a TIFF file: which of them are slices, and what must be the same on all.
#pragma once

#include <cstdint>
#include <vector>

#include "isoweave/volume.hpp"
#include "volume/formats/images/tiff_file.hpp"
#include "volume/half_floats.hpp"

namespace isoweave {

// The facts that must be the same on all pages.
struct TiffPageKind {
  std::int64_t width = 0;
  std::int64_t height = 0;
  StoredType type;

  bool operator==(const TiffPageKind&) const = default;
};

// The slices of a file that is one page after another.
struct TiffPages {
  TiffPageKind kind;
  std::vector<std::uint64_t> offsets;  // of their directories
  std::vector<std::int64_t> numbers;   // of their directories, in the order of the file
  std::int64_t left_out = 0;           // masks and smaller copies
};

// Looks at every directory, so that a page that does not fit the others is found now. Throws BadInput for pages that
// are not grey, of a type that is not read, or do not lie in the file.
TiffPages find_tiff_pages(TiffFile& tiff);

// How many bytes one stored byte can become.
std::uint64_t largest_tiff_ratio(std::uint16_t compression);

}  // namespace isoweave
