#include "mesh/read/mesh_place.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <utility>

#include "files/length_units.hpp"
#include "lattice/triangles.hpp"
#include "mesh/read/mesh_input.hpp"

namespace isoweave::mesh_io {
namespace {

using measure::operator-;
using Triangle = std::array<std::uint32_t, 3>;

constexpr std::size_t kShown = 40;          // characters of a value that a note quotes
constexpr double kPartOfLength = 1e-3;      // of a triangle's size that rounding may move a vertex by
constexpr double kWorthAnOffset = 1.0 / 4;  // of the rounding that may be left: less than two bits are not worth it

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

// The name that a mesh has for a space or unit, which programs write in several ways. Empty where it has none.
std::string known_space(std::string_view value) {
  const std::string name = lower_case(value);
  if (name == "lps" || name == "left-posterior-superior") return "LPS";
  if (name == "ras" || name == "right-anterior-superior") return "RAS";
  return name == "index" ? name : "";
}

// The unit of a mesh, as numbers are kept as they are. A unit that they would have to be converted from is not taken.
std::string known_unit(std::string_view value) {
  const std::optional<LengthUnit> unit = find_length_unit(value);
  return unit && unit->scale == 1 ? std::string(unit->name) : "";
}

// The farthest that rounding to 32 bits moves a coordinate. Infinite where the float is.
double move_of(const WidePoint& point, const WidePoint& offset) {
  double farthest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = point[axis] - offset[axis];
    const bool fits = std::abs(at) <= double{std::numeric_limits<float>::max()};
    const double move = fits ? std::abs(at - double{static_cast<float>(at)}) : std::numeric_limits<double>::infinity();
    farthest = std::max(farthest, move);
  }
  return farthest;
}

struct Moves {
  double sum = 0, farthest = 0;
};

// The moves of the corners of all triangles. Vertices that no triangle names may lie anywhere.
Moves moves_of(std::span<const WidePoint> points, std::span<const Triangle> triangles, const WidePoint& offset) {
  Moves moves;
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t v : triangle) {
      const double move = move_of(points[v], offset);
      moves.sum += move;
      moves.farthest = std::max(moves.farthest, move);
    }
  }
  return moves;
}

// The root of twice the mean area.
double size_of(std::span<const WidePoint> points, std::span<const Triangle> triangles) {
  double area = 0;
  for (const Triangle& t : triangles) area += measure::area_of({points[t[0]], points[t[1]], points[t[2]]});
  return std::sqrt(2 * area / static_cast<double>(triangles.size()));
}

// An offset near the middle of the box: a multiple of a power of two which is at least an eighth of the longest side.
// So it has few digits, and coordinates are subtracted from it without rounding.
WidePoint rounded_middle(std::span<const WidePoint> points, std::span<const Triangle> triangles) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  WidePoint low{kInfinity, kInfinity, kInfinity};
  WidePoint high{-kInfinity, -kInfinity, -kInfinity};
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t v : triangle) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], points[v][axis]);
        high[axis] = std::max(high[axis], points[v][axis]);
      }
    }
  }
  const WidePoint sides = high - low;
  const double step = std::exp2(std::ceil(std::log2(std::max({sides[0], sides[1], sides[2]}))) - 3);
  WidePoint middle{};
  for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] = std::round((low[axis] + high[axis]) / 2 / step) * step;
  return middle;
}

std::string move_note(double farthest, double size) {
  std::ostringstream text;
  text.precision(3);
  text << "coordinates were rounded to 32 bits, which moves vertices by up to " << farthest << ", " << farthest / size
       << " of the root of twice the mean triangle area";
  return text.str();
}

}  // namespace

void MeshPlace::take_comment(std::string_view comment) {
  constexpr std::string_view kBetween = " \t\r;";
  while (!comment.empty()) {
    const std::string_view word = comment.substr(0, comment.find_first_of(kBetween));
    comment.remove_prefix(std::min(comment.size(), word.size() + 1));
    const std::size_t equals = word.find('=');
    if (equals != std::string_view::npos) take(word.substr(0, equals), word.substr(equals + 1));
  }
}

void MeshPlace::take(std::string_view name, std::string_view value) {
  if (value.empty()) return;
  if (name == "SPACE") take_known(space_, name, value, known_space(value));
  if (name == "UNIT") take_known(unit_, name, value, known_unit(value));
  if (name == "OFFSET" && !offset_) offset_ = parse_offset(value);
}

void MeshPlace::take_known(std::string& field, std::string_view name, std::string_view value, std::string_view known) {
  const std::string shown = std::string(name) + "=" + std::string(value.substr(0, kShown));
  if (known.empty()) {
    notes_.push_back("says " + shown + ", which is not known and not kept");
  } else if (field.empty()) {
    field = known;
  } else if (field != known) {
    notes_.push_back("says " + std::string(name) + "=" + field + " and " + shown + ": the first is taken");
  }
}

void MeshPlace::put_into(TriangleMesh& mesh) const {
  mesh.space = space_;
  mesh.unit = unit_;
  mesh.notes.insert(mesh.notes.end(), notes_.begin(), notes_.end());
}

std::optional<WidePoint> parse_offset(std::string_view text) {
  WidePoint offset{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string_view number = text.substr(0, axis < 2 ? text.find(',') : text.size());
    const std::optional<double> value = parse_real<double>(number);
    if (!value || !std::isfinite(*value)) return std::nullopt;
    offset[axis] = *value;
    text.remove_prefix(std::min(text.size(), number.size() + 1));
  }
  return offset;
}

// Rounding twice is rounding once unless the double lies in the middle between two floats, which 29 bits tell. Then the
// float nearest to the text says on which side of the middle the text lies. Where floats are not normal, and beyond the
// largest one, that float is taken as it is.
std::optional<double> parse_wide(std::string_view text) {
  const std::optional<double> value = parse_real<double>(text);
  if (!value || !std::isfinite(*value)) return std::nullopt;
  constexpr std::uint64_t kLowBits = 0x1fffffff, kMiddle = 0x10000000;
  const double size = std::abs(*value);
  const bool is_between = (std::bit_cast<std::uint64_t>(*value) & kLowBits) == kMiddle;
  const bool is_small = size < double{std::numeric_limits<float>::min()} && size > 0;
  if (!is_between && !is_small && size <= double{std::numeric_limits<float>::max()}) return value;
  const std::optional<float> nearest = parse_real<float>(text);
  if (!nearest || !std::isfinite(*nearest)) return std::nullopt;
  if (!is_between || is_small) return *nearest;
  return static_cast<float>(*value) == *nearest ? *value : std::nextafter(*value, double{*nearest});
}

WidePoint offset_for(std::span<const WidePoint> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                     const std::optional<WidePoint>& named, std::vector<std::string>& notes) {
  const WidePoint none{0, 0, 0};
  if (triangles.empty()) return none;
  const Moves moves = moves_of(points, triangles, none);
  if (named && *named != none && moves_of(points, triangles, *named).farthest <= moves.farthest) return *named;
  if (moves.farthest == 0) return none;
  const double size = size_of(points, triangles);
  if (!(size > 0) || !std::isfinite(size) || moves.farthest <= kPartOfLength * size) return none;
  const WidePoint middle = rounded_middle(points, triangles);
  const Moves left = moves_of(points, triangles, middle);
  const bool helps = left.sum < kWorthAnOffset * moves.sum;
  const double farthest = helps ? left.farthest : moves.farthest;
  if (farthest > kPartOfLength * size) notes.push_back(move_note(farthest, size));
  return helps ? middle : none;
}

// Coordinates of 64 bits come back from a file whose offset is known. Let o be the offset, c a coordinate that was
// written as d, the sum o + c rounded to 64 bits, and u the last place of d. From 2^25 u on c comes back: d - o is off
// from it by less than a quarter of its last place. A smaller c may come back as another number, but as one whose sum
// with o is d again. There o and d are so close that d - o is exact (Sterbenz 1974), a multiple of u / 2. Below 2^23 u
// it fits into the 24 bits of a float, so that the sum is d without rounding. Above, c and d are multiples of u: d - o
// is c, or, where o is an odd multiple of u / 2, the middle between two floats, and the sum of o and either of them is
// d or the middle between d and an odd multiple of u, which is rounded to the even one, d. So the sums are always the
// same, and with them the digest, and the file that is written anew.
Point relative_point(const WidePoint& point, const WidePoint& offset) {
  return {static_cast<float>(point[0] - offset[0]), static_cast<float>(point[1] - offset[1]),
          static_cast<float>(point[2] - offset[2])};
}

void set_vertices(TriangleMesh& mesh, std::span<const WidePoint> points, const std::optional<WidePoint>& named) {
  mesh.offset = offset_for(points, mesh.triangles, named, mesh.notes);
  mesh.vertices.resize(points.size());
  std::transform(points.begin(), points.end(), mesh.vertices.begin(),
                 [&](const WidePoint& point) { return relative_point(point, mesh.offset); });
}

}  // namespace isoweave::mesh_io
