// SPDX-License-Identifier: BSD-3-Clause
// Shapes whose distance has a closed form: one table of guaranteed accuracies, one list of
// placements per pair of kinds.
#include <repel/reduction/separation.hpp>

#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <string>
#include <vector>

#include <repel/reduction/shape.hpp>
#include <support/gaps.hpp>

namespace repel {
namespace closed_forms_test {

using families::Rng;

constexpr unsigned seed = 1993;

/// One placement of one pair of shapes and its distance [m], negative in overlap.
struct Case {
  std::string what;
  Shape A;
  Pose X_WA;
  Shape B;
  Pose X_WB;
  double distance;
};
using Cases = std::vector<Case>;

Pose at(double x, double y, double z) {
  Pose X = Pose::Identity();
  X.translation() = Vec3(x, y, z);
  return X;
}
Pose turned(double angle, const Vec3& axis, const Vec3& p) {
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  X.translation() = p;
  return X;
}
const Pose home = Pose::Identity();
const Vec3 unit_x = Vec3::UnitX();
const Vec3 unit_y = Vec3::UnitY();
const Vec3 unit_z = Vec3::UnitZ();
constexpr double right_angle = M_PI / 2;
constexpr double half_right = M_PI / 4;

Shape point() {
  return Shape::box(Vec3::Zero());
}
Shape segment(double half_length) {
  return Shape::box({0.0, 0.0, half_length});
}
Shape rectangle(double half_x, double half_y) {
  return Shape::box({half_x, half_y, 0.0});
}
Shape octahedron(double radius) {
  const std::vector<Vec3> tips{{radius, 0, 0},  {-radius, 0, 0}, {0, radius, 0},
                               {0, -radius, 0}, {0, 0, radius},  {0, 0, -radius}};
  return Shape::hull(tips);
}

Cases point_point() {
  return {{"apart", point(), home, point(), at(3, 4, 12), 13.0},
          {"a micrometre apart", point(), at(1, 1, 1), point(), at(1, 1, 1 + 0x1p-20), 0x1p-20},
          {"coincident", point(), at(0.25, 0.5, 0.75), point(), at(0.25, 0.5, 0.75), 0.0}};
}

Cases sphere_sphere() {
  const Shape A = Shape::sphere(0.3);
  const Shape B = Shape::sphere(0.5);
  return {{"apart", A, home, B, at(3, 4, 0), 4.2},
          {"along the diagonal", A, home, B, at(2, 2, 2), std::sqrt(12.0) - 0.8},
          {"rims overlap", A, home, B, at(0, 0.3, 0.4), -0.3},
          {"one inside the other", A, home, B, at(0.125, 0, 0), -0.675}};
}

Cases capsule_capsule() {
  const Shape A = Shape::capsule(0.1, 1.0);
  const Shape B = Shape::capsule(0.2, 0.5);
  return {{"parallel", A, home, B, at(0.6, 0.8, 0.25), 0.7},
          {"crossed", A, home, B, turned(right_angle, unit_x, {2, 0, 0.25}), 1.7},
          {"crossed at 30 degrees", A, home, B, turned(M_PI / 6, unit_x, {-2, 0, 0}), 1.7},
          {"end to end", A, home, B, at(0, 0, 4), 2.2},
          {"end beside end", A, home, B, at(3, 0, 5.5), 4.7},
          {"end on the side", A, home, B, turned(right_angle, unit_y, {2, 0, 0.5}), 1.2},
          {"rims overlap", A, home, B, at(0.25, 0, 0.3), -0.05}};
}

Cases segment_segment() {
  const Shape A = segment(1.0);
  const Shape B = segment(0.5);
  return {{"parallel", A, home, B, at(0.6, 0.8, 0.25), 1.0},
          {"crossed", A, home, B, turned(right_angle, unit_x, {2, 0, 0.25}), 2.0},
          {"crossed at a thousandth", A, home, B, turned(1e-3, unit_x, {2, 0, 0}), 2.0},
          {"end to end", A, home, B, at(0, 0, 4), 2.5},
          {"end beside end", A, home, B, at(3, 0, 5.5), 5.0},
          {"end on the side", A, home, B, turned(right_angle, unit_y, {2, 0, 0.5}), 1.5}};
}

Cases rectangle_rectangle() {
  const Shape A = rectangle(1.0, 0.5);
  const Shape B = rectangle(0.25, 0.75);
  return {
      {"face to face", A, home, B, at(0.5, 0.25, 2), 2.0},
      {"in one plane", A, home, B, at(3, 0, 0), 1.75},
      {"in one plane, corner to corner", A, home, B, at(4.25, 5.25, 0), 5.0},
      {"beside and above", A, home, B, at(4.25, 0, 4), 5.0},
      {"an edge above the face", A, home, B, turned(right_angle, unit_x, {0, 0, 2}), 1.25},
      {"standing corner to corner", A, home, B, turned(right_angle, unit_x, {4.25, 0, 4.75}), 5.0}};
}

/// `B` in each of the 26 Voronoi regions outside the box: beyond the faces whose sign is not 0.
Cases around_box(const Shape& B, double radius) {
  const Vec3 half(0.5, 0.75, 1.0);
  const Vec3 beyond(0.3, 0.4, 1.2);
  Cases cases;
  for (int region = 0; region < 27; ++region) {
    const Vec3 sign(region % 3 - 1, region / 3 % 3 - 1, region / 9 - 1);
    if (sign.isZero()) continue;
    const Vec3 inside = half.cwiseProduct(Vec3(0.1, -0.2, 0.3));
    Vec3 p = sign.cwiseProduct(half + beyond);
    for (int i = 0; i < 3; ++i) p[i] = sign[i] == 0.0 ? inside[i] : p[i];
    const double distance = sign.cwiseProduct(beyond).norm() - radius;
    cases.push_back({"region " + std::to_string(region), Shape::box(half), home, B,
                     at(p.x(), p.y(), p.z()), distance});
  }
  return cases;
}
Cases box_point() {
  return around_box(point(), 0.0);
}
Cases box_sphere() {
  return around_box(Shape::sphere(0.1), 0.1);
}
Cases box_sphere_in_overlap() {
  return around_box(Shape::sphere(0.35), 0.35);
}

Cases box_box() {
  const Shape A = Shape::box({1.0, 2.0, 0.5});
  const Shape B = Shape::box({0.25, 0.5, 0.75});
  const double root2 = std::sqrt(2.0);
  const Vec3 corner(0.25, 0.5, 0.75);
  const Mat3 down = Eigen::Quaterniond::FromTwoVectors(corner, -unit_z).toRotationMatrix();
  Pose on_corner = at(0.2, 0.3, 3);
  on_corner.linear() = down;
  return {{"face to face", A, home, B, at(0.5, 0.5, 3), 1.75},
          {"parallel edges", A, home, B, at(4.25, 0, 5.25), 5.0},
          {"corner to corner", A, home, B, at(2.25, 4.5, 3.25), std::sqrt(1.0 + 4.0 + 4.0)},
          {"an edge above the face", A, home, B, turned(half_right, unit_x, {0.25, 0, 3}),
           2.5 - 1.25 / root2},
          {"edges crossed", A, turned(half_right, unit_y, {0, 0, 0}), B,
           turned(half_right, unit_x, {-0.35, 0, 4}), 4.0 - (1.5 + 1.25) / root2},
          {"a corner above the face", A, home, B, on_corner, 2.5 - corner.norm()}};
}

Cases box_capsule() {
  const Shape A = Shape::box({2.0, 2.0, 0.5});
  const Shape B = Shape::capsule(0.125, 1.0);
  return {{"standing", A, home, B, at(0.3, 0.4, 3), 1.375},
          {"lying", A, home, B, turned(right_angle, unit_x, {0.3, 0.4, 3}), 2.375},
          {"tilted", A, home, B, turned(M_PI / 3, unit_y, {0.3, 0.4, 3}), 1.875},
          {"beside an edge", A, home, B, turned(right_angle, unit_x, {5, 0, 4.5}), 4.875},
          {"rims overlap", A, home, B, turned(right_angle, unit_x, {0.3, 0.4, 0.6}), -0.025}};
}

Cases hull_box() {
  const Shape A = octahedron(1.0);
  const Shape B = Shape::box({2.0, 2.0, 0.5});
  return {{"a tip above the face", A, at(0.3, 0.4, 3), B, home, 1.5},
          {"an edge above the face", A, turned(half_right, unit_x, {0.3, 0.4, 3}), B, home,
           2.5 - std::sqrt(0.5)},
          {"a face before a corner", A, home, B, at(4, 4, 2.5), 5.0 / std::sqrt(3.0)}};
}

Cases cylinder_point() {
  const Shape A = Shape::cylinder(0.5, 1.0);
  return {{"above the cap", A, home, point(), at(0.2, 0.3, 3), 2.0},
          {"above the centre", A, home, point(), at(0, 0, -3), 2.0},
          {"beside", A, home, point(), at(1.5, 2, 0.3), 2.0},
          {"off the rim", A, home, point(), at(2.1, 2.8, 5), 5.0}};
}

Cases cylinder_sphere() {
  const Shape A = Shape::cylinder(0.5, 1.0);
  const Shape B = Shape::sphere(0.25);
  return {{"above the cap", A, home, B, at(0.2, 0.3, 3), 1.75},
          {"beside", A, home, B, at(1.5, 2, 0.3), 1.75},
          {"off the rim", A, home, B, at(2.1, 2.8, 5), 4.75},
          {"rims overlap", A, home, B, at(0.36, 0.48, 0.3), -0.15}};
}

Cases cylinder_capsule() {
  const Shape A = Shape::cylinder(0.5, 1.0);
  const Shape B = Shape::capsule(0.125, 0.25);
  return {{"parallel", A, home, B, at(1.5, 2, 0.3), 1.875},
          {"above the cap", A, home, B, at(0.1, 0.2, 4), 2.625},
          {"lying above the cap", A, home, B, turned(right_angle, unit_x, {0.1, 0.1, 4}), 2.875},
          {"crossed", A, home, B, turned(right_angle, unit_x, {3, 0, 0.3}), 2.375},
          {"off the rim", A, home, B, at(2.1, 2.8, 5.25), 4.875}};
}

Cases cylinder_cylinder() {
  const Shape A = Shape::cylinder(0.5, 1.0);
  const Shape B = Shape::cylinder(0.25, 0.75);
  return {{"parallel axes", A, home, B, at(3, 4, 0.25), 4.25},
          {"parallel axes, one above", A, home, B, at(3.75, 0, 5.75), 5.0},
          {"coaxial", A, home, B, at(0, 0, 4), 2.25},
          {"caps beside each other", A, home, B, at(0.3, 0.1, 4), 2.25},
          {"crossed", A, home, B, turned(right_angle, unit_x, {3, 0.2, 0.1}), 2.25},
          {"crossed at 30 degrees", A, home, B, turned(M_PI / 6, unit_x, {3, 0, 0}), 2.25},
          {"a cap beside the side", A, home, B, turned(right_angle, unit_y, {3, 0, 0.1}), 1.75},
          {"tilted above the cap", Shape::cylinder(3, 1), home, B,
           turned(half_right, unit_x, {0.3, 0.4, 4}), 3.0 - std::sqrt(0.5)}};
}

Cases disc_disc() {
  const Shape A = Shape::cylinder(0.5, 0.0);
  const Shape B = Shape::cylinder(0.25, 0.0);
  return {{"coaxial", A, home, B, at(0, 0, 2), 2.0},
          {"in one plane", A, home, B, at(3, 4, 0), 4.25},
          {"beside and above", A, home, B, at(3.75, 0, 4), 5.0},
          {"on edge above the face", A, home, B, turned(right_angle, unit_x, {0.1, 0.2, 2}), 1.75}};
}

/// The lowest point of a cylinder tilted by t lies h cos t + r sin t below its centre.
Cases cylinder_box() {
  const Shape A = Shape::cylinder(0.5, 1.0);
  const Shape B = Shape::box({4.0, 4.0, 0.5});
  Cases cases{{"beside the face", A, home, B, at(0.25, 8, 0.3), 3.5},
              {"beside an edge", A, home, B, turned(half_right, unit_z, {8, 0, 0.2}),
               8.0 - 4.0 * std::sqrt(2.0) - 0.5}};
  for (const double tilt : {0.0, 1e-6, 1e-3, 0.3, half_right, 1.2, right_angle}) {
    const double low = std::cos(tilt) + 0.5 * std::sin(tilt);
    cases.push_back({"tilted by " + std::to_string(tilt), A,
                     turned(tilt, Vec3(3, 4, 0), {0.3, 0.2, 3}), B, home, 2.5 - low});
  }
  return cases;
}

Cases cylinder_rectangle() {
  const Shape A = Shape::cylinder(0.5, 1.0);
  const Shape B = rectangle(4.0, 4.0);
  return {{"standing", A, at(0.3, 0.2, 3), B, home, 2.0},
          {"lying", A, turned(right_angle, unit_y, {0.3, 0.2, 3}), B, home, 2.5},
          {"on its rim", A, turned(half_right, unit_y, {0.3, 0.2, 3}), B, home,
           3.0 - 1.5 * std::sqrt(0.5)}};
}

/// The guaranteed accuracy: the largest error relative to the size of both shapes plus the distance
/// of their origins.
struct Promise {
  const char* pair;
  Cases (*cases)();
  double accuracy;
};

constexpr Promise polytopes_and_rounded[] = {
    {"point point", point_point, 1e-15},
    {"sphere sphere", sphere_sphere, 1e-15},
    {"capsule capsule", capsule_capsule, 1e-15},
    {"segment segment", segment_segment, 1e-15},
    {"rectangle rectangle", rectangle_rectangle, 1e-15},
    {"box point", box_point, 1e-15},
    {"box sphere", box_sphere, 1e-15},
    {"box sphere in overlap", box_sphere_in_overlap, 1e-15},
    {"box capsule", box_capsule, 1e-15},
    {"box box", box_box, 1e-15},
    {"hull box", hull_box, 1e-15},
};

constexpr Promise cylinders[] = {
    {"cylinder point", cylinder_point, 1e-14},
    {"cylinder sphere", cylinder_sphere, 1e-14},
    {"cylinder capsule", cylinder_capsule, 1e-14},
    {"cylinder box", cylinder_box, 1e-14},
    {"cylinder rectangle", cylinder_rectangle, 1e-14},
    {"cylinder cylinder", cylinder_cylinder, 1e-12},
    {"disc disc", disc_disc, 1e-14},
};

double size_of(const Case& c) {
  return c.A.reach() + c.B.reach() + (c.X_WA.translation() - c.X_WB.translation()).norm();
}

/// Checks the value, its bracket, and the consistency of witness points and direction.
void expect_true(const Separation& s, const Case& c, double tolerance) {
  EXPECT_NEAR(s.distance, c.distance, tolerance);
  EXPECT_LE(s.lower, c.distance + tolerance);
  EXPECT_GE(s.upper, c.distance - tolerance);
  EXPECT_LE(s.lower, s.distance);
  EXPECT_LE(s.distance, s.upper);
  EXPECT_NE(s.end, QueryEnd::budget_spent);
  EXPECT_NEAR(s.extraction_W.norm(), 1.0, 1e-14);
  EXPECT_NEAR((s.p_WA - s.p_WB).dot(s.extraction_W), s.distance, 4.0 * tolerance);
}

class ClosedForm : public ::testing::TestWithParam<Promise> {
 protected:
  template <class Law>
  void for_cases(Law&& law) {
    const Cases cases = GetParam().cases();
    ASSERT_FALSE(cases.empty());
    for (const Case& c : cases) {
      SCOPED_TRACE(std::string(GetParam().pair) + ": " + c.what);
      law(c, GetParam().accuracy * size_of(c));
    }
  }
};

std::string test_name(const ::testing::TestParamInfo<Promise>& promise) {
  std::string name = promise.param.pair;
  for (char& c : name) c = std::isalnum(c) == 0 ? '_' : c;
  return name;
}

class FlatOrRounded : public ClosedForm {};

INSTANTIATE_TEST_SUITE_P(FlatOrRounded, ClosedForm, ::testing::ValuesIn(polytopes_and_rounded),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Cylinders, ClosedForm, ::testing::ValuesIn(cylinders), test_name);
INSTANTIATE_TEST_SUITE_P(All, FlatOrRounded, ::testing::ValuesIn(polytopes_and_rounded), test_name);

TEST_P(ClosedForm, IsMet) {
  for_cases([](const Case& c, double tolerance) {
    expect_true(separation(c.A, c.X_WA, c.B, c.X_WB), c, tolerance);
  });
}

TEST_P(ClosedForm, IsMetWithAAndBSwapped) {
  for_cases([](const Case& c, double tolerance) {
    expect_true(separation(c.B, c.X_WB, c.A, c.X_WA), c, tolerance);
  });
}

// The poses of the moved pair are rounded themselves: a few units in the last place of its size.
TEST_P(ClosedForm, IsMetAfterARigidMotionOfBoth) {
  for_cases([](const Case& c, double tolerance) {
    Rng rng(seed);
    for (int i = 0; i < 200; ++i) {
      Pose X = Pose::Identity();
      X.linear() = families::rotation(rng);
      X.translation() = families::direction(rng);
      SCOPED_TRACE(families::of_seed(seed, "motion", i));
      const Separation s = separation(c.A, X * c.X_WA, c.B, X * c.X_WB);
      expect_true(s, c, tolerance + 4e-15 * (1.0 + size_of(c)));
    }
  });
}

/// Solves the case with warm starts from 50 nearby poses.
template <class Law>
void for_warm_starts(const Case& c, Law&& law) {
  Rng rng(seed);
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "motion", i));
    WarmStart warm;
    const Pose nearby = families::moved_a_little(c.X_WA, rng);
    ASSERT_NE(separation(c.A, nearby, c.B, c.X_WB, {}, warm).end, QueryEnd::bad_input);
    law(separation(c.A, c.X_WA, c.B, c.X_WB, {}, warm));
  }
}

TEST_P(FlatOrRounded, IsMetFromTheWarmStartOfANearbyPose) {
  for_cases([](const Case& c, double tolerance) {
    for_warm_starts(c, [&](const Separation& s) { expect_true(s, c, tolerance); });
  });
}

TEST_P(ClosedForm, LiesInTheBracketFromTheWarmStartOfANearbyPose) {
  for_cases([](const Case& c, double tolerance) {
    for_warm_starts(c, [&](const Separation& s) {
      EXPECT_LE(s.lower, c.distance + tolerance);
      EXPECT_GE(s.upper, c.distance - tolerance);
      EXPECT_LE(s.lower, s.distance);
      EXPECT_LE(s.distance, s.upper);
    });
  });
}

TEST(ClosedForms, ConcentricSpheresAreAsDeepAsBothRadii) {
  const Separation s =
      separation(Shape::sphere(0.25), at(1, 2, 3), Shape::sphere(0.5), at(1, 2, 3));
  EXPECT_EQ(s.distance, -0.75);
  EXPECT_NEAR(s.extraction_W.norm(), 1.0, 1e-14);
}

// Regression: when all levels intersected, both witness points were the origin of A and their
// product was 0.
TEST(ClosedForms, WitnessesOfConcentricSpheresAreTheDistanceApart) {
  const Separation s = separation(Shape::sphere(0.25), home, Shape::sphere(0.5), home);
  EXPECT_EQ(s.distance, -0.75);
  EXPECT_NEAR((s.p_WA - s.p_WB).dot(s.extraction_W), s.distance, 1e-15);
}

// Regression: the ids of points on a cylinder are angles to 1e-8, and a warm start from them
// stalled with a bracket of 1e-9 to 1e-8 m.
TEST(ClosedForms, ParallelCylindersAreRightFromTheWarmStartOfANearbyPose) {
  const Shape A = Shape::cylinder(0.5, 1.0);
  const Shape B = Shape::cylinder(0.25, 0.75);
  const Pose X_WA = Pose::Identity();
  Pose X_WB = Pose::Identity();
  X_WB.translation() = Vec3(3, 4, 0.25);
  families::Rng rng(1993);
  for (int i = 0; i < 1000; ++i) {
    WarmStart warm;
    const Pose nearby = families::moved_a_little(X_WA, rng);
    ASSERT_NE(separation(A, nearby, B, X_WB, {}, warm).end, QueryEnd::bad_input);
    const Separation s = separation(A, X_WA, B, X_WB, {}, warm);
    EXPECT_NEAR(s.distance, 4.25, 1e-11) << "seed 1993, motion " << i;
    if (s.end == QueryEnd::converged) {
      EXPECT_LE(s.upper - s.lower, 1e-11) << "seed 1993, motion " << i;
    }
  }
}

}  // namespace closed_forms_test
}  // namespace repel
