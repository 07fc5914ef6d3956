// Files that a header names, and links that lead out of a folder: whoever wrote them may be a stranger.
#pragma once

#include <string>
#include <string_view>

#include "isoweave/volume.hpp"

namespace isoweave {

// To be called before the file `name`, which the header `path` names, is opened. Throws BadInput where headers may name
// no other files (OpenOptions::external).
void check_external(const OpenOptions& options, std::string_view path, std::string_view name);

// Throws BadInput for a file of a folder that is a link out of it, or lies behind one.
void check_within(const std::string& path, const std::string& folder);

}  // namespace isoweave
