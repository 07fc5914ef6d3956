// The kernels in lanes of N doubles. Each instruction set instantiates them for an N of its own, in a source file of
// its own: the instances have different names, so that the linker keeps all of them.
#pragma once

#include <algorithm>

#include "simplify/kernels.hpp"
#include "simplify/lanes.hpp"

namespace isoweave {

template <std::size_t N>
class KernelsInLanes {
 public:
  static constexpr Kernels table() {
    return {edge_costs,         measure,       sum_faces, keeps_sides, count_common,
            bound_of_crossings, points_within, lie_over,  count_over};
  }

 private:
  using Real = Lanes<N>;
  using Vec = BasicVec3<Real>;
  using Integers = typename LaneTypes<N>::Integers;
  using IntegersInMemory = typename LaneTypes<N>::IntegersInMemory;

  // Position and quadric of N vertices.
  struct Ends {
    Vec position;
    BasicQuadric<Real> quadric;
  };

  // Loads the first kColumns doubles of every vertex, by columns. The rest of a vertex may be changing meanwhile.
  template <std::size_t kColumns, class VertexOf>
  [[gnu::always_inline]] static void load_vertices(const VertexOf& vertex_of, Real* columns) {
    static_assert(offsetof(Vertex, position) == 0 && offsetof(Vertex, quadric) == 4 * sizeof(double));
    constexpr std::size_t kWidth = std::min<std::size_t>(N, 4);
    const double* from[N];
    unrolled<N>([&](auto n) { from[n] = reinterpret_cast<const double*>(vertex_of(n)); });
    unrolled<kColumns / kWidth>(
        [&](auto n) { isoweave::load_columns<kWidth>(from, n * kWidth, columns + n * kWidth); });
    constexpr std::size_t kRest = kColumns % kWidth;
    if constexpr (kRest > 0) isoweave::load_columns<kRest>(from, kColumns - kRest, columns + kColumns - kRest);
  }

  template <class VertexOf>
  [[gnu::always_inline]] static Ends load_ends(const VertexOf& vertex_of) {
    Real c[14];
    load_vertices<14>(vertex_of, c);
    return {{c[0], c[1], c[2]}, {c[4], c[5], c[6], c[7], c[8], c[9], {c[10], c[11], c[12]}, c[13]}};
  }

  static void edge_costs(std::span<const EdgeEnds> edges, CostBits* costs) {
    const std::size_t count = edges.size();
    for (std::size_t begin = 0; begin < count; begin += N) {
      const auto edge = [&](std::size_t n) { return edges[std::min(begin + n, count - 1)]; };
      const Ends u = load_ends([&](std::size_t n) { return edge(n).first; });
      const Ends v = load_ends([&](std::size_t n) { return edge(n).second; });
      const Real cost = collapse_cost(u.quadric, v.quadric, v.position - u.position);
      double out[N];
      cost.store(out);
      for (std::size_t n = 0; n < std::min(N, count - begin); ++n) costs[begin + n] = to_cost(out[n]);
    }
  }

  static Vec places(const Vertex* vertices, const Vec& from, const Index* which) {
    Real c[4];
    load_vertices<4>([&](std::size_t n) { return vertices + which[n]; }, c);
    return Vec{c[0], c[1], c[2]} - from;
  }

  static void store(const Vec& v, double* x, double* y, double* z) {
    v.x.store(x);
    v.y.store(y);
    v.z.store(z);
  }

  static Vec shifted(const Vec& v, const Vec& by) {
    return {isoweave::shifted(v.x, by.x), isoweave::shifted(v.y, by.y), isoweave::shifted(v.z, by.z)};
  }

  // The repeated neighbour makes the slots past the last one zero. A number that has just been stored is not loaded
  // together with its neighbour in memory: such a load waits until all stores that it takes from are complete.
  static void measure(const Vertex* vertices, Vec3 centre, const Index* neighbours, std::size_t count, Fan& fan) {
    const Vec from{centre.x, centre.y, centre.z};
    const Vec3 repeated = vertices[neighbours[count]].position - centre;
    const Vec last{repeated.x, repeated.y, repeated.z};
    Vec to = places(vertices, from, neighbours);
    std::size_t n = 0;
    for (; n < count; n += N) {
      const Vec beyond = n + N < count ? places(vertices, from, neighbours + n + N) : last;
      store(to, fan.x + n, fan.y + n, fan.z + n);
      store(cross(to, shifted(to, beyond)), fan.normal_x + n, fan.normal_y + n, fan.normal_z + n);
      to = beyond;
    }
    fan.x[n] = repeated.x;
    fan.y[n] = repeated.y;
    fan.z[n] = repeated.z;
  }

  static Vec neighbour(const Fan& fan, std::size_t n) {
    return {Real::load(fan.x + n), Real::load(fan.y + n), Real::load(fan.z + n)};
  }

  static Vec normal(const Fan& fan, std::size_t n) {
    return {Real::load(fan.normal_x + n), Real::load(fan.normal_y + n), Real::load(fan.normal_z + n)};
  }

  // Adds all lanes, also those beyond the last slot, which are zero: so the number of turns of the loop stays the same.
  static FaceSums sum_faces(const Fan& fan, std::size_t slots, double weight) {
    constexpr std::size_t kColumns = 8;
    Real total[kColumns / N];
    for (Real& t : total) t = 0;
    double normal_z = 0;
    for (std::size_t begin = 0; begin < slots; begin += N) {
      const Vec along = normal(fan, begin);
      const Real size = square_root(dot(along, along));  // twice the area
      const BasicQuadric<Real> plane = plane_quadric(along, select<N>(size > 0, weight / size, 0));
      Real columns[kColumns] = {plane.xx, plane.xy, plane.xz, plane.yy, plane.yz, plane.zz, along.x, along.y};
      unrolled<kColumns / N>([&](auto block) {
        Real rows[N];
        unrolled<N>([&](auto n) { rows[n] = columns[block * N + n]; });
        transpose<N, N>(rows);
        unrolled<N>([&](auto n) { total[block] = total[block] + rows[n]; });
      });
      unrolled<N>([&](auto n) { normal_z += fan.normal_z[begin + n]; });
    }
    double out[kColumns];
    unrolled<kColumns / N>([&](auto block) { total[block].store(out + block * N); });
    return {{out[0], out[1], out[2], out[3], out[4], out[5], {}, 0}, {out[6], out[7], normal_z}};
  }

  static bool keeps_sides(const Fan& fan, std::size_t slots, Vec3 move) {
    const Vec by{move.x, move.y, move.z};
    for (std::size_t n = 0; n < slots; n += N) {
      const Vec before = normal(fan, n);
      const Vec after = cross(neighbour(fan, n) - by, neighbour(fan, n + 1) - by);
      if (!all<N>(keeps_side(before, after))) return false;
    }
    return true;
  }

  static int count_common(std::span<const Index> a, const Index* b, std::size_t count) {
    constexpr std::size_t kWidth = sizeof(Integers) / sizeof(Index);
    Integers equal{};
    for (std::size_t first = 0; first < count; first += kWidth) {
      const Integers numbers = *reinterpret_cast<const IntegersInMemory*>(b + first);
      for (const Index x : a) equal -= numbers == static_cast<std::int32_t>(x);
    }
    std::int32_t common = 0;
    for (std::size_t n = 0; n < kWidth; ++n) common += equal[n];
    return common;
  }

  static double bound_of_crossings(const Vec3& to, double bound, const SeenSides& sides) {
    Real most = 0;
    for (std::size_t n = 0; n < sides.count; n += N) {
      const Real x = Real::load(sides.x + n);
      const Real y = Real::load(sides.y + n);
      const Real along_x = Real::load(sides.along_x + n);
      const Real along_y = Real::load(sides.along_y + n);
      const Real turn = to.x * along_y - to.y * along_x;
      const Real s = (x * along_y - y * along_x) / turn;
      const Real t = (x * to.y - y * to.x) / turn;
      const Real difference = s * to.z - (Real::load(sides.z + n) + t * Real::load(sides.along_z + n));
      const Real other = Real::load(sides.bound + n) + t * Real::load(sides.along_bound + n);
      const Real rest = absolute(difference) + other - s * bound - kBoundRounding;
      const Real weight = select<N>(1 - s > kLeastWeight, 1 - s, kLeastWeight);
      const Real least = rest / weight;
      const auto inside = (s > -kTouching) & (1 + kTouching > s) & (t > -kTouching) & (1 + kTouching > t);
      most = select<N>(inside & (least > most), least, most);
    }
    double bounds[N];
    most.store(bounds);
    return *std::max_element(bounds, bounds + N);
  }

  static constexpr std::size_t kFew = std::min<std::size_t>(N, 4);  // lanes for four points
  using Few = Lanes<kFew>;
  using FewMask = typename Few::Mask;

  static Few along(const BasicVec3<Few>& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

  // Which points are near a corner of a triangle, near one of its sides or near the triangle that they lie above. No
  // quotient is needed to know. The normal of a triangle with sides in one direction is rounding noise.
  static FewMask within(double most, const BasicVec3<Few>& points, const std::array<const Vec3*, 3>& triangle) {
    constexpr double kLeastSine = 1e-12;
    const Vec3 ab = *triangle[1] - *triangle[0];
    const Vec3 ac = *triangle[2] - *triangle[0];
    const Vec3 normal = cross(ab, ac);
    const double size = dot(normal, normal);
    const bool is_flat = size > kLeastSine * kLeastSine * dot(ab, ab) * dot(ac, ac);
    FewMask near{};
    FewMask above = FewMask{} - std::int64_t{is_flat};
    unrolled<3>([&](auto n) {
      const Vec3& corner = *triangle[n];
      const Vec3 side = *triangle[(n + 1) % 3] - corner;
      const double length = dot(side, side);
      const BasicVec3<Few> from = points - BasicVec3<Few>{corner.x, corner.y, corner.z};
      const Few squared = dot(from, from);
      const Few forwards = along(from, side);
      const Few height = along(from, normal);
      near |= Few(most) >= squared;
      near |= (forwards > 0) & (Few(length) > forwards) & (most * length >= squared * length - forwards * forwards);
      above &= (along(from, cross(normal, side)) >= 0) & (most * size >= height * height);
    });
    return near | above;
  }

  static unsigned points_within(double most, const FourPoints& points, const std::array<const Vec3*, 3>& triangle) {
    unsigned bits = 0;
    for (std::size_t n = 0; n < 4; n += kFew) {
      const BasicVec3<Few> some{Few::load(points.x + n), Few::load(points.y + n), Few::load(points.z + n)};
      const FewMask mask = within(most, some, triangle);
      unrolled<kFew>([&](auto lane) { bits |= static_cast<unsigned>(mask[lane.value] & 1) << (n + lane); });
    }
    return bits;
  }

  using Mask = typename Real::Mask;

  // The corners of N triangles, and which of them lie beside a side of a part.
  struct SeenLanes {
    Real x[3], y[3], height[3];
    Mask beside[3][3];  // side, corner
  };

  [[gnu::always_inline]] static SeenLanes load_seen(const SeenTriangles& triangles, const SeenPart& part,
                                                    std::size_t begin) {
    SeenLanes corners;
    unrolled<3>([&](auto n) {
      corners.x[n] = Real::load(triangles.x[n] + begin);
      corners.y[n] = Real::load(triangles.y[n] + begin);
      corners.height[n] = Real::load(triangles.height[n] + begin);
      unrolled<3>([&](auto side) {
        const double reach = part.slack * (std::abs(part.left_x[side]) + std::abs(part.left_y[side]));
        corners.beside[side][n] = Real(-reach) > part.left_of(side, corners.x[n], corners.y[n]);
      });
    });
    return corners;
  }

  static Real absolute(const Real& a) { return select<N>(a > 0, a, -a); }

  // The line through two corners, which are taken in an order of their own, so that the triangle beyond gets the same
  // answer.
  struct SideLine {
    Mask turned;
    Real left_x, left_y, from;

    [[gnu::always_inline]] SideLine(const Real& ax, const Real& ay, const Real& bx, const Real& by)
        : turned((ax > bx) | ((ax >= bx) & (bx >= ax) & (ay > by))) {
      const Real from_x = select<N>(turned, bx, ax);
      const Real from_y = select<N>(turned, by, ay);
      left_x = from_y - select<N>(turned, ay, by);
      left_y = select<N>(turned, ax, bx) - from_x;
      from = left_x * from_x + left_y * from_y;
    }

    // Whether a point is to the left of the way from the first corner to the second.
    Mask has_to_its_left(double x, double y) const { return (left_x * x + left_y * y >= from) ^ turned; }
  };

  // Whether the side between two corners touches the part. It does not where a line parts the two: a side of the part,
  // or the side itself. left: whether the centre is to the left of the side.
  template <std::size_t kFrom, std::size_t kTo>
  [[gnu::always_inline]] static Mask touches(const SeenLanes& corners, const SeenPart& part, Mask& left) {
    const SideLine line(corners.x[kFrom], corners.y[kFrom], corners.x[kTo], corners.y[kTo]);
    const Real reach = Real(part.slack) * (absolute(line.left_x) + absolute(line.left_y));
    left = line.has_to_its_left(part.centre_x, part.centre_y);
    Mask parted{};
    Mask all_left = ~Mask{};
    Mask all_right = ~Mask{};
    unrolled<3>([&](auto n) {
      const Real side = line.left_x * part.x[n] + line.left_y * part.y[n] - line.from;
      all_left &= side > reach;
      all_right &= -reach > side;
      parted |= corners.beside[n][kFrom] & corners.beside[n][kTo];
    });
    return ~(parted | all_left | all_right);
  }

  [[gnu::always_inline]] static Mask bits_over(const SeenLanes& corners, const SeenPart& part) {
    Mask left[3];
    Mask bits = (touches<0, 1>(corners, part, left[0]) & seen::kTouches) |
                (touches<1, 2>(corners, part, left[1]) & (2 * seen::kTouches)) |
                (touches<2, 0>(corners, part, left[2]) & (4 * seen::kTouches));
    bits |= ~(left[0] ^ left[1]) & ~(left[1] ^ left[2]) & seen::kOverCentre;
    Mask above = ~Mask{};
    Mask below = ~Mask{};
    unrolled<3>([&](auto n) {
      above &= corners.height[n] > part.most;
      below &= -corners.height[n] > part.most;
    });
    return bits & ~above & ~below;
  }

  static void lie_over(const SeenTriangles& triangles, const SeenPart& part, std::uint8_t* bits) {
    for (std::size_t begin = 0; begin < triangles.count; begin += N) {
      const SeenLanes corners = load_seen(triangles, part, begin);
      Mask beside{};
      unrolled<3>(
          [&](auto side) { beside |= corners.beside[side][0] & corners.beside[side][1] & corners.beside[side][2]; });
      const Mask out = all<N>(beside) ? Mask{} : bits_over(corners, part) & ~beside;
      unrolled<N>([&](auto n) { bits[begin + n] = static_cast<std::uint8_t>(out[n.value]); });
    }
  }

  static int count_over(const SeenTriangles& triangles, double px, double py) {
    Mask sum{};
    for (std::size_t begin = 0; begin < triangles.count; begin += N) {
      Real x[3], y[3];
      unrolled<3>([&](auto n) {
        x[n] = Real::load(triangles.x[n] + begin);
        y[n] = Real::load(triangles.y[n] + begin);
      });
      const Mask ab = SideLine(x[0], y[0], x[1], y[1]).has_to_its_left(px, py);
      const Mask bc = SideLine(x[1], y[1], x[2], y[2]).has_to_its_left(px, py);
      const Mask ca = SideLine(x[2], y[2], x[0], y[0]).has_to_its_left(px, py);
      sum += ~(ab | bc | ca) - (ab & bc & ca);
    }
    std::int64_t total = 0;
    unrolled<N>([&](auto n) { total += sum[n.value]; });
    return static_cast<int>(total);
  }
};

}  // namespace isoweave
