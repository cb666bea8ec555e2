// SPDX-License-Identifier: BSD-3-Clause
#include <repel/geometry/vertex_scan.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <support/families.hpp>
#include <support/oracle.hpp>

namespace repel {
namespace vertex_scan_test {

using families::Rng;
using oracle::Real;

constexpr unsigned seed = 41;

std::uint32_t brute_force(const std::vector<Vec3>& vertices, const Vec3& d) {
  std::uint32_t best = 0;
  const auto along = [&](std::uint32_t i) {
    return vertices[i].x() * d.x() + vertices[i].y() * d.y() + vertices[i].z() * d.z();
  };
  for (std::uint32_t i = 1; i < vertices.size(); ++i) {
    if (along(i) > along(best)) best = i;
  }
  return best;
}

std::vector<Vec3> points_on_a_grid(Rng& rng, int count) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    points.emplace_back(families::count_between(rng, -2, 2), families::count_between(rng, -2, 2),
                        families::count_between(rng, -2, 2));
  }
  return points;
}

TEST(VertexScan, FindsWhatBruteForceFindsForEverySize) {
  Rng rng(seed);
  for (int count = 1; count <= 70; ++count) {
    const std::vector<Vec3> vertices = families::cloud(rng, count, 1.0).vertices;
    const VertexScan scan(vertices);
    ASSERT_EQ(scan.size(), count);
    for (int i = 0; i < 50; ++i) {
      const Vec3 d = families::direction(rng);
      ASSERT_EQ(scan.scan(Vec<double>(d)), brute_force(vertices, d))
          << "seed " << seed << ", " << count << " vertices, direction " << d.transpose();
    }
  }
}

TEST(VertexScan, GivesTiesToTheLowestIndexInBothPrecisions) {
  Rng rng(seed);
  int ties = 0;
  for (int count = 1; count <= 70; ++count) {
    const std::vector<Vec3> vertices = points_on_a_grid(rng, count);
    const VertexScan scan(vertices);
    for (int i = 0; i < 30; ++i) {
      const Vec3 d = points_on_a_grid(rng, 1).front();
      const std::uint32_t lowest = brute_force(vertices, d);
      ASSERT_EQ(scan.scan(Vec<double>(d)), lowest) << "seed " << seed << ", " << count;
      ASSERT_EQ(scan.scan(Vec<DoubleDouble>(d)), lowest) << "seed " << seed << ", " << count;
      for (std::uint32_t k = lowest + 1; k < vertices.size(); ++k) {
        ties += vertices[k].dot(d) == vertices[lowest].dot(d) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(ties, 1000);
}

TEST(VertexScan, NeverNamesThePadding) {
  // The first vertex pads the arrays: if it is the farthest, so are its copies.
  for (int count = 1; count <= 20; ++count) {
    std::vector<Vec3> vertices(count, Vec3(-1, 0, 0));
    vertices.front() = Vec3(1, 0, 0);
    EXPECT_EQ(VertexScan(vertices).scan(Vec<double>(1, 0, 0)), 0U) << count;
    const std::uint32_t far = VertexScan(vertices).scan(Vec<double>(-1, 0, 0));
    EXPECT_EQ(far, count == 1 ? 0U : 1U) << count;
  }
}

TEST(VertexScan, KeepsItsVerticesAsGiven) {
  Rng rng(seed);
  const std::vector<Vec3> vertices = families::cloud(rng, 19, 3.0).vertices;
  const VertexScan scan(vertices);
  for (std::uint32_t i = 0; i < 19; ++i) EXPECT_EQ(to_vec3(scan.vertex(i)), vertices[i]);
}

TEST(VertexScan, ADirectionThatIsNotANumberNamesSomeVertex) {
  Rng rng(seed);
  const VertexScan scan(families::cloud(rng, 11, 1.0).vertices);
  const double nan = std::nan("");
  EXPECT_LT(scan.scan(Vec<double>(nan, nan, nan)), 11U);
  EXPECT_LT(scan.scan(Vec<DoubleDouble>(nan, nan, nan)), 11U);
}

TEST(VertexScan, ExtendedPrecisionDecidesWhatDoubleCannot) {
  Rng rng(seed);
  int undecided_in_double = 0;
  for (int i = 0; i < 500; ++i) {
    // Vertices in one plane up to a few ulps, seen along its normal.
    const Vec3 n = families::direction(rng);
    std::vector<Vec3> vertices;
    for (int k = 0; k < 21; ++k) {
      const Vec3 r = families::direction(rng);
      vertices.push_back(n + (r - n.dot(r) * n));
    }
    const Vec<DoubleDouble> d{DoubleDouble::sum(n.x(), 1e-18), DoubleDouble::sum(n.y(), -1e-18),
                              DoubleDouble(n.z())};
    const auto along = [&](std::uint32_t k) {
      return vertices[k].x() * (Real(d.x().hi) + d.x().lo) +
             vertices[k].y() * (Real(d.y().hi) + d.y().lo) +
             vertices[k].z() * (Real(d.z().hi) + d.z().lo);
    };
    std::uint32_t best = 0;
    for (std::uint32_t k = 1; k < vertices.size(); ++k) best = along(k) > along(best) ? k : best;
    const VertexScan scan(vertices);
    ASSERT_EQ(scan.scan(d), best) << "seed " << seed << ", sample " << i;
    undecided_in_double += scan.scan(Vec<double>(n)) == best ? 0 : 1;
  }
  EXPECT_GT(undecided_in_double, 50);
}

TEST(VertexBlock, LargestProductsAreThoseOfTheFarthestVertex) {
  Rng rng(seed);
  for (int count = 1; count <= 70; ++count) {
    const VertexScan scan(families::cloud(rng, count, 1.0).vertices);
    const auto direction = [&](int) { return Vec<double>(families::direction(rng)); };
    const detail::LaneVec d = detail::LaneVec::of(direction);
    const detail::Lanes products = scan.block().largest_products(d);
    const auto each = d.each();
    for (int k = 0; k < detail::lane_count; ++k) {
      const Vec<double>& one = each[static_cast<std::size_t>(k)];
      const Vec<double> farthest = scan.vertex(scan.scan(one));
      EXPECT_NEAR(products[k], dot(farthest, one), 4e-16) << "seed " << seed << ", " << count;
      EXPECT_NEAR(scan.block().largest_product(one), products[k], 4e-16);
    }
  }
}

TEST(VertexBlock, TurnsItsVertices) {
  Rng rng(seed);
  for (int count = 1; count <= 70; ++count) {
    const VertexScan scan(families::cloud(rng, count, 1.0).vertices);
    Pose X = Pose::Identity();
    X.linear() = families::rotation(rng);
    X.translation() = Vec3(1, 2, 3);
    std::vector<double> room(3 * scan.block().stride);
    const VertexBlock turned = scan.block().turned(X, room.data());
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
      const Vec3 expected = X.linear() * to_vec3(scan.vertex(i));
      EXPECT_LE((to_vec3(turned.vertex(i)) - expected).norm(), 1e-15) << seed << ", " << count;
    }
  }
}

}  // namespace vertex_scan_test
}  // namespace repel
