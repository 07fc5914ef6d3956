#include <cstddef>
#include <vector>

#include "files/atomic_file.hpp"
#include "isoweave/render.hpp"
#include "render/png.hpp"

namespace isoweave {

void require_png(const std::string& path) {
  render::require_libpng(path);
  const AtomicFile tried(path);
}

void write_png(const std::string& path, const Picture& picture) {
  const std::vector<std::byte> bytes = render::png_bytes(picture, path);
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace isoweave
