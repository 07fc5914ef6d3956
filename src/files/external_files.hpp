// Files that a header names, and links that lead out of a folder. The header may come from a stranger.
#pragma once

#include <string>
#include <string_view>

#include "isoweave/volume.hpp"

namespace isoweave {

// Must be called before opening the file `name`, which the header `path` names. Throws BadInput where headers may name
// no other files (OpenOptions::external).
void check_external(const OpenOptions& options, std::string_view path, std::string_view name);

// Throws BadInput for a file of a folder that is a link out of it, or lies behind one.
void check_within(const std::string& path, const std::string& folder);

}  // namespace isoweave
