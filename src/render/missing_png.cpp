// Stands in for the writer of pictures in builds without libpng: an error that says which option brings it in.
#include "isoweave/error.hpp"
#include "render/png.hpp"

#ifndef ISOWEAVE_HAS_PNG
namespace isoweave::render {

void require_libpng(const std::string& path) {
  throw CannotWrite(path +
                    ": expected a build with libpng for a picture (CMake option ISOWEAVE_PNG=ON), this one has none");
}

std::vector<std::byte> png_bytes(const Picture&, const std::string& path) {
  require_libpng(path);
  return {};
}

}  // namespace isoweave::render
#endif
