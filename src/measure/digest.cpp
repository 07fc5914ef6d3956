// The digest of a triangle. The digest of a mesh is the sum over its triangles, modulo 2^64.
#include <algorithm>
#include <array>
#include <bit>
#include <compare>

#include "isoweave/measure.hpp"
#include "lattice/splitmix64.hpp"

namespace isoweave {
namespace {

// The bits of x, y and z, as one number: corners compare as the lists of their coordinates' bits do.
struct CornerBits {
  std::uint64_t xy = 0;
  std::uint64_t z = 0;

  friend bool operator==(const CornerBits&, const CornerBits&) = default;
};

// -0 and 0 are the same place, and which of them a sum gives is an accident.
std::uint64_t bits_of(float x) {
  constexpr std::uint32_t kMinusZero = 0x80000000u;
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return bits == kMinusZero ? 0 : bits;
}

CornerBits bits_of(const Point& p) { return {bits_of(p[0]) << 32 | bits_of(p[1]), bits_of(p[2])}; }

// 1 or 0, without branches: which corner is the smallest cannot be predicted.
std::size_t is_less(const CornerBits& a, const CornerBits& b) {
  return static_cast<std::size_t>(a.xy < b.xy) | (static_cast<std::size_t>(a.xy == b.xy) & (a.z < b.z ? 1U : 0U));
}

// The chain makes the place of a corner in the triangle matter, so a flipped triangle gets another digest.
std::uint64_t mix_corner(std::uint64_t state, const CornerBits& corner) {
  return measure::splitmix64(measure::splitmix64(state ^ corner.xy) ^ corner.z);
}

std::uint64_t mix_corners(const CornerBits& p, const CornerBits& q, const CornerBits& r) {
  return mix_corner(mix_corner(mix_corner(0, p), q), r);
}

// A corner with coordinates of 64 bits each.
struct WideCornerBits {
  std::array<std::uint64_t, 3> bits{};

  friend bool operator==(const WideCornerBits&, const WideCornerBits&) = default;
  friend bool operator<(const WideCornerBits& a, const WideCornerBits& b) {
    return std::lexicographical_compare(a.bits.begin(), a.bits.end(), b.bits.begin(), b.bits.end());
  }
};

WideCornerBits bits_of(const Point& p, const std::array<double, 3>& offset) {
  WideCornerBits corner;
  // Adding 0 turns -0 into 0.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    corner.bits[axis] = std::bit_cast<std::uint64_t>(offset[axis] + double{p[axis]} + 0.0);
  }
  return corner;
}

std::uint64_t mix_corners(const std::array<WideCornerBits, 3>& corners, std::size_t first) {
  std::uint64_t state = 0;
  for (std::size_t n = first; n < first + 3; ++n) {
    for (const std::uint64_t bits : corners[n % 3].bits) state = measure::splitmix64(state ^ bits);
  }
  return state;
}

}  // namespace

// The digest is that of the rotation that begins with the smallest corner. Where two corners are equal and smallest, it
// is the rotation that has them first.
std::uint64_t triangle_digest(const Point& a, const Point& b, const Point& c) {
  const std::array<CornerBits, 3> corners{bits_of(a), bits_of(b), bits_of(c)};
  std::size_t first = is_less(corners[1], corners[0]);
  first += (2 - first) * is_less(corners[2], corners[first]);
  const std::size_t second = first < 2 ? first + 1 : 0;
  const std::size_t third = first > 0 ? first - 1 : 2;
  if (corners[third] == corners[first]) return mix_corners(corners[third], corners[first], corners[second]);
  return mix_corners(corners[first], corners[second], corners[third]);
}

std::uint64_t triangle_digest(const Point& a, const Point& b, const Point& c, const std::array<double, 3>& offset) {
  if (offset == std::array<double, 3>{0, 0, 0}) return triangle_digest(a, b, c);
  const std::array<WideCornerBits, 3> corners{bits_of(a, offset), bits_of(b, offset), bits_of(c, offset)};
  std::size_t first = corners[1] < corners[0] ? 1 : 0;
  if (corners[2] < corners[first]) first = 2;
  const std::size_t before = (first + 2) % 3;
  return mix_corners(corners, corners[before] == corners[first] ? before : first);
}

std::string digest_text(std::uint64_t digest) {
  std::string text(16, '0');
  for (std::size_t i = 0; i < 16; ++i) text[i] = "0123456789abcdef"[digest >> (60 - 4 * i) & 15U];
  return text;
}

}  // namespace isoweave
