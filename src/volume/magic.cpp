// Tells files by their first bytes, for the readers that a build may lack.
#include "volume/formats.hpp"

namespace isoweave {

bool is_tiff(std::string_view head) {
  for (const std::string_view magic : {std::string_view("II*\0", 4), std::string_view("MM\0*", 4),
                                       std::string_view("II+\0", 4), std::string_view("MM\0+", 4)}) {
    if (head.starts_with(magic)) return true;
  }
  return false;
}

bool is_png(std::string_view head) { return head.starts_with("\x89PNG\r\n\x1a\n"); }

// Behind a preamble of 128 bytes of anything.
bool is_dicom(std::string_view head) {
  constexpr std::size_t kPreamble = 128;
  return head.size() >= kDicomHeadBytes && head.substr(kPreamble, 4) == "DICM";
}

}  // namespace isoweave
