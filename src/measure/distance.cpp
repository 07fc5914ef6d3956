// Distance between two surfaces: points spread over each by area, exact distances to the other.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "isoweave/measure.hpp"
#include "lattice/splitmix64.hpp"
#include "lattice/triangles.hpp"
#include "measure/triangle_tree.hpp"
#include "parallel/float_environment.hpp"
#include "parallel/parallel.hpp"
#include "parallel/size.hpp"

namespace isoweave {
namespace {

using measure::operator*;
using measure::operator+;
using measure::operator-;
using measure::Vector;

constexpr std::int64_t kSamplesPerBlock = 1024;

// Samples a surface: point i of n lies in the i-th of n parts of equal area, in the order of the triangles. So points
// with neighbouring numbers are neighbours on the surface, and every part of the surface is met. Points are pure
// functions of (seed, i).
class AreaSampler {
 public:
  AreaSampler(const TriangleMesh& mesh, const DistanceOptions& options)
      : mesh_(mesh), samples_(options.samples), key_(measure::splitmix64(options.seed)) {
    cumulative_.reserve(mesh.triangles.size());
    double total = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      total += measure::area_of(measure::corners_of(mesh, t));
      cumulative_.push_back(total);
    }
    // In a mesh without area all triangles count alike: they still lie somewhere.
    if (!(total > 0) || !std::isfinite(total)) std::iota(cumulative_.begin(), cumulative_.end(), 1.0);
  }

  Vector point(std::uint64_t i) const {
    const double part = (static_cast<double>(i) + uniform(3 * i)) / static_cast<double>(samples_);
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), part * cumulative_.back());
    const std::size_t last = cumulative_.size() - 1;
    const std::size_t triangle = std::min(last, static_cast<std::size_t>(found - cumulative_.begin()));
    const measure::TriangleCorners c = measure::corners_of(mesh_, triangle);
    // The root spreads points evenly between a corner, where the triangle is narrow, and the side across.
    const double across = std::sqrt(uniform(3 * i + 1));
    const double along = uniform(3 * i + 2);
    return c[0] + (across * (1 - along)) * (c[1] - c[0]) + (across * along) * (c[2] - c[0]);
  }

 private:
  // A number in [0, 1).
  double uniform(std::uint64_t counter) const {
    return static_cast<double>(measure::splitmix64(key_ + counter) >> 11U) * 0x1p-53;
  }

  const TriangleMesh& mesh_;
  std::uint64_t samples_;
  std::uint64_t key_;
  std::vector<double> cumulative_;
};

struct Sums {
  double distance = 0, squared = 0, max = 0;
};

// Calls keep(i, distance) for every sample.
template <class Keep>
Sums block_sums(const AreaSampler& sampler, const measure::TriangleTree& tree, std::int64_t begin, std::int64_t end,
                const Keep& keep) {
  Sums sums;
  std::size_t hint = measure::TriangleTree::kNoHint;
  for (std::int64_t i = begin; i < end; ++i) {
    const double squared = tree.squared_distance_from(sampler.point(static_cast<std::uint64_t>(i)), hint);
    const double distance = std::sqrt(squared);
    sums.distance += distance;
    sums.squared += squared;
    sums.max = std::max(sums.max, distance);
    keep(i, distance);
  }
  return sums;
}

// Measures the distances one way. Blocks are fixed and their sums are added in the order of the blocks, so the result
// is the same for any number of threads. Fills `distances`, of all samples, where histograms are wanted.
OneWayDistance one_way(const TriangleMesh& from, const TriangleMesh& to, const DistanceOptions& options,
                       const Executor& executor, std::vector<double>& distances) {
  const AreaSampler sampler(from, options);
  const measure::TriangleTree tree(to, executor);
  const std::int64_t samples = static_cast<std::int64_t>(options.samples);
  std::vector<Sums> blocks(to_size((samples + kSamplesPerBlock - 1) / kSamplesPerBlock));
  distances.resize(options.bins > 0 ? to_size(options.samples) : 0);
  executor.for_blocks(samples, kSamplesPerBlock, [&](std::int64_t begin, std::int64_t end) {
    blocks[static_cast<std::size_t>(begin / kSamplesPerBlock)] =
        block_sums(sampler, tree, begin, end, [&](std::int64_t i, double distance) {
          if (!distances.empty()) distances[static_cast<std::size_t>(i)] = distance;
        });
  });
  Sums total;
  for (const Sums& block : blocks) {
    total.distance += block.distance;
    total.squared += block.squared;
    total.max = std::max(total.max, block.max);
  }
  const double count = static_cast<double>(samples);
  return {total.distance / count, std::sqrt(total.squared / count), total.max, {}};
}

std::vector<std::uint64_t> histogram_of(const std::vector<double>& distances, std::size_t bins, double max) {
  std::vector<std::uint64_t> counts(bins, 0);
  for (const double distance : distances) {
    const double part = max > 0 ? distance / max : 0;
    ++counts[std::min(bins - 1, static_cast<std::size_t>(part * static_cast<double>(bins)))];
  }
  return counts;
}

void check_arguments(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw std::invalid_argument("expected a mesh with triangles, found none");
  measure::require_finite_mesh(mesh);
}

// An offset for both meshes: one of theirs, so that coordinates near it lose nothing.
std::array<double, 3> common_offset(const TriangleMesh& a, const TriangleMesh& b) {
  return a.offset == std::array<double, 3>{0, 0, 0} ? b.offset : a.offset;
}

TriangleMesh at_offset(TriangleMesh mesh, const std::array<double, 3>& offset) {
  move_to_offset(mesh, offset);
  return mesh;
}

}  // namespace

MeshDistance compare_meshes(const TriangleMesh& a, const TriangleMesh& b, const DistanceOptions& options) {
  const StandardFloats floats;
  if (a.offset != b.offset) {
    const std::array<double, 3> offset = common_offset(a, b);
    return compare_meshes(at_offset(a, offset), at_offset(b, offset), options);
  }
  check_arguments(a);
  check_arguments(b);
  if (options.samples == 0) throw std::invalid_argument("expected at least one sample");
  const Executor executor(options.threads);
  MeshDistance result;
  std::vector<double> from_a;
  std::vector<double> from_b;
  result.a_to_b = one_way(a, b, options, executor, from_a);
  result.b_to_a = one_way(b, a, options, executor, from_b);
  const OneWayDistance& ab = result.a_to_b;
  const OneWayDistance& ba = result.b_to_a;
  result.mean = (ab.mean + ba.mean) / 2;
  result.rms = std::sqrt((ab.rms * ab.rms + ba.rms * ba.rms) / 2);
  result.max = std::max(ab.max, ba.max);
  if (options.bins > 0) {
    result.a_to_b.histogram = histogram_of(from_a, options.bins, result.max);
    result.b_to_a.histogram = histogram_of(from_b, options.bins, result.max);
  }
  return result;
}

std::vector<float> vertex_distances(const TriangleMesh& mesh, const TriangleMesh& to, int threads) {
  const StandardFloats floats;
  check_arguments(mesh);
  check_arguments(to);
  if (mesh.offset != to.offset) {
    const std::array<double, 3> offset = common_offset(mesh, to);
    return vertex_distances(at_offset(mesh, offset), at_offset(to, offset), threads);
  }
  const Executor executor(threads);
  const measure::TriangleTree tree(to, executor);
  std::vector<float> distances(mesh.vertices.size());
  executor.for_blocks(static_cast<std::int64_t>(distances.size()), kSamplesPerBlock,
                      [&](std::int64_t begin, std::int64_t end) {
                        std::size_t hint = measure::TriangleTree::kNoHint;
                        for (auto v = static_cast<std::size_t>(begin); v < static_cast<std::size_t>(end); ++v) {
                          const double squared = tree.squared_distance_from(measure::vector_of(mesh.vertices[v]), hint);
                          distances[v] = static_cast<float>(std::sqrt(squared));
                        }
                      });
  return distances;
}

}  // namespace isoweave
