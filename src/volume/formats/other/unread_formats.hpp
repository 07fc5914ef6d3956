// Files that are no volume that can be read: what they are, and the way round.
#pragma once

#include <string>
#include <string_view>

namespace isoweave {

// "a JPEG image: slices in PNG or TIFF are read", by the first bytes of a file and then by its name; "text" or "other
// content" where nothing is known.
std::string what_else(std::string_view head, std::string_view path);

// Bytes of a file that what_else looks at.
inline constexpr std::size_t kWhatElseBytes = 1024;

}  // namespace isoweave
