#include "simplify/reach.hpp"

#include <algorithm>

#include "simplify/extracted_surface.hpp"

namespace isoweave {
namespace {

// Whether a place lies in the layers of cells that the stars are in. No vertex leaves these layers, so no held triangle
// ever sinks below the lowest layer held before, and the surface farther down can be forgotten.
bool stays_in_layers(const ZoneView& zone, const Star& u, const Star& v, const Vec3& place) {
  double low = zone.vertices[u.vertex].position.z;
  double high = low;
  for (const Star* star : {&u, &v}) {
    for (std::size_t n = 0; n < star->count(); ++n) {
      const double z = zone.vertices[star->neighbour[n]].position.z;
      low = std::min(low, z);
      high = std::max(high, z);
    }
  }
  const ExtractedSurface& extracted = *zone.extracted;
  const double layer = extracted.layer_of(place.z);
  return layer >= extracted.layer_of(low) && layer <= extracted.layer_of(high);
}

}  // namespace

Reach reach_of_collapse(const ZoneView& zone, const Star& u, const Star& v, const Vec3& place) {
  const ExtractedSurface& extracted = *zone.extracted;
  if (!stays_in_layers(zone, u, v, place)) return Reach::kBeyond;
  Reach all = Reach::kWithin;
  for (const Star* star : {&u, &v}) {
    const Index gone = star == &u ? v.vertex : u.vertex;
    for (std::size_t n = 0; n < static_cast<std::size_t>(star->faces); ++n) {
      const Index a = star->neighbour[n];
      const Index b = star->neighbour[n + 1 < star->count() ? n + 1 : 0];
      if (a == gone || b == gone) continue;
      const Reach face = extracted.reach(place, zone.vertices[a].position, zone.vertices[b].position);
      if (face == Reach::kBeyond) return face;
      if (face == Reach::kUnknown) all = face;
    }
  }
  return all;
}

}  // namespace isoweave
