// SPDX-License-Identifier: BSD-3-Clause
#include <repel/geometry/orientation.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include <support/families.hpp>

namespace repel {
namespace orientation_test {

using families::Rng;

constexpr unsigned seed = 61;

__extension__ typedef __int128 Wide;

struct Whole {
  std::int64_t x[3];
};

/// The sign for integers below 2^38, whose determinant fits into 127 bits.
int true_sign(const Whole& a, const Whole& b, const Whole& c, const Whole& p) {
  Wide u[3], v[3], w[3];
  for (int k = 0; k < 3; ++k) {
    u[k] = b.x[k] - a.x[k];
    v[k] = c.x[k] - a.x[k];
    w[k] = p.x[k] - a.x[k];
  }
  const Wide determinant = (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] +
                           (u[0] * v[1] - u[1] * v[0]) * w[2];
  return determinant > 0 ? 1 : (determinant < 0 ? -1 : 0);
}

Vec3 real(const Whole& p, double scale) {
  return scale * Vec3(static_cast<double>(p.x[0]), static_cast<double>(p.x[1]),
                      static_cast<double>(p.x[2]));
}

TEST(Orientation, IsThatOfWholeNumbersOnAndNextToThePlane) {
  Rng rng(seed);
  int in_plane = 0;
  int beside = 0;
  for (int i = 0; i < 50000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "points", i));
    const auto number = [&](int bits) {
      return static_cast<std::int64_t>(rng() >> (64 - bits)) - (std::int64_t{1} << (bits - 1));
    };
    Whole a{}, b{}, c{}, p{};
    const std::int64_t s = number(12);
    const std::int64_t t = number(12);
    const int off = i % 3 == 0 ? 0 : (i % 3 == 1 ? 1 : -1);
    for (int k = 0; k < 3; ++k) {
      a.x[k] = number(36);
      b.x[k] = a.x[k] + number(24);
      c.x[k] = a.x[k] + number(24);
      p.x[k] = a.x[k] + s * (b.x[k] - a.x[k]) + t * (c.x[k] - a.x[k]) + (k == i % 2 ? off : 0);
    }
    const int sign = true_sign(a, b, c, p);
    in_plane += sign == 0 ? 1 : 0;
    beside += sign != 0 ? 1 : 0;
    for (const double scale : {1.0, 0x1p-60}) {
      const Vec3 q[4] = {real(a, scale), real(b, scale), real(c, scale), real(p, scale)};
      EXPECT_EQ(orientation(q[0], q[1], q[2], q[3]), sign);
      EXPECT_EQ(orientation(q[1], q[0], q[2], q[3]), -sign);
      EXPECT_EQ(orientation(q[3], q[2], q[1], q[0]), sign);
    }
  }
  EXPECT_GT(in_plane, 15000);
  EXPECT_GT(beside, 30000);
}

TEST(Orientation, SeesTheLastBitOfACoordinate) {
  Rng rng(seed);
  for (int i = 0; i < 1000; ++i) {
    const double height = families::uniform(rng, 0.1, 1.0);
    const auto at = [&] {
      return Vec3(families::uniform(rng, -1, 1), families::uniform(rng, -1, 1), height);
    };
    const Vec3 a = at(), b = at(), c = at();
    const int turn = orientation(a, b, c, Vec3(0, 0, 2));
    Vec3 p = at();
    EXPECT_EQ(orientation(a, b, c, p), 0);
    p.z() = std::nextafter(height, 2.0);
    EXPECT_EQ(orientation(a, b, c, p), turn);
    p.z() = std::nextafter(height, 0.0);
    EXPECT_EQ(orientation(a, b, c, p), -turn);
  }
}

TEST(Orientation, IsZeroOnTheLineOfTwoAndOnEachOfThree) {
  const Vec3 a(0.1, 0.2, 0.3), b(0.7, -0.4, 0.9), c(1.0 / 3.0, 5.0, -2.0);
  for (const Vec3& p : {a, b, c}) EXPECT_EQ(orientation(a, b, c, p), 0);
  EXPECT_EQ(orientation(a, b, Vec3(a), Vec3(7, 8, 9)), 0);
  EXPECT_EQ(orientation(a, a, a, a), 0);
}

TEST(PlaneNormal, IsRightToTheLastBitsForTrianglesOfAnyThinness) {
  Rng rng(seed);
  for (int i = 0; i < 20000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "triangle", i));
    // In the plane z = x / 4 + 1, with few enough bits that the corners are exactly in it.
    const auto at = [&](double x, double y) { return Vec3(x, y, 0.25 * x + 1.0); };
    const double x = std::ldexp(std::round(families::uniform(rng, -1000, 1000)), -10);
    const double y = std::ldexp(std::round(families::uniform(rng, -1000, 1000)), -10);
    const double thin = std::ldexp(1.0, -families::count_between(rng, 10, 45));
    const Vec3 a = at(0, 0), b = at(x, y), c = at(0.5 * x + thin, 0.5 * y);
    if (y == 0.0) continue;
    const Vec3 truth = Vec3(-0.25, 0.0, 1.0).normalized() * (y > 0.0 ? -1.0 : 1.0);
    EXPECT_LE((plane_normal(a, b, c) - truth).norm(), 4e-16);
    EXPECT_LE((plane_normal(c, b, a) + truth).norm(), 4e-16);
  }
}

TEST(PlaneNormal, OfALineIsZero) {
  EXPECT_EQ(plane_normal({0, 0, 0}, {1, 2, 3}, {2, 4, 6}), Vec3(0, 0, 0));
  EXPECT_EQ(plane_normal({1, 2, 3}, {1, 2, 3}, {1, 2, 3}), Vec3(0, 0, 0));
}

}  // namespace orientation_test
}  // namespace repel
