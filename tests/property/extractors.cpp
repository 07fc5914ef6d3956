// The promises of every extractor: closed, oriented manifolds whatever the samples; and the promises of each by itself.
// Threads: none, they are shown by the conformance of extractors
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

#include "grids.hpp"

namespace isoweave::testing::extractors_test {
namespace {

TEST(Extractors, MakeManifoldsOfRandomSamples) {
  std::mt19937 random(1);
  for (const Dims& dims : {Dims{9, 8, 7}, Dims{1, 5, 6}, Dims{5, 1, 6}, Dims{6, 5, 1}, Dims{1, 1, 1}, Dims{2, 2, 2},
                           Dims{2, 7, 5}, Dims{7, 2, 2}, Dims{3, 3, 3}, Dims{66, 3, 4}}) {
    const Grid grid = random_grid(dims, random);
    for (const ExtractorKind extractor : kAllExtractors) {
      for (const bool closed : {true, false}) {
        SCOPED_TRACE(::testing::Message() << dims[0] << " x " << dims[1] << " x " << dims[2] << ", extractor "
                                          << static_cast<int>(extractor) << (closed ? "" : ", open"));
        expect_manifold(make(grid, extractor, closed, {1, 1, 1}, full()), closed);
      }
    }
  }
}

// Every pattern of so many bits in a block of points, each block with outside samples around it.
template <class Sample>
Grid blocks(const Dims& block, std::int64_t patterns, std::int64_t in_a_row, const Sample& sample) {
  const Dims step{block[0] + 1, block[1] + 1, block[2] + 1};
  Grid grid{{step[0] * in_a_row + 1, step[1] * ((patterns + in_a_row - 1) / in_a_row) + 1, step[2] + 1}};
  for (std::int64_t pattern = 0; pattern < patterns; ++pattern) {
    for (std::int64_t n = 0; n < block[0] * block[1] * block[2]; ++n) {
      grid.at(1 + pattern % in_a_row * step[0] + n % block[0],
              1 + pattern / in_a_row * step[1] + n / block[0] % block[1], 1 + n / (block[0] * block[1])) =
          sample(pattern, n);
    }
  }
  return grid;
}

TEST(Extractors, MakeManifoldsOfAllPairsOfCells) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> value(0.1F, 1);
  const auto sample = [&](std::int64_t pattern, std::int64_t n) {
    return (pattern >> n & 1) != 0 ? value(random) : -value(random);
  };
  for (const Dims& block : {Dims{3, 2, 2}, Dims{2, 3, 2}, Dims{2, 2, 3}}) {
    const Grid grid = blocks(block, 4096, 64, sample);
    for (const ExtractorKind extractor : kAllExtractors) {
      SCOPED_TRACE(static_cast<int>(extractor));
      expect_manifold(make(grid, extractor, true, {1, 1, 1}, full()), true);
    }
  }
}

// Products of samples tie on faces, and samples are equal to the iso-value.
TEST(Extractors, MakeManifoldsOfTies) {
  const auto digit = [](std::int64_t pattern, std::int64_t n) {
    for (; n > 0; --n) pattern /= 3;
    return static_cast<float>(pattern % 3 - 1);
  };
  std::vector<Grid> grids{blocks({2, 2, 2}, 6561, 81, digit)};
  std::mt19937 random(3);
  for (int n = 0; n < 3; ++n) {
    grids.push_back(Grid{{17, 16, 15}});
    grids.back().fill([&](auto...) { return static_cast<float>(random() % 3) - 1; });
  }
  for (const Grid& grid : grids) {
    for (const ExtractorKind extractor : kAllExtractors) {
      SCOPED_TRACE(static_cast<int>(extractor));
      expect_manifold(make(grid, extractor, true, {1, 1, 1}, full()), true);
    }
  }
}

TEST(Extractors, TakeNaNAndInfiniteSamples) {
  std::mt19937 random(4);
  Grid grid = random_grid({12, 11, 10}, random);
  for (float& sample : grid.samples) {
    if (random() % 9 == 0) sample = std::numeric_limits<float>::quiet_NaN();
    if (random() % 9 == 0) sample = random() % 2 == 0 ? std::numeric_limits<float>::infinity() : -3e38F;
  }
  MeshOptions options;
  options.normals = Normals::kGradient;
  for (const ExtractorKind extractor : kAllExtractors) {
    SCOPED_TRACE(static_cast<int>(extractor));
    const Made made = make(grid, extractor, true, {1, 1, 1}, options);
    expect_manifold(made, true);
    for (const Point& p : made.mesh.vertices) ASSERT_TRUE(std::isfinite(p[0] + p[1] + p[2]));
    for (const Point& n : made.mesh.normals) ASSERT_TRUE(std::isfinite(n[0] + n[1] + n[2]));
  }
}

// Sets of points that are joined step by step.
class Parts {
 public:
  explicit Parts(std::size_t count) : set_(count) { std::iota(set_.begin(), set_.end(), std::size_t{0}); }

  std::size_t of(std::size_t n) {
    while (set_[n] != n) n = set_[n] = set_[set_[n]];
    return n;
  }
  void join(std::size_t a, std::size_t b) { set_[of(a)] = of(b); }

 private:
  std::vector<std::size_t> set_;
};

// The simplices of Kuhn's tetrahedra all of whose corners are inside: a chain of steps from a point, each along other
// axes. Their alternating sum is the Euler number of the inside, whose boundary has twice that.
std::int64_t euler_of_inside(Grid& grid) {
  std::int64_t euler = 0;
  const std::function<void(std::int64_t, std::int64_t, std::int64_t, int, int)> visit =
      [&](std::int64_t i, std::int64_t j, std::int64_t k, int left, int sign) {
        if (!grid.is_inside(i, j, k)) return;
        euler += sign;
        for (int step = 1; step < 8; ++step) {
          if ((step & left) == step) visit(i + (step & 1), j + (step >> 1 & 1), k + (step >> 2), left & ~step, -sign);
        }
      };
  for (std::int64_t k = 0; k < grid.dims[2]; ++k) {
    for (std::int64_t j = 0; j < grid.dims[1]; ++j) {
      for (std::int64_t i = 0; i < grid.dims[0]; ++i) visit(i, j, k, 7, 1);
    }
  }
  return euler;
}

// Surfaces between the parts of inside and outside points, joined along the edges of Kuhn's tetrahedra: in a lattice
// without holes the parts are a tree, so there is one surface fewer than there are parts.
std::uint64_t surfaces_between(Grid& grid) {
  const Dims padded{grid.dims[0] + 2, grid.dims[1] + 2, grid.dims[2] + 2};
  const auto number = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    return static_cast<std::size_t>(((k + 1) * padded[1] + j + 1) * padded[0] + i + 1);
  };
  Parts parts(static_cast<std::size_t>(padded[0] * padded[1] * padded[2]));
  std::size_t count = static_cast<std::size_t>(padded[0] * padded[1] * padded[2]);
  for (std::int64_t k = -1; k <= grid.dims[2]; ++k) {
    for (std::int64_t j = -1; j <= grid.dims[1]; ++j) {
      for (std::int64_t i = -1; i <= grid.dims[0]; ++i) {
        for (int step = 1; step < 8; ++step) {
          const Dims to{i + (step & 1), j + (step >> 1 & 1), k + (step >> 2)};
          if (to[0] > grid.dims[0] || to[1] > grid.dims[1] || to[2] > grid.dims[2]) continue;
          if (grid.is_inside(i, j, k) != grid.is_inside(to[0], to[1], to[2])) continue;
          const std::size_t a = parts.of(number(i, j, k)), b = parts.of(number(to[0], to[1], to[2]));
          count -= a != b ? 1 : 0;
          parts.join(a, b);
        }
      }
    }
  }
  return count - 1;
}

TEST(Tetrahedra, HaveTheTopologyOfTheInsideSimplices) {
  std::mt19937 random(5);
  for (int n = 0; n < 20; ++n) {
    Grid grid = random_grid({7, 6, 5}, random);
    const Made made = make(grid, ExtractorKind::kTetrahedra, true, {1, 1, 1}, full());
    EXPECT_EQ(made.check.euler, 2 * euler_of_inside(grid));
    EXPECT_EQ(made.check.components, surfaces_between(grid));
  }
}

TEST(Tetrahedra, MoveWithTheVolume) {
  std::mt19937 random(6);
  const Grid grid = random_grid({8, 7, 6}, random);
  for (const Dims& shift : {Dims{1, 0, 0}, Dims{0, 1, 0}, Dims{0, 0, 1}, Dims{3, 2, 1}}) {
    std::vector<std::vector<std::array<Point, 3>>> meshes;
    for (const Dims& first : {Dims{2, 2, 2}, Dims{2 + shift[0], 2 + shift[1], 2 + shift[2]}}) {
      Grid larger{{14, 13, 12}};
      for (std::int64_t n = 0; n < 8 * 7 * 6; ++n) {
        larger.at(first[0] + n % 8, first[1] + n / 8 % 7, first[2] + n / 56) =
            grid.samples[static_cast<std::size_t>(n)] >= 0 ? 1.0F : -1.0F;  // places are halves, and exact
      }
      const Made made = make(larger, ExtractorKind::kTetrahedra, true, {1, 1, 1}, full());
      auto& triangles = meshes.emplace_back();
      for (const auto& t : made.mesh.triangles) {
        std::array<Point, 3> corners;
        for (std::size_t c = 0; c < 3; ++c) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            corners[c][axis] = made.mesh.vertices[t[c]][axis] - static_cast<float>(first[axis]);
          }
        }
        triangles.push_back(corners);
      }
      std::ranges::sort(triangles);
    }
    EXPECT_TRUE(meshes[0] == meshes[1]);
  }
}

TEST(Dual, HasTheTopologyOfCubesAndAVertexInEachCell) {
  std::mt19937 random(7);
  for (int n = 0; n < 10; ++n) {
    const Grid grid = random_grid({8, 7, 6}, random);
    const std::array<double, 3> spacing{0.7, 1.5, 2};
    const Made cubes = make(grid, ExtractorKind::kCubes, true, spacing, full());
    const Made dual = make(grid, ExtractorKind::kDual, true, spacing, full());
    EXPECT_EQ(dual.check.euler, cubes.check.euler);
    EXPECT_EQ(dual.check.components, cubes.check.components);
    std::size_t on_faces = 0;
    for (const Point& p : dual.mesh.vertices) {
      int near_slices = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double index = double{p[axis]} / spacing[axis];
        near_slices += std::abs(index - std::round(index)) < 1.0 / 256 - 1e-5 ? 1 : 0;
      }
      ASSERT_LE(near_slices, 1);
      on_faces += near_slices > 0 ? 1 : 0;
    }
    EXPECT_GT(on_faces, 0U) << "no face that two cells meet twice";
    EXPECT_LT(on_faces, dual.mesh.vertices.size() / 20);
  }
}

// Edges where both sides of the box lie alike between samples: there no sample nearest to one side hides the other.
TEST(Dual, KeepsSharpEdges) {
  GenerateOptions box;
  box.kind = "box";
  box.dims = {40, 40, 40};
  const auto most_off = [&](ExtractorKind extractor) {
    MeshOptions options = full();
    options.extractor = extractor;
    MemorySink sink;
    mesh_volume(*generate_volume(box), sink, options);
    float low = 40;
    for (const Point& p : sink.mesh.vertices) low = std::min(low, p[0]);
    float most = 0;
    std::size_t count = 0;
    for (const Point& p : sink.mesh.vertices) {  // in the cells of the edge along z, away from its ends
      if (p[0] > std::floor(low) + 1 || p[1] > std::floor(low) + 1 || p[2] < low + 2 || p[2] > 30) continue;
      most = std::max(most, std::max(p[0], p[1]) - low);
      ++count;
    }
    EXPECT_GT(count, 10U);
    return most;
  };
  EXPECT_LT(most_off(ExtractorKind::kDual), 0.01);
  EXPECT_GT(most_off(ExtractorKind::kCubes), 0.3);
}

// The mean over triangles of (u - v) / (u + v), where u and v are their sides squared along an axis, as far as it lies
// in their plane, and across it: above 0 for triangles that are long along the axis.
double bias(const TriangleMesh& mesh, std::size_t axis) {
  double sum = 0, weight = 0;
  for (const auto& t : mesh.triangles) {
    std::array<Vec3, 3> p;
    for (std::size_t c = 0; c < 3; ++c) p[c] = {mesh.vertices[t[c]][0], mesh.vertices[t[c]][1], mesh.vertices[t[c]][2]};
    const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
    const double area = std::sqrt(dot(normal, normal));
    if (!(area > 0)) continue;
    const Vec3 n = (1 / area) * normal;
    const Vec3 a{axis == 0 ? 1.0 : 0, axis == 1 ? 1.0 : 0, axis == 2 ? 1.0 : 0};
    const Vec3 flat = a - dot(a, n) * n;
    const double length = std::sqrt(dot(flat, flat));
    if (length < 1e-3) continue;
    const Vec3 u = (1 / length) * flat, v = cross(n, u);
    double along = 0, across = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 side = p[(c + 1) % 3] - p[c];
      along += dot(side, u) * dot(side, u);
      across += dot(side, v) * dot(side, v);
    }
    sum += area * length * length * (along - across) / (along + across);
    weight += area * length * length;
  }
  return sum / weight;
}

TEST(Cubes, HaveNoPreferredDirection) {
  GenerateOptions sphere;
  sphere.dims = {64, 64, 64};
  MemorySink sink;
  mesh_volume(*generate_volume(sphere), sink, full());
  for (const std::size_t axis : {0U, 1U, 2U}) EXPECT_LT(std::abs(bias(sink.mesh, axis)), 0.005) << "axis " << axis;
}

// The triangles as sets of three places, whose coordinates are in the order of `axes`.
std::vector<std::array<Point, 3>> places(const TriangleMesh& mesh, const std::array<std::size_t, 3>& axes) {
  std::vector<std::array<Point, 3>> triangles;
  for (const auto& t : mesh.triangles) {
    std::array<Point, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t axis = 0; axis < 3; ++axis) corners[c][axes[axis]] = mesh.vertices[t[c]][axis];
    }
    std::ranges::sort(corners);
    triangles.push_back(corners);
  }
  std::ranges::sort(triangles);
  return triangles;
}

TEST(Cubes, ArePermutedAsTheAxesAre) {
  std::mt19937 random(8);
  Grid grid = random_grid({11, 9, 8}, random);
  grid.fill([&](std::int64_t i, std::int64_t j, std::int64_t k) {  // without caps, on which diagonals tie
    const bool border = i == 0 || j == 0 || k == 0 || i == 10 || j == 8 || k == 7;
    return border ? -std::abs(grid.at(i, j, k)) : grid.at(i, j, k);
  });
  const std::array<double, 3> spacing{1, 0.75, 1.5};
  const auto expected = places(make(grid, ExtractorKind::kCubes, true, spacing, full()).mesh, {0, 1, 2});
  std::array<std::size_t, 3> axes{0, 1, 2};  // of the permuted volume's axes, in the first one
  while (std::ranges::next_permutation(axes).found) {
    Grid permuted{{grid.dims[axes[0]], grid.dims[axes[1]], grid.dims[axes[2]]}};
    permuted.fill([&](std::int64_t i, std::int64_t j, std::int64_t k) {
      const Dims own{i, j, k};
      Dims at{};
      for (std::size_t axis = 0; axis < 3; ++axis) at[axes[axis]] = own[axis];
      return grid.at(at[0], at[1], at[2]);
    });
    const std::array<double, 3> own_spacing{spacing[axes[0]], spacing[axes[1]], spacing[axes[2]]};
    EXPECT_TRUE(places(make(permuted, ExtractorKind::kCubes, true, own_spacing, full()).mesh, axes) == expected);
  }
}

// A volume of a linear function, whose values every interpolation keeps.

}  // namespace
}  // namespace isoweave::testing::extractors_test
