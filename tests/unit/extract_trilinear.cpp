// The topology of the trilinear extractor against the interpolant itself, sampled finely.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "extract/trilinear_rules.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::extract_trilinear_test {
namespace {

// The trilinear interpolant of the corners of a unit cell, written out.
double interpolated(const CornerValues& values, double x, double y, double z) {
  double sum = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    sum += values[corner] * ((corner & 1) != 0 ? x : 1 - x) * ((corner & 2) != 0 ? y : 1 - y) *
           ((corner & 4) != 0 ? z : 1 - z);
  }
  return sum;
}

// The parts of the inside and the outside of a cell, by samples that are joined to their neighbours of the same side.
std::size_t parts_of(const CornerValues& values, std::size_t steps) {
  const std::size_t n = steps + 1;
  std::vector<std::size_t> set(n * n * n);
  std::iota(set.begin(), set.end(), std::size_t{0});
  std::vector<bool> inside(set.size());
  const auto find = [&](std::size_t a) {
    while (set[a] != a) a = set[a] = set[set[a]];
    return a;
  };
  std::size_t parts = set.size();
  for (std::size_t at = 0; at < set.size(); ++at) {
    const auto part = [&](std::size_t index) { return static_cast<double>(index) / static_cast<double>(steps); };
    const std::array<std::size_t, 3> index{at % n, at / n % n, at / (n * n)};
    inside[at] = interpolated(values, part(index[0]), part(index[1]), part(index[2])) >= 0;
    std::size_t step = 1;
    for (std::size_t axis = 0; axis < 3; ++axis, step *= n) {
      if (index[axis] == 0 || inside[at] != inside[at - step] || find(at) == find(at - step)) continue;
      set[find(at)] = find(at - step);
      --parts;
    }
  }
  return parts;
}

std::uint32_t case_of(const CornerValues& values) {
  std::uint32_t cell = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) cell |= (values[corner] >= 0 ? 1U : 0U) << corner;
  return cell;
}

// Whether the products on a face are equal, so that its corners meet in a point.
bool has_tie(const CornerValues& values) {
  for (const auto& face : table_rules::kFaces) {
    const auto value = [&](std::size_t n) { return values[static_cast<std::size_t>(face[n])]; };
    if (value(0) * value(2) == value(1) * value(3)) return true;
  }
  return false;
}

// Odd numbers with signs that often leave a choice, without ties.
CornerValues random_corners(std::mt19937& random) {
  constexpr std::array<unsigned, 20> kSigns{0x81, 0x7e, 0x69, 0x96, 0x3c, 0x18, 0xE7, 0x24, 0x5a, 0xa5,
                                            0x42, 0x99, 0xC3, 0x66, 0x16, 0xE9, 0x61, 0x86, 0x29, 0x1e};
  CornerValues values;
  do {
    const unsigned signs = kSigns[random() % kSigns.size()];
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const auto size = static_cast<double>(random() % 50) * 2 + 1;
      values[corner] = (signs >> corner & 1) != 0 ? size : -size;
    }
  } while (has_tie(values));
  return values;
}

// Loops cut the cell into one part more than there are loops; a tunnel joins two of them again.
TEST(Trilinear, CellsHaveThePartsOfTheInterpolant) {
  std::mt19937 random(11);
  std::size_t tunnels = 0, centres = 0;
  for (int n = 0; n < (kSanitized ? 200 : 2000); ++n) {
    const CornerValues values = random_corners(random);
    const CellTopology topology = topology_of(case_of(values), values);
    const std::size_t expected = topology.loops + (topology.has_tunnel ? 0U : 1U);
    tunnels += topology.has_tunnel ? 1U : 0U;
    centres += topology.vertices() > 0 && !topology.has_tunnel ? 1U : 0U;
    bool same = false;
    for (const std::size_t steps : {20U, 45U, 110U, 250U}) {
      same = parts_of(values, steps) == expected;
      if (same) break;
    }
    EXPECT_TRUE(same) << "case " << case_of(values) << ", cell " << n;
  }
  EXPECT_GT(tunnels, kSanitized ? 1U : 20U);
  EXPECT_GT(centres, 0U);
}

// The axis that the rule looks along is of no importance: turning a cell turns its topology.
TEST(Trilinear, TurnedCellsHaveTheSameTopology) {
  std::mt19937 random(12);
  for (int n = 0; n < 5000; ++n) {
    const CornerValues values = random_corners(random);
    CornerValues turned;  // x becomes y, y becomes z, z becomes x
    for (std::size_t corner = 0; corner < 8; ++corner) turned[(corner << 1 & 6) | corner >> 2] = values[corner];
    const CellTopology a = topology_of(case_of(values), values);
    const CellTopology b = topology_of(case_of(turned), turned);
    ASSERT_EQ(a.loops, b.loops);
    ASSERT_EQ(a.has_tunnel, b.has_tunnel);
    ASSERT_EQ(a.triangles(), b.triangles());
  }
}

TEST(Trilinear, WaistsLieOnTheSurface) {
  std::mt19937 random(13);
  std::size_t tunnels = 0;
  while (tunnels < 50) {
    const CornerValues values = random_corners(random);
    if (!topology_of(case_of(values), values).has_tunnel) continue;
    ++tunnels;
    const std::array<Vec3, 6> waist = waist_of(values);
    for (std::size_t n = 0; n < 6; ++n) {
      const Vec3& p = waist[n];
      EXPECT_NEAR(interpolated(values, p.x, p.y, p.z), 0, 1e-9);
      const Vec3 side = waist[(n + 1) % 6] - p;  // along one axis, and on the surface
      EXPECT_EQ((side.x != 0) + (side.y != 0) + (side.z != 0), 1);
      EXPECT_NEAR(interpolated(values, p.x + side.x / 2, p.y + side.y / 2, p.z + side.z / 2), 0, 1e-9);
    }
  }
}

// A grid of random samples, outside at its border, and the same interpolant sampled so many times finer.
std::vector<float> random_samples(std::int64_t side, std::mt19937& random) {
  std::uniform_real_distribution<float> value(-1, 1);
  std::vector<float> samples(static_cast<std::size_t>(side * side * side));
  for (std::int64_t n = 0; n < side * side * side; ++n) {
    const std::array<std::int64_t, 3> at{n % side, n / side % side, n / (side * side)};
    const bool border = std::ranges::any_of(at, [&](std::int64_t i) { return i == 0 || i == side - 1; });
    samples[static_cast<std::size_t>(n)] = border ? -std::abs(value(random)) - 0.01F : value(random);
  }
  return samples;
}

std::vector<float> refined(const std::vector<float>& samples, std::int64_t side, std::int64_t times) {
  const std::int64_t fine = (side - 1) * times + 1;
  std::vector<float> out;
  out.reserve(static_cast<std::size_t>(fine * fine * fine));
  for (std::int64_t n = 0; n < fine * fine * fine; ++n) {
    const std::array<std::int64_t, 3> at{n % fine, n / fine % fine, n / (fine * fine)};
    std::array<std::int64_t, 3> low;
    std::array<double, 3> part;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(at[axis] / times, side - 2);
      part[axis] = static_cast<double>(at[axis] - low[axis] * times) / static_cast<double>(times);
    }
    CornerValues values;
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const auto step = [&](std::size_t axis) { return low[axis] + static_cast<std::int64_t>(corner >> axis & 1); };
      values[corner] = samples[static_cast<std::size_t>((step(2) * side + step(1)) * side + step(0))];
    }
    out.push_back(static_cast<float>(interpolated(values, part[0], part[1], part[2])));
  }
  return out;
}

MeshCheck full_check(std::int64_t side, const std::vector<float>& samples, ExtractorKind extractor) {
  MemoryVolume volume({side, side, side}, samples);
  MeshOptions options = full_surface({});
  options.extractor = extractor;
  MemorySink sink;
  mesh_volume(volume, sink, options);
  return check_mesh(sink.mesh);
}

TEST(Trilinear, SurfacesHaveTheTopologyOfTheRefinedField) {
  std::mt19937 random(14);
  std::size_t unlike_cubes = 0;
  for (int n = 0; n < (kSanitized ? 4 : 60); ++n) {
    const std::int64_t side = n % 4 == 3 ? 7 : 5;
    const std::vector<float> samples = random_samples(side, random);
    const MeshCheck found = full_check(side, samples, ExtractorKind::kTrilinear);
    EXPECT_EQ(found.open_edges + found.nonmanifold_edges + found.nonmanifold_vertices, 0U);
    const MeshCheck cubes = full_check(side, samples, ExtractorKind::kCubes);
    unlike_cubes += cubes.euler != found.euler || cubes.components != found.components ? 1 : 0;
    bool same = false;
    for (const std::int64_t times : {8, 16, 40}) {
      const std::int64_t fine = (side - 1) * times + 1;
      const MeshCheck expected = full_check(fine, refined(samples, side, times), ExtractorKind::kCubes);
      same = found.euler == expected.euler && found.components == expected.components;
      if (same) break;
    }
    EXPECT_TRUE(same) << "grid " << n;
  }
  EXPECT_GT(unlike_cubes, 0U);
}

}  // namespace
}  // namespace isoweave::testing::extract_trilinear_test
