// Quadrics over position and normal against sums over faces that are written out.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "simplify/normal_quadric.hpp"

namespace isoweave::testing::simplify_normal_quadric_test {
namespace {

struct Face {
  Vec3 corners[3];
  Vec3 normals[3];
  double weight;
};

// The normal that is linear over the plane of a face and constant across it.
Vec3 normal_over(const Face& face, const Vec3& x) {
  const Vec3 a = face.corners[1] - face.corners[0], b = face.corners[2] - face.corners[0], p = x - face.corners[0];
  const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), pa = dot(p, a), pb = dot(p, b);
  const double s = (bb * pa - ab * pb) / (aa * bb - ab * ab);
  const double t = (aa * pb - ab * pa) / (aa * bb - ab * ab);
  return face.normals[0] + s * (face.normals[1] - face.normals[0]) + t * (face.normals[2] - face.normals[0]);
}

class NormalQuadrics : public ::testing::Test {
 protected:
  Vec3 point() { return {uniform_(random_), uniform_(random_), uniform_(random_)}; }

  // Faces around a corner, and their quadrics with the origin there.
  void add_faces(const Vec3& corner, int count, Quadric& q, NormalQuadric& n) {
    const Vec3 normal = point();
    for (int f = 0; f < count; ++f) {
      const Face face{{corner, point(), point()}, {normal, point(), point()}, 0.1 + f};
      add_face(face.corners[1] - corner, face.corners[2] - corner, face.normals, face.weight, q, n);
      faces_.push_back(face);
    }
  }

  // Sum over the faces of weight * |normal over the face - s|^2
  double error_of(const Vec3& x, const Vec3& s) const {
    double sum = 0;
    for (const Face& face : faces_) {
      const Vec3 off = normal_over(face, x) - s;
      sum += face.weight * dot(off, off);
    }
    return sum;
  }

  Vec3 best_normal(const Vec3& x) const {
    Vec3 sum;
    double weight = 0;
    for (const Face& face : faces_) {
      sum = sum + face.weight * normal_over(face, x);
      weight += face.weight;
    }
    return (1 / weight) * sum;
  }

  std::mt19937 random_{11};
  std::uniform_real_distribution<double> uniform_{-1, 1};
  std::vector<Face> faces_;
};

TEST_F(NormalQuadrics, AreTheErrorOfTheBestNormal) {
  const Vec3 u = point(), v = point();
  Quadric uq, vq;
  NormalQuadric un, vn;
  add_faces(u, 4, uq, un);
  add_faces(v, 5, vq, vn);
  const Vec3 edge = v - u;
  const NormalQuadric normals = un + moved(vn, -edge);
  const Quadric left = with_best_normal(uq + moved(vq, -edge), normals);
  for (int n = 0; n < 20; ++n) {
    const Vec3 x = point();
    const Vec3 best = best_normal(x);
    EXPECT_NEAR(evaluate(left, x - u), error_of(x, best), 1e-9);
    EXPECT_GT(error_of(x, best + 0.01 * point()), error_of(x, best));
    const Vec3 found = (1 / normals.weight) * moved(normals, x - u).offset;
    EXPECT_NEAR(dot(found - best, found - best), 0, 1e-18);
  }
}

TEST_F(NormalQuadrics, CostOfACollapseIsTheLeastValue) {
  const Vec3 u = point(), v = point();
  Quadric uq = plane_quadric(point(), 1.0), vq = plane_quadric(point(), 2.0);
  NormalQuadric un, vn;
  add_faces(u, 4, uq, un);
  add_faces(v, 4, vq, vn);
  const double cost = collapse_cost(uq, un, vq, vn, v - u);
  const Quadric left = with_best_normal(uq + moved(vq, u - v), un + moved(vn, u - v));
  for (int n = 0; n < 50; ++n) EXPECT_GE(evaluate(left, 2.0 * point()), cost * (1 - 1e-3));
}

TEST_F(NormalQuadrics, WithoutFacesNothingIsTakenAway) {
  const Quadric q = plane_quadric(point(), 1.0);
  EXPECT_EQ(evaluate(with_best_normal(q, {}), {1, 2, 3}), evaluate(q, {1, 2, 3}));
}

}  // namespace
}  // namespace isoweave::testing::simplify_normal_quadric_test
