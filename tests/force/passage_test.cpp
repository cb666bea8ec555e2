// SPDX-License-Identifier: BSD-3-Clause
#include <repel/force/passage.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <repel/reduction/shape.hpp>
#include "support/families.hpp"

namespace repel {
namespace passage_test {

using families::Rng;
using families::uniform;

constexpr unsigned seed = 4511;
constexpr ForceLaw membrane_law{
    .range = 0.015, .surface_force = 60.0, .damping = 20.0, .ceiling = 12.0, .passable = true};
constexpr ForceLaw tissue_law{
    .range = 0.015, .surface_force = 20.0, .damping = 20.0, .ceiling = 5.0, .passable = true};

/// A fixed body around the origin, thin along z.
struct Body {
  const char* name;
  Shape shape;
  ForceLaw law;
};

const std::vector<Body>& bodies() {
  static const std::vector<Body> all{
      {"membrane", Shape::box({0.08, 0.1, 0.002}), membrane_law},
      {"tissue", Shape::box({0.08, 0.1, 0.05}), tissue_law},
  };
  return all;
}

struct Tool {
  const char* name;
  Shape shape;
};

const std::vector<Tool>& tools() {
  static const std::vector<Vec3> corners{
      {-0.02, -0.02, -0.03}, {0.02, -0.02, -0.03}, {0.0, 0.025, -0.03}, {0.0, 0.0, 0.03}};
  static const std::vector<Tool> all{{"box", Shape::box({0.012, 0.011, 0.03})},
                                     {"cube", Shape::box({0.012, 0.012, 0.012})},
                                     {"hull", Shape::hull(corners)},
                                     {"capsule", Shape::capsule(0.01, 0.02)},
                                     {"cylinder", Shape::cylinder(0.01, 0.02)}};
  return all;
}

/// Start pose of a tool, and the corners of its path [m].
struct Way {
  std::string name;
  Mat3 R = Mat3::Identity();
  std::vector<Vec3> corners;
};

std::vector<Way> ways_through() {
  const Mat3 turned = Eigen::AngleAxisd(0.4, Vec3(1.0, 0.5, 0.2).normalized()).matrix();
  std::vector<Way> ways;
  for (const Mat3& R : {Mat3(Mat3::Identity()), turned}) {
    ways.push_back({"straight", R, {{0.003, 0.002, 0.2}, {0.003, 0.002, -0.2}}});
    ways.push_back({"oblique", R, {{-0.12, 0.03, 0.15}, {0.12, -0.02, -0.15}}});
    ways.push_back({"grazing an edge", R, {{0.084, 0.01, 0.2}, {0.084, 0.01, -0.2}}});
    ways.push_back({"deep past an edge", R, {{0.074, 0.01, 0.2}, {0.074, 0.01, -0.2}}});
    ways.push_back({"over a corner", R, {{0.081, 0.102, 0.2}, {0.078, 0.099, -0.2}}});
  }
  return ways;
}

/// Statistics of the force in a slow passage.
struct Felt {
  double jump = 0.0;  ///< [N] largest change of the force from step to step
  double peak = 0.0;  ///< [N]
  double gain = 0.0;  ///< [J] work of the force on the tool
  double flow = 0.0;  ///< [J] the same with absolute values
  Vec3 last{0, 0, 0};
};

Felt felt(const Body& body, const Shape& tool, const Way& way, Measure measure, double step) {
  ForceLaw law = body.law;
  law.depth = std::min(law.depth, tool.deepest() + body.shape.deepest());
  const QueryOptions options{.measure = measure};
  const Pose X_WB = Pose::Identity();
  Pose X_WA = Pose::Identity();
  X_WA.linear() = way.R;
  Passage passage;
  WarmStart warm;
  Felt result;
  double travel = 0.0;
  int iterations = 0;
  for (std::size_t leg = 1; leg < way.corners.size(); ++leg) {
    const Vec3& from = way.corners[leg - 1];
    const Vec3 along = way.corners[leg] - from;
    const int steps = static_cast<int>(std::ceil(along.norm() / step));
    for (int i = 1; i <= steps; ++i) {
      X_WA.translation() = from + along * i / steps;
      travel += along.norm() / steps;
      const Separation s = separation(tool, X_WA, body.shape, X_WB, options, warm);
      const double slope = slope_of(s, {tool, X_WA}, {body.shape, X_WB}, options, warm, iterations);
      const Vec3 gradient_W = slope * s.extraction_W;
      const Vec3 f = law.passable ? passage.force(law, s.distance, gradient_W, travel, Vec3::Zero())
                                  : Vec3(law(s.distance, 0.0) * s.extraction_W);
      const double work = 0.5 * (f + result.last).dot(along / steps);
      result.jump = std::max(result.jump, (f - result.last).norm());
      result.peak = std::max(result.peak, f.norm());
      result.gain += work;
      result.flow += std::abs(work);
      result.last = f;
    }
  }
  return result;
}

constexpr Measure measures[] = {Measure::deepest_point, Measure::reduction};

/// Calls `check(body, tool, path, measure)` for every path through every body.
template <class Check>
void for_all_passages(const Check& check) {
  for (const Body& body : bodies()) {
    for (const Tool& tool : tools()) {
      for (const Way& way : ways_through()) {
        for (const Measure measure : measures) {
          SCOPED_TRACE(std::string(tool.name) + " through " + body.name + ", " + way.name +
                       (way.R.isIdentity() ? "" : ", turned") +
                       (measure == Measure::reduction ? ", by levels" : ""));
          check(body, tool.shape, way, measure);
        }
      }
    }
  }
}

TEST(Passage, ChangesNoMoreThanStiffnessTimesMotionOnEveryWay) {
  for_all_passages([](const Body& body, const Shape& tool, const Way& way, Measure measure) {
    for (const double step : {2e-4, 1e-4}) {
      const Felt f = felt(body, tool, way, measure, step);
      EXPECT_LE(f.jump, 1.0001 * body.law.stiffness() * step);
      EXPECT_NEAR(f.peak, body.law.ceiling, 1e-9);
      EXPECT_EQ(f.last.norm(), 0.0) << "beyond the body";
    }
  });
}

TEST(Passage, TheCeilingAloneTurnsRoundAtOnce) {
  for (Body body : bodies()) {
    body.law.passable = false;
    for (const double step : {2e-4, 1e-4}) {
      const Felt f =
          felt(body, tools().front().shape, ways_through().front(), Measure::deepest_point, step);
      EXPECT_NEAR(f.jump, 2.0 * body.law.ceiling, 1e-9);
    }
  }
}

TEST(Passage, StraightThroughWithFlatSidesGivesBackAllItTook) {
  for (const Body& body : bodies()) {
    for (const Tool& tool : tools()) {
      if (std::string(tool.name) == "hull") continue;
      for (const Measure measure : measures) {
        const Felt f = felt(body, tool.shape, ways_through().front(), measure, 1e-4);
        EXPECT_GT(f.flow, 0.1 * body.law.ceiling * body.law.range);
        EXPECT_NEAR(f.gain, 0.0, 1e-4 * f.flow) << tool.name << " through " << body.name;
      }
    }
  }
}

// A hull that is pointed in front and flat behind has different extraction directions on entry and
// exit.
TEST(Passage, NoWayThroughGivesMoreThanItTookAndFewTakeMuch) {
  for_all_passages([](const Body& body, const Shape& tool, const Way& way, Measure measure) {
    const Felt f = felt(body, tool, way, measure, 1e-4);
    // With levels the distance has steps, and the depth is not a concave function.
    const bool by_levels = measure == Measure::reduction || tool.planes().empty();
    EXPECT_LE(f.gain, (by_levels ? 0.05 : 1e-3) * f.flow);
    EXPECT_GE(f.gain, -0.1 * f.flow);
  });
}

/// A closed path among random points in and around a body, starting and ending out of range.
Way random_walk(Rng& random, const Vec3& half_extents) {
  Way way{"random", families::rotation(random), {{0.0, 0.0, 0.25}}};
  for (int i = 0; i < 12; ++i) {
    Vec3 corner;
    for (int axis = 0; axis < 3; ++axis) {
      corner[axis] = uniform(random, -1.0, 1.0) * (half_extents[axis] + 0.03);
    }
    way.corners.push_back(corner);
  }
  way.corners.push_back(way.corners.front());
  return way;
}

TEST(Passage, NoClosedWayGivesEnergy) {
  Rng random(seed);
  double taken = 0.0;
  double flow = 0.0;
  for (int run = 0; run < 60; ++run) {
    const Body& body = bodies()[run % 2];
    const Vec3 half_extents = run % 2 == 0 ? Vec3(0.08, 0.1, 0.002) : Vec3(0.08, 0.1, 0.05);
    const Tool& tool = tools()[run / 2 % 4];  // those measured by the deepest point
    const Way way = random_walk(random, half_extents);
    const Felt f = felt(body, tool.shape, way, Measure::deepest_point, 1e-4);
    EXPECT_LE(f.gain, 1e-3 * f.flow)
        << tool.name << " in " << body.name << ", run " << run << ", seed " << seed;
    EXPECT_LE(f.jump, 1.0001 * body.law.stiffness() * 1e-4);
    taken -= f.gain;
    flow += f.flow;
  }
  EXPECT_GT(flow, 1.0);
  EXPECT_GT(taken, 0.0);
}

TEST(Passage, StandsStillWithTheBodiesAndCatchesUpWithThem) {
  ForceLaw law = membrane_law;
  law.depth = 0.02;
  const Vec3 up = Vec3::UnitZ();
  const Vec3 aside = Vec3::UnitX();
  Passage passage;
  EXPECT_EQ(passage.follow(law, -0.005, up, 1.0), 12.0 * up) << "the first call has no past";
  EXPECT_EQ(passage.follow(law, -0.005, aside, 1.0), 12.0 * up);
  const double whole = 12.0 * std::sqrt(2.0) / law.stiffness();
  EXPECT_NEAR((passage.follow(law, -0.005, aside, 1.0 + 0.5 * whole) - 6.0 * (up + aside)).norm(),
              0.0, 1e-9);
  EXPECT_NEAR((passage.follow(law, -0.005, aside, 1.0 + whole) - 12.0 * aside).norm(), 0.0, 1e-9);
  EXPECT_EQ(passage.follow(law, -0.02, aside, 2.0).norm(), 0.0);
}

TEST(Passage, NeverPullsAndDampsOnlyAsMuchAsItPushes) {
  Rng random(seed);
  ForceLaw law = membrane_law;
  law.depth = 0.02;
  Passage passage;
  double travel = 0.0;
  for (int i = 0; i < 10000; ++i) {
    travel += uniform(random, 0.0, 1e-3);
    const double distance = uniform(random, -0.02, 0.02);
    const Vec3 gradient_W = uniform(random, 0.0, 1.0) * families::direction(random);
    const Vec3 v_BA_W = uniform(random, 0.0, 2.0) * families::direction(random);
    Passage undamped = passage;
    const Vec3 spring_W = undamped.follow(law, distance, gradient_W, travel);
    const Vec3 f = passage.force(law, distance, gradient_W, travel, v_BA_W);
    ASSERT_LE(f.norm(), law.ceiling + 1e-12) << "seed " << seed;
    ASSERT_GE(f.dot(spring_W), 0.0);
    ASSERT_LE(f.cross(spring_W).norm(), 1e-9);
    ASSERT_LE((f - spring_W).dot(v_BA_W), 1e-12) << "the damper gives energy, seed " << seed;
  }
}

TEST(Passage, SlopeIsThatOfTheDistance) {
  const Shape tool = Shape::box({0.01, 0.01, 0.03});
  const Shape plate = Shape::box({0.1, 0.1, 0.002});
  // On an edge: once the plate's thickness is exhausted, the depth of a point grows only by its
  // distance to the two sides of the edge.
  const Mat3 on_edge = Eigen::AngleAxisd(std::numbers::pi / 4.0, Vec3::UnitY()).matrix();
  const double to_edge = std::sqrt(0.5) * (0.01 + 0.03);
  const auto slope_at = [&](double height) {
    Pose X_WA = Pose::Identity();
    X_WA.linear() = on_edge;
    X_WA.translation().z() = height + 0.002 + to_edge;
    WarmStart warm;
    int iterations = 0;
    const Separation s = separation(tool, X_WA, plate, Pose::Identity(), {}, warm);
    return slope_of(s, {tool, X_WA}, {plate, Pose::Identity()}, {}, warm, iterations);
  };
  EXPECT_EQ(slope_at(0.001), 1.0);
  EXPECT_NEAR(slope_at(-0.001), 1.0, 1e-6);
  EXPECT_NEAR(slope_at(-0.01), std::sqrt(0.5), 1e-6);
}

}  // namespace passage_test
}  // namespace repel
