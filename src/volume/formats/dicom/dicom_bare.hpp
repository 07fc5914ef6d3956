// DICOM data sets that nothing announces: without preamble, magic, and perhaps the group that says how they are
// written.
#pragma once

#include <string_view>

namespace isoweave {

// Whether these bytes, the first of a file, begin as DICOM elements do in a file without preamble and magic.
bool is_bare_dicom(std::string_view head);

// The transfer syntax (UID) in which these bytes read as the first elements of a data set: implicit or explicit
// little-endian, or explicit big-endian. Empty when they do in none.
std::string_view told_syntax(std::string_view data);

}  // namespace isoweave
