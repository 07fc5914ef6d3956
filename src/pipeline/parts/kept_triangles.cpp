#include "pipeline/parts/kept_triangles.hpp"

#include <cstddef>
#include <cstdint>

namespace isoweave {
namespace {

constexpr std::uint64_t kLeastPart = 24;  // bytes: the numbers of vertices, triangles and vertices of the front

}  // namespace

void KeptTriangles::write(StateWriter& state) {
  least.serialize(state);
  removed.serialize(state);
  state.value(static_cast<std::uint64_t>(parts.size()));
  for (ZonePart& part : parts) write_part(state, part);
}

void KeptTriangles::read(StateReader& state, const PartShape& shape) {
  least.serialize(state);
  removed.serialize(state);
  const std::size_t count = state.count(kLeastPart);
  for (std::size_t n = 0; n < count; ++n) parts.push_back(read_cut_part(state, shape));
}

}  // namespace isoweave
