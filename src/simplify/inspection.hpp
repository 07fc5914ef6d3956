// The inspection of final vertices for defects of the surface.
#pragma once

#include <cstdint>
#include <span>

#include "parallel/parallel.hpp"
#include "simplify/simplify_totals.hpp"
#include "simplify/zone_view.hpp"

namespace isoweave {

// Counts the defects around vertices that can be walked: the faces that name a vertex must be the one fan that a walk
// around it finds, and its neighbours must differ. An edge counts at its end with the smaller index. corners: for every
// vertex of the zone, the triangles that name it.
SurfaceDefects inspect_fans(const ZoneView& zone, std::span<const Index> vertices,
                            std::span<const std::uint32_t> corners, const Executor& executor);

}  // namespace isoweave
