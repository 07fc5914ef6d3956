// Stands in for the readers whose libraries the build lacks: an error that says which option brings them in.
#include "volume/formats.hpp"

namespace isoweave {
namespace {

#if !defined(ISOWEAVE_HAS_TIFF) || !defined(ISOWEAVE_HAS_PNG)
[[noreturn]] void not_built(const FilePtr& file, std::string_view format, std::string_view library,
                            std::string_view option) {
  bad_input(
      file->path(), "a format of this build",
      std::string(format) + ", which needs " + std::string(library) + " (CMake option " + std::string(option) + "=ON)");
}
#endif

}  // namespace

#ifndef ISOWEAVE_HAS_TIFF
OpenedVolume open_tiff(const FilePtr& file, bool) { not_built(file, "TIFF", "libtiff", "ISOWEAVE_TIFF"); }
#endif

#ifndef ISOWEAVE_HAS_PNG
OpenedVolume open_png(const FilePtr& file) { not_built(file, "PNG", "libpng", "ISOWEAVE_PNG"); }
#endif

}  // namespace isoweave
