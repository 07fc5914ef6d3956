#include "simplify/reach.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "simplify/extracted_surface.hpp"
#include "simplify/overlay.hpp"

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

// Bounds the faces by those that they replace, where these are known to lie above each other.
void bound_by_overlay(const ZoneView& zone, const Star& u, const Star& v, const Vec3& place, FaceBounds& bounds) {
  if (!u.border && !v.border && Overlay(zone, u, v, place).bound(bounds)) return;
  bounds.fill({std::numeric_limits<double>::infinity(), kBoundUnits, kBoundUnits});
}

// Whether a look at a face with such a bound would find it within the distance.
bool is_sure(const FaceBound& bound) { return bound.most() <= ExtractedSurface::kSure * kBoundUnits; }

// Whether some point of a face of which nothing is known is beyond the distance: a few are looked at, by which most
// faces that are refused are found out. They are farther beyond than rounding goes, so a look at the whole face would
// say the same. None of them is on the ring around the stars, which lies on faces that are within the distance.
bool is_plainly_beyond(const ZoneView& zone, const Star& u, const Star& v, const Vec3& place,
                       const FaceBounds& bounds) {
  const auto is_beyond = [&](const Vec3& p) {
    return zone.extracted->is_beyond(p, (1 + 1e-9) * zone.options.most_distance);
  };
  bool beyond = false;
  bool is_first = true;
  std::size_t n = 0;
  each_staying_face(u, v, [&](Index, Index from, Index to) {
    if (is_sure(bounds[n++])) return true;
    const Vec3& a = zone.vertices[from].position;
    const Vec3& b = zone.vertices[to].position;
    beyond = (std::exchange(is_first, false) && is_beyond(place)) || is_beyond((1.0 / 3) * (place + a + b)) ||
             is_beyond(0.5 * (place + a));
    return !beyond;
  });
  return beyond;
}

// Looks at a face. bound: where it is within the distance, a bound for all of it.
Reach look_at_face(const ZoneView& zone, const Vec3& a, const Vec3& b, const Vec3& c, FaceBound& bound) {
  ExtractedSurface::Looked looked;
  const Reach reach = zone.extracted->reach(a, b, c, zone.options.most_distance, &looked);
  const double farthest = looked.farthest / zone.options.most_distance * kBoundUnits;
  bound = {farthest, farthest, farthest};
  return reach;
}

}  // namespace

Reach reach_of_collapse(const ZoneView& zone, const Star& u, const Star& v, const Vec3& place, CostBits cost,
                        FaceBounds& bounds) {
  if (!stays_in_layers(zone, u, v, place)) return Reach::kBeyond;
  bound_by_overlay(zone, u, v, place, bounds);
  const bool is_doubtful = cost > to_cost(zone.options.most_distance * zone.options.most_distance / zone.options.a0);
  if (is_doubtful && is_plainly_beyond(zone, u, v, place, bounds)) return Reach::kBeyond;
  Reach all = Reach::kWithin;
  std::size_t n = 0;
  each_staying_face(u, v, [&](Index, Index a, Index b) {
    FaceBound& bound = bounds[n++];
    if (is_sure(bound)) return true;
    const Reach face = look_at_face(zone, place, zone.vertices[a].position, zone.vertices[b].position, bound);
    all = std::max(all, face);
    return face != Reach::kBeyond;
  });
  return all;
}

}  // namespace isoweave
