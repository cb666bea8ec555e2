// SPDX-License-Identifier: BSD-3-Clause
#include <repel/distance/planes_of_faces.hpp>

#include <gtest/gtest.h>

#include <vector>

#include <support/families.hpp>

namespace repel::detail {
namespace planes_of_faces_test {

using Planes = PlanesOfFaces<16>;
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

TEST(PlanesOfFaces, AreThoseOfEachFace) {
  families::Rng rng(seed);
  for (std::size_t count = 4; count <= 28; ++count) {
    SCOPED_TRACE(families::of_seed(seed, "faces", static_cast<int>(count)));
    const std::vector<Triangle> triangles = draw(rng, count);
    Planes planes;
    for (std::size_t f = 0; f < count; ++f) {
      planes.set(f, plane_of(triangles[f]));
    }
    ASSERT_TRUE(planes.find(count, 0.0));
    double least = 10.0;
    for (std::size_t f = 0; f < count; ++f) {
      const auto& [p, q, r] = triangles[f];
      const Vec<double> n = planes.normal(f);
      EXPECT_NEAR(dot(n, n), 1.0, 1e-15);
      EXPECT_GT(dot(n, cross(q - p, r - p)), 0.0);
      for (const Vec<double>& corner : {p, q, r}) {
        EXPECT_NEAR(dot(n, corner), planes.offset(f), 1e-12);
        EXPECT_LE(dot(n, corner), planes.offset(f) + 1e-15);
      }
      least = std::min(least, planes.offset(f));
    }
    // Wherever the nearest face is, its offset decides.
    for (std::size_t f = 0; f < count; ++f) {
      planes.set(f, plane_of(triangles[f]));
    }
    EXPECT_FALSE(planes.find(count, least + 1e-12));
  }
}

TEST(PlanesOfFaces, RefuseAFaceWithoutArea) {
  families::Rng rng(seed);
  const std::vector<Triangle> triangles = draw(rng, 11);
  for (std::size_t flat = 0; flat < 11; ++flat) {
    Planes planes;
    for (std::size_t f = 0; f < 11; ++f) {
      const auto& [p, q, r] = triangles[f];
      planes.set(f, plane_of({p, q, f == flat ? q : r}));
    }
    EXPECT_FALSE(planes.find(11, -1.0));
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
