// SPDX-License-Identifier: BSD-3-Clause
#include <repel/distance/cylinder_foot.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include <repel/distance/gjk.hpp>

#include <support/families.hpp>

namespace repel::detail {
namespace cylinder_foot_test {

using families::Rng;
using families::uniform;

constexpr unsigned seed = 1963;

Vec<double> drawn(Rng& rng, double largest) {
  return {uniform(rng, -largest, largest), uniform(rng, -largest, largest),
          uniform(rng, -largest, largest)};
}

/// The least distance [m] of the feature and the cylinder over a grid of weights.
double by_grid(const std::vector<Vec<double>>& corners, double radius, double half_length) {
  constexpr int steps = 200;
  double least = 1e9;
  const auto look = [&](const Vec<double>& x) {
    const double across = std::max(0.0, std::hypot(x.x(), x.y()) - radius);
    least = std::min(least, std::hypot(across, std::max(0.0, std::abs(x.z()) - half_length)));
  };
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      Vec<double> x = corners[0];
      if (corners.size() > 1) x = x + (1.0 * i / steps) * (corners[1] - corners[0]);
      if (corners.size() > 2) x = x + (1.0 * j / steps) * (corners[2] - corners[0]);
      look(x);
    }
  }
  return least;
}

TEST(CylinderFoot, IsTheNearestPointOfBoth) {
  Rng rng(seed);
  const Convex cylinder = Convex::cylinder(0.3, 0.5);
  std::array<int, 4> found{};
  for (int k = 0; k < 600; ++k) {
    std::vector<Vec<double>> corners(1 + k % 3);
    for (auto& corner : corners) corner = drawn(rng, 2.0);
    const double least = by_grid(corners, 0.3, 0.5);
    if (least < 0.05) continue;
    const CylinderFoot foot = CylinderFootSearch(cylinder).run(corners);
    if (!foot.found || minus_signs(foot.weights) != 0U) continue;
    ++found[corners.size()];
    const Vec<double>& c = foot.on_cylinder;
    EXPECT_LE(std::hypot(c.x(), c.y()), 0.3 + 1e-15);
    EXPECT_LE(std::abs(c.z()), 0.5);
    EXPECT_NEAR(sum(foot.weights), 1.0, 1e-14);
    Vec<double> p = foot.weights.x() * corners[0];
    if (corners.size() > 1) p = p + foot.weights.y() * corners[1];
    if (corners.size() > 2) p = p + foot.weights.z() * corners[2];
    const double distance = std::sqrt(dot(p - c, p - c));
    EXPECT_LE(distance, least + 1e-14) << "seed " << seed << ", draw " << k;
    EXPECT_GE(distance, least - 0.05) << "seed " << seed << ", draw " << k;
    EXPECT_LE(norm(to_vec3(p - c - foot.v)), 1e-9);
  }
  EXPECT_EQ(found[1] > 150 && found[2] > 150 && found[3] > 20, true)
      << found[1] << ", " << found[2] << ", " << found[3];
}

TEST(CylinderFoot, OfAnEdgeAlongTheAxisIsBesideIt) {
  const Convex cylinder = Convex::cylinder(0.3, 0.5);
  const std::array corners{Vec<double>(0.4, 0.3, -2.0), Vec<double>(0.4, 0.3, 3.0)};
  const CylinderFoot foot = CylinderFootSearch(cylinder).run(corners);
  ASSERT_TRUE(foot.found);
  EXPECT_NEAR(norm(to_vec3(foot.v)), 0.2, 1e-15);
  EXPECT_EQ(foot.v.z(), 0.0);
}

TEST(CylinderFoot, OfAFaceMayBeBeyondItsCorners) {
  const Convex cylinder = Convex::cylinder(0.3, 0.5);
  const std::array leaning{Vec<double>(1, 0, 1), Vec<double>(2, 0, 1.1), Vec<double>(1, 1, 1)};
  const CylinderFoot foot = CylinderFootSearch(cylinder).run(leaning);
  ASSERT_TRUE(foot.found);
  EXPECT_LT(foot.weights.y(), 0.0);
  EXPECT_NEAR(foot.on_cylinder.x(), -0.3, 1e-15);
  const std::array through{Vec<double>(-1, -1, 0.4), Vec<double>(2, -1, 0.4),
                           Vec<double>(-1, 2, 0.4)};
  EXPECT_FALSE(CylinderFootSearch(cylinder).run(through).found) << "it meets the cylinder";
}

TEST(CylinderFoot, OfFourCornersThatAreNoNumbersIsNotAsked) {
  const Convex box = Convex::box({1, 1, 1});
  const Convex post = Convex::cylinder(0.3, 0.5);
  Pose X_WB = Pose::Identity();
  X_WB.translation().x() = std::nan("");
  WarmStart warm;
  warm.size = 4;
  warm.a = {0, 1, 2, 7};
  const Gap gap = gap_between(box, Pose::Identity(), post, X_WB, {.iterations = 8}, warm);
  EXPECT_FALSE(gap.meets);
  EXPECT_FALSE(gap.lower > 0.0);
}

// A finger beside a post, all but parallel: points of a rim, one after the other, took 26 support
// points to meet the bracket of an exact answer, a tick later 24 again, and one pair in six went on
// in extended precision.
TEST(CylinderFoot, LetsASearchBesideACylinderEndAtOnce) {
  Rng rng(seed);
  const Convex finger = Convex::box({0.012, 0.011, 0.065});
  const Convex post = Convex::cylinder(0.04, 0.05);
  const auto lean = [&](double most) {
    return (Eigen::AngleAxisd(uniform(rng, -most, most), Vec3::UnitX()) *
            Eigen::AngleAxisd(uniform(rng, -most, most), Vec3::UnitY()))
        .toRotationMatrix();
  };
  constexpr int pairs = 2000;
  int cold = 0;
  int warm = 0;
  for (int k = 0; k < pairs; ++k) {
    Pose X_WA = Pose::Identity();
    X_WA.linear() = lean(0.05);
    const double angle = uniform(rng, -M_PI, M_PI);
    const double away = uniform(rng, 0.06, 0.1);
    X_WA.translation() =
        Vec3(away * std::cos(angle), away * std::sin(angle), uniform(rng, -0.08, 0.08));
    WarmStart start;
    const QueryOptions options{.tolerance = 1e-16};
    const auto gap = [&] {
      return k % 2 == 0 ? gap_between(finger, X_WA, post, Pose::Identity(), options, start)
                        : gap_between(post, Pose::Identity(), finger, X_WA, options, start);
    };
    const Gap first = gap();
    cold += first.iterations;
    X_WA.translation() += 1e-3 * families::direction(rng);
    X_WA.linear() = (X_WA.linear() * lean(1e-3)).eval();
    const Gap second = gap();
    warm += second.iterations;
    EXPECT_FALSE(first.extended || second.extended) << "seed " << seed << ", draw " << k;
    EXPECT_EQ(second.end, QueryEnd::converged);
  }
  EXPECT_LT(cold, 4 * pairs);
  EXPECT_LT(warm, 1.25 * pairs);
}

}  // namespace cylinder_foot_test
}  // namespace repel::detail
