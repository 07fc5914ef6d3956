// The digest of a triangle. The digest of a mesh is the sum over its triangles, modulo 2^64.
#include <algorithm>
#include <array>
#include <bit>

#include "isoweave/measure.hpp"
#include "measure/splitmix64.hpp"

namespace isoweave {
namespace {

using CornerBits = std::array<std::uint32_t, 3>;

CornerBits bits_of(const Point& p) {
  CornerBits bits{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // -0 and 0 are the same place, and which of them a sum gives is an accident.
    bits[axis] = p[axis] == 0.0F ? 0U : std::bit_cast<std::uint32_t>(p[axis]);
  }
  return bits;
}

// The chain makes the place of a corner in the triangle matter, so a flipped triangle gets another digest.
std::uint64_t mix_corner(std::uint64_t state, const CornerBits& corner) {
  state = measure::splitmix64(state ^ (std::uint64_t{corner[0]} << 32 | corner[1]));
  return measure::splitmix64(state ^ corner[2]);
}

}  // namespace

std::uint64_t triangle_digest(const Point& a, const Point& b, const Point& c) {
  const CornerBits p = bits_of(a);
  const CornerBits q = bits_of(b);
  const CornerBits r = bits_of(c);
  using Corners = std::array<CornerBits, 3>;
  // The least of the three rotations begins with the smallest corner, and is unique even when two corners are equal.
  const Corners least = std::min({Corners{p, q, r}, Corners{q, r, p}, Corners{r, p, q}});
  std::uint64_t state = 0;
  for (const CornerBits& corner : least) state = mix_corner(state, corner);
  return state;
}

std::string digest_text(std::uint64_t digest) {
  std::string text(16, '0');
  for (std::size_t i = 0; i < 16; ++i) text[i] = "0123456789abcdef"[digest >> (60 - 4 * i) & 15U];
  return text;
}

}  // namespace isoweave
