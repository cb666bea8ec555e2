// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/fixture_path.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>

#include "support/families.hpp"

namespace repel::network {
namespace fixture_path_test {

constexpr unsigned seed = 9;

std::vector<Vec3> drawn_points(families::Rng& rng) {
  std::vector<Vec3> points{{0, 0, 0}};
  const int count = families::count_between(rng, 1, 12);
  for (int i = 0; i < count; ++i) {
    points.push_back(points.back() +
                     Vec3(families::uniform(rng, 0.02, 0.1) * families::direction(rng)));
  }
  return points;
}

TEST(FixturePath, PassesItsPointsWithTheDerivativesItStates) {
  families::Rng rng(seed);
  for (int draw = 0; draw < 200; ++draw) {
    const std::vector<Vec3> points = drawn_points(rng);
    for (const Course course : {Course::straight, Course::spline}) {
      const FixturePath path(points, {}, course);
      SCOPED_TRACE(families::of_seed(seed, "draw", draw));
      ASSERT_EQ(path.pieces() + 1, points.size());
      for (std::size_t i = 0; i < path.pieces(); ++i) {
        const double length = norm(Vec3(points[i + 1] - points[i]));
        ASSERT_LE(norm(Vec3(path.at({i, 0.0}).p_W - points[i])), 1e-12);
        ASSERT_LE(norm(Vec3(path.at({i, length}).p_W - points[i + 1])), 1e-12);
        const double h = 1e-6, u = 0.4 * length;
        const PathPoint here = path.at({i, u}), on = path.at({i, u + h}),
                        back = path.at({i, u - h});
        ASSERT_LE(norm(Vec3((on.p_W - back.p_W) / (2.0 * h) - here.first_W)), 1e-6);
        ASSERT_LE(norm(Vec3((on.first_W - back.first_W) / (2.0 * h) - here.second_W)), 1e-4);
        if (course == Course::straight || i == 0) continue;
        const double before = norm(Vec3(points[i] - points[i - 1]));
        const PathPoint end = path.at({i - 1, before}), begin = path.at({i, 0.0});
        ASSERT_LE(norm(Vec3(end.first_W - begin.first_W)), 1e-9);
        ASSERT_LE(norm(Vec3(end.second_W - begin.second_W)), 1e-6);
      }
    }
  }
}

TEST(FixturePath, FindsTheNearestPlace) {
  families::Rng rng(seed);
  for (int draw = 0; draw < 300; ++draw) {
    const FixturePath path(drawn_points(rng), {},
                           draw % 2 == 0 ? Course::straight : Course::spline);
    const Vec3 x = families::uniform(rng, 0.0, 0.2) * families::direction(rng);
    const double found = norm(Vec3(path.at(path.nearest(x)).p_W - x));
    double least = 1e9;
    for (std::size_t i = 0; i < path.pieces(); ++i) {
      for (double u = 0.0; u <= path.length(i); u += 1e-4) {
        least = std::min(least, norm(Vec3(path.at({i, u}).p_W - x)));
      }
    }
    EXPECT_LE(found, least + 2e-4) << families::of_seed(seed, "draw", draw);
  }
}

// It stays at the local nearest, never moves away, and no farther than it may.
TEST(FixturePath, FollowsDownhillAndNoFasterThanAsked) {
  families::Rng rng(seed);
  int held_back = 0, followed = 0;
  for (int draw = 0; draw < 200; ++draw) {
    const FixturePath path(drawn_points(rng), {},
                           draw % 2 == 0 ? Course::straight : Course::spline);
    Vec3 x = families::uniform(rng, 0.0, 0.1) * families::direction(rng);
    PathPlace place = path.nearest(x);
    Vec3 v = 1e-3 * families::direction(rng);
    for (int tick = 0; tick < 500; ++tick) {
      if (tick % 50 == 0) v = families::uniform(rng, 1e-4, 2e-3) * families::direction(rng);
      x += v;
      const double motion = norm(v);
      const PathPlace next = path.followed(place, x, 2.0 * motion);
      const Vec3 from = path.at(place).p_W, to = path.at(next).p_W;
      SCOPED_TRACE(families::of_seed(seed, "draw", draw));
      ASSERT_LE(norm(Vec3(to - from)), 2.0 * motion * (1.0 + 1e-6)) << tick;
      ASSERT_LE(norm(Vec3(to - x)), norm(Vec3(from - x)) * (1.0 + 1e-12)) << tick;
      const PathPoint point = path.at(next);
      const bool is_nearest =
          std::abs(dot(Vec3(point.p_W - x), point.first_W)) < 1e-6 || path.is_at_corner(next);
      (is_nearest ? followed : held_back) += 1;
      place = next;
    }
    EXPECT_EQ(path.followed(place, x, 0.0), place);
  }
  EXPECT_GT(followed, 50000);
  EXPECT_GT(held_back, 500);
}

TEST(FixturePath, TurnsItsFramesAndStandsAtItsPoints) {
  const Mat3 half = Eigen::AngleAxisd(0.5, Vec3::UnitX()).toRotationMatrix();
  const FixturePath path({{0, 0, 0}, {0.1, 0, 0}}, {Mat3::Identity(), half}, Course::straight);
  EXPECT_TRUE(path.frame({0, 0.1}).isApprox(half, 1e-12));
  EXPECT_TRUE(path.frame({0, 0.05}).isApprox(
      Mat3(Eigen::AngleAxisd(0.25, Vec3::UnitX()).toRotationMatrix()), 1e-12));
  EXPECT_NEAR(path.turning({0, 0.0}).norm(), 0.0, 1e-12);
  EXPECT_NEAR(path.turning({0, 0.1}).norm(), 0.0, 1e-12);
  const double h = 1e-6;
  for (const double u : {0.02, 0.05, 0.09}) {
    const Eigen::AngleAxisd on(Mat3(path.frame({0, u + h}) * transposed(path.frame({0, u - h}))));
    EXPECT_NEAR(path.turning({0, u}).x(), on.angle() / (2.0 * h), 1e-5);
  }
}

TEST(FixturePath, RefusesWhatIsNoPath) {
  EXPECT_THROW(FixturePath({{0, 0, 0}}, {}, Course::spline), SetupError);
  EXPECT_THROW(FixturePath({{0, 0, 0}, {0, 0, 0}}, {}, Course::spline), SetupError);
  EXPECT_THROW(FixturePath({{0, 0, 0}, {1, 0, 0}}, {Mat3::Identity()}, Course::spline), SetupError);
  const std::vector<Vec3> many(FixturePath::most_points + 1, Vec3(0, 0, 0));
  EXPECT_THROW(FixturePath(many, {}, Course::spline), SetupError);
}

}  // namespace fixture_path_test
}  // namespace repel::network
