#include "render/colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace isoweave::render {
namespace {

double linear(std::uint8_t byte) {
  const double x = byte / 255.0;
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

// Every ninth of the map. Straight lines between these colours are less than two steps of 255 away from it.
constexpr std::array<Colour, 10> kViridis{{{68, 1, 84},
                                           {72, 40, 120},
                                           {62, 74, 137},
                                           {49, 104, 142},
                                           {38, 130, 142},
                                           {31, 158, 137},
                                           {53, 183, 121},
                                           {109, 205, 89},
                                           {180, 222, 44},
                                           {253, 231, 37}}};

}  // namespace

Vec3 light_of(const Colour& colour) { return {linear(colour.red), linear(colour.green), linear(colour.blue)}; }

std::uint8_t byte_of_light(double light) {
  const double x = light > 0 ? std::min(light, 1.0) : 0;  // also where normals of the mesh are no numbers
  const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

Vec3 viridis(double place) {
  const double ninths = 9 * std::clamp(place, 0.0, 1.0);
  const auto before = std::min<std::size_t>(static_cast<std::size_t>(ninths), 8);
  const double part = ninths - static_cast<double>(before);
  const auto between = [&](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround((1 - part) * a + part * b));
  };
  const Colour& a = kViridis[before];
  const Colour& b = kViridis[before + 1];
  return light_of({between(a.red, b.red), between(a.green, b.green), between(a.blue, b.blue)});
}

}  // namespace isoweave::render
