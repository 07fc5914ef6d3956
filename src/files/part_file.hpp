// A file that goes with another one, which names it or has the same name but for the ending.
#pragma once

#include <string>
#include <string_view>

#include "files/input_file.hpp"

namespace isoweave {

// Where the file is missing, the message names both: "a.mhd: expected its samples in a.raw, found no such file".
// role: such as "its samples in"
// Throws BadInput as open_file.
void require_part(const std::string& whole, std::string_view role, const std::string& path);
FilePtr open_part(const std::string& whole, std::string_view role, const std::string& path);

}  // namespace isoweave
