// How deep the undecided zone is: what forecasts assume of it.
#pragma once

#include <cmath>

namespace isoweave {

// The depth of the undecided zone, in layers, where a share `left` of the triangles remains, and the further depth in
// the flats of the caps. Both are fits to runs on scans and textures; see docs/memory.md.
inline double undecided_layers(double left) { return 24 * (1 - std::pow(left, 0.45)); }
inline constexpr double kCapDepth = 20;
inline constexpr double kCapWeight = 1.25;  // with what lies beside a cap and waits for it
inline constexpr double kFineDepth = 1.5;   // of the zone with fine quality, over that with normal quality
inline constexpr double kSeenDepth = 4;  // layers: where a thick block has fewer undecided ones, that is what there is

}  // namespace isoweave
