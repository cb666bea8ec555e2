// SPDX-License-Identifier: BSD-3-Clause
#include <repel/distance/planes_of_faces.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <support/families.hpp>

namespace repel::detail {
namespace planes_of_faces_test {

constexpr unsigned seed = 6211;
constexpr double margin = 0x1p-48;  ///< [m] of triangles within 4 m of the origin

struct Triangle {
  Vec<double> p, q, r;
};

FacePlane plane_of(const Triangle& t) {
  return plane_through(t.p, t.q, t.r, margin);
}

std::vector<Triangle> draw(families::Rng& rng, std::size_t count) {
  std::vector<Triangle> triangles;
  const auto point = [&] {
    return Vec<double>(Vec3(families::direction(rng) + Vec3(0.0, 0.0, 3.0)));
  };
  while (triangles.size() < count) {
    const Triangle t{point(), point(), point()};
    const Vec<double> n = cross(t.q - t.p, t.r - t.p);
    triangles.push_back(dot(n, t.p) > 0.0 ? t : Triangle{t.p, t.r, t.q});
  }
  return triangles;
}

LaneVec corners(const std::vector<Triangle>& triangles, Vec<double> Triangle::*corner) {
  return LaneVec::of([&](int k) { return triangles[static_cast<std::size_t>(k)].*corner; });
}

LanePlanes planes_of(const std::vector<Triangle>& four) {
  return planes_through(corners(four, &Triangle::p), corners(four, &Triangle::q),
                        corners(four, &Triangle::r), margin);
}

TEST(PlanesThrough, AreThoseOfEachTriangle) {
  families::Rng rng(seed);
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "four", i));
    std::vector<Triangle> four = draw(rng, 4);
    if (i % 2 == 1) four[3].r = four[3].q + 1e-9 * (four[3].r - four[3].q);
    const LanePlanes planes = planes_of(four);
    for (int k = 0; k < 4; ++k) {
      const Triangle& t = four[static_cast<std::size_t>(k)];
      const FacePlane one = plane_of(t);
      const double per_length = 1.0 / std::sqrt(dot(one.n, one.n));
      EXPECT_EQ(planes.n.at(k), to_vec3(per_length * one.n));
      EXPECT_EQ(planes.offset[k], per_length * one.offset);
      const Vec<double> n(planes.n.at(k));
      EXPECT_NEAR(dot(n, n), 1.0, 1e-15);
      for (const Vec<double>& corner : {t.p, t.q, t.r}) {
        EXPECT_NEAR(dot(n, corner), planes.offset[k], 2.0 * margin);
      }
    }
  }
}

TEST(PlanesThrough, HaveNoneForATriangleWithoutArea) {
  families::Rng rng(seed);
  for (int flat = 0; flat < 4; ++flat) {
    std::vector<Triangle> four = draw(rng, 4);
    Triangle& none = four[static_cast<std::size_t>(flat)];
    none.r = none.q;
    EXPECT_EQ(bits_of(planes_of(four).offset > -1.0), 15U & ~(1U << flat));
  }
}

TEST(PlaneThrough, ASliverHoldsForEveryCorner) {
  // Two corners next to each other and one up to 1e9 m away: the normal in double precision misses
  // a corner by more than 1 mm.
  families::Rng rng(seed);
  int missed = 0;
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "sliver", i));
    const Vec3 base = families::direction(rng);
    const double length = std::pow(10.0, families::uniform(rng, 3.0, 9.0));
    const Vec<double> p(base);
    const Vec<double> q(base + length * families::direction(rng));
    const Vec<double> r(to_vec3(q) + 1e-3 * families::direction(rng));
    const Vec<double> rough = cross(q - p, r - p);
    const double rough_length = std::sqrt(dot(rough, rough));
    const double size = 0x1p-49 * length;
    missed += std::abs(dot(rough, q - p)) > 2.0 * size * rough_length ? 1 : 0;
    const auto [n, offset] = plane_through(p, q, r, size);
    const double unit = std::sqrt(dot(n, n));
    ASSERT_GT(unit, 0.0);
    for (const Vec<double>& corner : {p, q, r}) {
      EXPECT_LE(dot(n, corner), offset);
      EXPECT_GE(dot(n, corner), offset - size * unit);
    }
  }
  EXPECT_GT(missed, 500);
}

}  // namespace planes_of_faces_test
}  // namespace repel::detail
