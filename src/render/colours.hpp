// Colours in light: linear, as amounts that add up, and the map from numbers to them.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "isoweave/render.hpp"
#include "lattice/vec3.hpp"

namespace isoweave::render {

// Red, green, blue in [0, 1] of linear light, by the transfer function of sRGB (IEC 61966-2-1).
Vec3 light_of(const Colour& colour);
std::uint8_t byte_of_light(double light);

// The least and the largest of the finite numbers; the first larger than the second where there are none.
std::array<double, 2> finite_range(std::span<const float> numbers);

// Viridis at a place in [0, 1].
Vec3 viridis(double place);

}  // namespace isoweave::render
