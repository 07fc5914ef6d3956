#include "pipeline/component_slabs.hpp"

#include <stdexcept>

namespace isoweave {

std::int64_t ComponentSlabs::extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                                     MeshReport& report) {
  const std::int64_t extracted = extractor_.extract(window, layers, piece_, most_vertices);
  report.triangles_extracted += piece_.triangles.size();
  return extracted;
}

void ComponentSlabs::simplify(SlabRecord& record) {
  record.live_triangles = piece_.triangles.size();
  finder_.take(piece_);
}

void ComponentSlabs::exchange(StateWriter&) { throw std::logic_error("a search for components is not saved"); }

void ComponentSlabs::exchange(StateReader&) { throw std::logic_error("a search for components is not saved"); }

}  // namespace isoweave
