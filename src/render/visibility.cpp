#include "render/visibility.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace isoweave::render {
namespace {

constexpr std::int64_t kProjectedPerBlock = 1024;

// The samples whose middle lies between two places in the frame, and no fewer for rounding.
struct Interval {
  std::int64_t first, end;
};

Interval samples_between(double low, double high, std::int64_t count) {
  constexpr double kSlack = 1e-6;
  const double most = static_cast<double>(count);
  return {static_cast<std::int64_t>(std::ceil(std::clamp(low - 0.5 - kSlack, 0.0, most))),
          static_cast<std::int64_t>(std::floor(std::clamp(high + 0.5 + kSlack, 0.0, most)))};
}

// A word that orders samples by distance: distances are positive, so their bits are in their order.
std::uint64_t word_of(double distance, std::uint32_t triangle) {
  return std::uint64_t{std::bit_cast<std::uint32_t>(static_cast<float>(distance))} << 32U | triangle;
}

}  // namespace

SeenTriangle::SeenTriangle(const TriangleMesh& mesh, std::uint32_t triangle, const Camera& camera) {
  const auto& t = mesh.triangles[triangle];
  for (std::size_t n = 0; n < 3; ++n) corners[n] = camera.placed(mesh.vertices[t[n]]);
  for (std::size_t n = 0; n < 3; ++n) sides[n] = cross(corners[(n + 1) % 3], corners[(n + 2) % 3]);
}

Visibility::Visibility(const TriangleMesh& mesh, const Camera& camera, const Executor& executor)
    : columns_(camera.columns()), words_(static_cast<std::size_t>(camera.columns() * camera.rows()), kNothing) {
  executor.for_each(static_cast<std::int64_t>(mesh.triangles.size()), kProjectedPerBlock, [&](std::int64_t n) {
    const auto triangle = static_cast<std::uint32_t>(n);
    draw(SeenTriangle(mesh, triangle, camera), triangle, camera);
  });
}

// Draws a triangle: tests every sample in its box.
void Visibility::draw(const SeenTriangle& seen, std::uint32_t triangle, const Camera& camera) {
  const auto& [a, b, c] = seen.corners;
  const auto [left, right] = std::minmax({camera.column_of(a), camera.column_of(b), camera.column_of(c)});
  const auto [top, bottom] = std::minmax({camera.row_of(a), camera.row_of(b), camera.row_of(c)});
  const Interval columns = samples_between(left, right, camera.columns());
  const Interval rows = samples_between(top, bottom, camera.rows());
  for (std::int64_t row = rows.first; row < rows.end; ++row) {
    for (std::int64_t column = columns.first; column < columns.end; ++column) {
      const Vec3 w = seen.weights(camera.ray(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5));
      const double sum = w.x + w.y + w.z;
      if (!all_of_one_sign(w) || sum == 0) continue;
      offer(column, row, word_of((w.x * a.z + w.y * b.z + w.z * c.z) / sum, triangle));
    }
  }
}

void Visibility::offer(std::int64_t column, std::int64_t row, std::uint64_t word) {
  const std::atomic_ref place(words_[static_cast<std::size_t>(row * columns_ + column)]);
  std::uint64_t nearest = place.load(std::memory_order_relaxed);
  while (word < nearest && !place.compare_exchange_weak(nearest, word, std::memory_order_relaxed)) continue;
}

}  // namespace isoweave::render
