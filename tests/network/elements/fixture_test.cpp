// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/fixture.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>

#include "support/families.hpp"

namespace repel::network {
namespace fixture_test {

constexpr unsigned seed = 13;

/// One of each kind, with and without what it holds of the turning, in a drawn pose.
std::vector<FixtureOptions> one_of_each(families::Rng& rng) {
  std::vector<FixtureOptions> all;
  for (const FixtureKind kind : {FixtureKind::point, FixtureKind::line, FixtureKind::plane,
                                 FixtureKind::path, FixtureKind::cone}) {
    for (const Alignment alignment : {Alignment::free, Alignment::axis, Alignment::all}) {
      for (const double radius : {0.0, 0.02}) {
        FixtureOptions& fixture = all.emplace_back();
        fixture.name = "fixture " + std::to_string(all.size());
        fixture.kind = kind;
        fixture.alignment = alignment;
        fixture.X_WF = families::random_pose(rng, 0.0, 0.3);
        fixture.half_angle = families::uniform(rng, 0.2, 1.2);
        if (kind != FixtureKind::cone) fixture.radius = radius;
        if (kind != FixtureKind::path) continue;
        fixture.points = {{0, 0, 0}, {0.2, 0.02, 0}, {0.3, -0.05, 0.1}, {0.5, 0, 0.05}};
        Mat3 R = families::rotation(rng);
        for (int i = 0; i < 4; ++i) {
          fixture.frames.push_back(R);
          R = families::small_rotation(rng, 0.4) * R;
        }
      }
    }
  }
  return all;
}

/// Potential of position and orientation.
struct Well {
  explicit Well(const FixtureOptions& options)
      : geometry(options),
        along(options.along(1000.0), options.has_inside()),
        about(options.about(options.alignment == Alignment::free ? 0.0 : 20.0)) {}
  double energy(const Pose& X_WT) {
    geometry.begin(origin(X_WT));
    const FixtureView view = geometry.view(X_WT);
    return along.energy(view.distance) + about.energy(view.angle);
  }
  Wrench force(const Pose& X_WT) {
    geometry.begin(origin(X_WT));
    const FixtureView view = geometry.view(X_WT);
    const double turn = about.force(view.angle);
    return {-along.force(view.distance) * view.away_W - turn * view.turned_W, -turn * view.axis_W};
  }
  FixtureGeometry geometry;
  Attraction along, about;
};

Pose moved(const Pose& X, const Vec3& shift, const Vec3& turn) {
  Pose on = X;
  on.translation() += shift;
  const double angle = norm(turn);
  if (angle > 0.0) on.linear() = Eigen::AngleAxisd(angle, Vec3(turn / angle)) * X.linear();
  return on;
}

TEST(Fixture, ItsForceIsTheGradientOfItsPotential) {
  families::Rng rng(seed);
  for (const FixtureOptions& options : one_of_each(rng)) {
    Well well(options);
    int pulled = 0, turned = 0;
    for (int draw = 0; draw < 300; ++draw) {
      SCOPED_TRACE(options.name + ", " + families::of_seed(seed, "draw", draw));
      // Near a path, where its curvature does not make the place run ahead of the tool.
      Pose X = options.X_WF;
      if (options.kind == FixtureKind::path) {
        X.translation() = well.geometry.path().at({static_cast<std::size_t>(draw) % 3, 0.1}).p_W;
        X.linear() = well.geometry.path().frame({static_cast<std::size_t>(draw) % 3, 0.1});
      }
      const double most = options.kind == FixtureKind::path ? 0.04 : 0.1;
      X = moved(X, families::uniform(rng, 0.0, most) * families::direction(rng),
                families::uniform(rng, 0.0, 0.9) * families::direction(rng));
      const Wrench F = well.force(X);
      pulled += norm(F.force) > 1.0 ? 1 : 0;
      turned += norm(F.torque) > 0.1 ? 1 : 0;
      constexpr double h = 1e-6;
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = h * unit(axis), none(0, 0, 0);
        const double by_moving =
            (well.energy(moved(X, step, none)) - well.energy(moved(X, -step, none))) / (2.0 * h);
        const double by_turning =
            (well.energy(moved(X, none, step)) - well.energy(moved(X, none, -step))) / (2.0 * h);
        ASSERT_NEAR(F.force[axis], -by_moving, 2e-2) << axis;
        ASSERT_NEAR(F.torque[axis], -by_turning, 1e-3) << axis;
      }
    }
    EXPECT_GT(pulled, 30);
    if (options.alignment == Alignment::free) {
      EXPECT_EQ(turned, 0);
    } else {
      EXPECT_GT(turned, 30);
    }
  }
}

TEST(Fixture, IsWithoutForceOnItAndPullsTowardsItBeside) {
  families::Rng rng(seed);
  for (const FixtureOptions& options : one_of_each(rng)) {
    SCOPED_TRACE(options.name);
    Well well(options);
    Pose X = options.X_WF;
    if (options.kind == FixtureKind::path) X.translation() = options.points[1];
    if (options.kind == FixtureKind::path) X.linear() = options.frames[1];
    EXPECT_LE(norm(well.force(X).force), 1e-9);
    EXPECT_LE(norm(well.force(X).torque), 1e-7);
    for (int draw = 0; draw < 100; ++draw) {
      const Pose beside = moved(X, families::uniform(rng, 0.0, 0.06) * families::direction(rng),
                                families::uniform(rng, 0.0, 0.9) * families::direction(rng));
      const double before = well.energy(beside);
      Wrench F = well.force(beside);
      if (norm(F.force) < 1.0 && norm(F.torque) < 0.1) continue;
      const double to = 1e-5 / std::max(1.0, norm(F.force) + 10.0 * norm(F.torque));
      EXPECT_LT(well.energy(moved(beside, to * F.force, to * F.torque)), before);
    }
  }
}

TEST(Fixture, OfAConeIsAsFarAsItsSurface) {
  FixtureOptions cone{.name = "cone", .kind = FixtureKind::cone, .half_angle = 0.5};
  const FixtureGeometry geometry(cone);
  const auto at = [&](const Vec3& p) {
    Pose X = Pose::Identity();
    X.translation() = p;
    return geometry.view(X);
  };
  EXPECT_LE(at({0, 0, 0.1}).distance, 0.0);
  EXPECT_LE(at({0.1 * std::tan(0.5), 0, 0.1}).distance, 1e-15);
  EXPECT_NEAR(at({0, 0, -0.1}).distance, 0.1, 1e-15);
  EXPECT_NEAR(at({0.1, 0, 0}).distance, 0.1 * std::cos(0.5), 1e-15);
  EXPECT_NEAR(at({0.1, 0, 0}).away_W.z(), -std::sin(0.5), 1e-15);
}

// From one leg of a U to the other: the place of the path may not jump across, and the force
// changes by no more than its stiffness times the motion, plus what the place moves.
TEST(Fixture, WhereTheNearestPlaceJumpsTheForceDoesNot) {
  FixtureOptions bend{.name = "bend", .kind = FixtureKind::path};
  bend.points = {{0, 0, 0}, {0.2, 0, 0}, {0.2, 0.04, 0}, {0, 0.04, 0}};
  for (const Course course : {Course::straight, Course::spline}) {
    bend.course = course;
    Well well(bend);
    Vec3 x(0.05, 0.01, 0.0);
    const double motion = 1e-4;
    well.geometry.begin(x);
    Vec3 last(0, 0, 0);
    double most = 0.0, jump_of_nearest = 0.0;
    Vec3 nearest_before = x;
    for (int tick = 0; tick < 400; ++tick) {
      x.y() += motion * (tick < 200 ? 1.0 : -1.0);
      well.geometry.follow(x, motion);
      Pose X = Pose::Identity();
      X.translation() = x;
      const FixtureView view = well.geometry.view(X);
      const Vec3 force = -well.along.force(view.distance) * view.away_W;
      if (tick > 0) most = std::max(most, norm(Vec3(force - last)));
      last = force;
      const FixturePath& path = well.geometry.path();
      const Vec3 nearest = path.at(path.nearest(x)).p_W;
      if (tick > 0)
        jump_of_nearest = std::max(jump_of_nearest, norm(Vec3(nearest - nearest_before)));
      nearest_before = nearest;
    }
    EXPECT_GT(jump_of_nearest, 0.03);
    EXPECT_LE(most, 1000.0 * motion * (1.0 + FixtureGeometry::most_ahead) * 1.001);
  }
}

TEST(Fixture, RefusesNumbersOutOfRangeByName) {
  const auto refuse = [](const FixtureOptions& options) {
    try {
      (void)FixtureGeometry(options);
      ADD_FAILURE() << "not refused";
    } catch (const SetupError& error) {
      EXPECT_NE(std::string(error.what()).find("'seam'"), std::string::npos) << error.what();
    }
  };
  refuse({.name = "seam", .kind = FixtureKind::path});
  refuse({.name = "seam",
          .kind = FixtureKind::path,
          .points = {{0, 0, 0}, {1, 0, 0}},
          .alignment = Alignment::axis});
  refuse({.name = "seam", .radius = -1.0});
  refuse({.name = "seam", .kind = FixtureKind::cone, .half_angle = 1.6});
  refuse({.name = "seam", .stiffness = -1.0});
  refuse({.name = "seam", .most_force = 0.0});
  refuse({.name = "seam", .range = 0.0});
  refuse({.name = "seam", .angular_range = 3.0});
}

}  // namespace fixture_test
}  // namespace repel::network
