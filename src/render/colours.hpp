// Colours in light: linear, as amounts that add up, and the map from numbers to them.
#pragma once

#include <cstdint>

#include "isoweave/render.hpp"
#include "lattice/vec3.hpp"

namespace isoweave::render {

// The linear light of a colour: red, green, blue in [0, 1], by the transfer function of sRGB (IEC 61966-2-1).
Vec3 light_of(const Colour& colour);
std::uint8_t byte_of_light(double light);

// The colour of viridis at a place in [0, 1].
Vec3 viridis(double place);

}  // namespace isoweave::render
