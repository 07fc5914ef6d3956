// Which triangle each sample of the frame shows.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "parallel/parallel.hpp"
#include "render/camera.hpp"

namespace isoweave::render {

// The corners of a triangle in camera coordinates, and the sides that weigh them for rays: Olano, Greer 1997, "Triangle
// scan conversion using 2D homogeneous coordinates".
struct SeenTriangle {
  SeenTriangle(const TriangleMesh& mesh, std::uint32_t triangle, const Camera& camera);

  // The weights of the corners where the ray meets the plane, not yet divided by their sum. Inside the triangle they
  // have the same sign. A side gives the same number, but for the sign, to both of its triangles, so there are no gaps.
  Vec3 weights(const Vec3& ray) const { return {dot(sides[0], ray), dot(sides[1], ray), dot(sides[2], ray)}; }

  std::array<Vec3, 3> corners;
  std::array<Vec3, 3> sides;  // side n is across from corner n: the normal of its plane with the eye
};

inline bool all_of_one_sign(const Vec3& w) {
  return (w.x >= 0 && w.y >= 0 && w.z >= 0) || (w.x <= 0 && w.y <= 0 && w.z <= 0);
}

// For each sample, the distance z and the number of the nearest triangle in one word. The nearest is the least word,
// whichever thread comes first.
class Visibility {
 public:
  Visibility(const TriangleMesh& mesh, const Camera& camera, const Executor& executor);

  static constexpr std::uint64_t kNothing = ~std::uint64_t{0};

  std::uint64_t at(std::int64_t column, std::int64_t row) const {
    return words_[static_cast<std::size_t>(row * columns_ + column)];
  }
  static std::uint32_t triangle_of(std::uint64_t word) { return static_cast<std::uint32_t>(word); }
  static double distance_of(std::uint64_t word) {
    return double{std::bit_cast<float>(static_cast<std::uint32_t>(word >> 32U))};
  }

 private:
  void draw(const SeenTriangle& seen, std::uint32_t triangle, const Camera& camera);
  void offer(std::int64_t column, std::int64_t row, std::uint64_t word);

  std::int64_t columns_;
  std::vector<std::uint64_t> words_;
};

}  // namespace isoweave::render
