// SPDX-License-Identifier: BSD-3-Clause
// Contacts that are exact in doubles: coordinates are dyadic and rotations are the 24 of the cube,
// so the distance is exactly 0.
#include <repel/reduction/separation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <repel/reduction/shape.hpp>

namespace repel {
namespace touching_test {

/// B touches A, and separates from it along the world's z axis.
struct Contact {
  std::string name;
  Shape A, B;
  Vec3 p_AB;          ///< [m]
  bool solid = true;  ///< moved the other way, B penetrates A
};

std::vector<Vec3> box(const Vec3& h) {
  std::vector<Vec3> vertices;
  for (int i = 0; i < 8; ++i) {
    vertices.emplace_back((i & 1) != 0 ? h.x() : -h.x(), (i & 2) != 0 ? h.y() : -h.y(),
                          (i & 4) != 0 ? h.z() : -h.z());
  }
  return vertices;
}
std::vector<Vec3> octahedron() {
  return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
}
/// An edge along x at the bottom.
std::vector<Vec3> keel() {
  return {{1, 0, -0.5},   {-1, 0, -0.5},  {1, 0.5, 0.5},
          {-1, 0.5, 0.5}, {1, -0.5, 0.5}, {-1, -0.5, 0.5}};
}
/// An edge along y at the top.
std::vector<Vec3> roof() {
  return {{0, 1, 0.5},     {0, -1, 0.5},    {0.5, 1, -0.5},
          {0.5, -1, -0.5}, {-0.5, 1, -0.5}, {-0.5, -1, -0.5}};
}
/// Touches what is below it at one vertex, off its centre.
std::vector<Vec3> tipped_hull() {
  return {{0.125, -0.25, -0.75},
          {0.5, 0.375, 0.25},
          {-0.625, 0.25, 0.5},
          {0.25, -0.5, 0.375},
          {0.0625, 0.125, 0.875}};
}

Shape hull(const std::vector<Vec3>& vertices) {
  return Shape::hull(vertices);
}

const std::vector<Contact>& contacts() {
  const Shape a = hull(box({0.5, 0.75, 0.25}));
  const Shape b = hull(box({0.25, 0.5, 0.75}));
  const Shape tips = hull(octahedron());
  const Shape tipped = hull(tipped_hull());
  const Shape point = hull({Vec3(0.5, 0.25, 0.125)});
  const Shape along_x = hull({Vec3(1, 0, 0), Vec3(-1, 0, 0)});
  const Shape along_y = hull({Vec3(0, 1, 0.5), Vec3(0, -1, 0.5)});
  const Shape along_z = hull({Vec3(0, 0, 1), Vec3(0, 0, -1)});
  const Shape square = hull({Vec3(1, 1, 0), Vec3(-1, 1, 0), Vec3(-1, -1, 0), Vec3(1, -1, 0)});
  static const std::vector<Contact> all{
      {"shared face", a, a, {0, 0, 0.5}},
      {"face on face", a, b, {0.125, 0.25, 1}},
      {"face over the rim", a, b, {0.625, 0.875, 1}},
      {"shared edge", a, b, {0.75, 0.25, 1}, false},
      {"shared vertex", a, b, {0.75, 1.25, 1}, false},
      {"vertex on face", a, tips, {0.125, -0.25, 1.25}},
      {"vertex on edge", a, tips, {0.5, 0.25, 1.25}},
      {"vertex on vertex", a, tips, {0.5, 0.75, 1.25}},
      {"tip on tip", tips, tips, {0, 0, 2}},
      {"edge on face", a, hull(keel()), {0.25, 0.125, 0.75}},
      {"edge on edge", hull(roof()), hull(keel()), {0.25, 0.5, 1}},
      {"hull on face", a, tipped, {0.25, 0.5, 1}},
      {"hull on hull", tips, tipped, {-0.125, 0.25, 1.75}},
      {"identical points", point, point, {0, 0, 0}, false},
      {"point on face", a, point, {-0.25, 0.125, 0.125}},
      {"segments crossed", along_x, along_y, {0.25, 0.5, -0.5}, false},
      {"segments end to end", along_z, along_z, {0, 0, 2}},
      {"same rectangle", square, square, {0, 0, 0}, false}};
  return all;
}

/// The rotations that permute the axes: exact in doubles, as are products with them.
std::vector<Mat3> right_angle_turns() {
  std::vector<Mat3> turns;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (i == j) continue;
      for (int signs = 0; signs < 4; ++signs) {
        const Vec3 x = ((signs & 1) != 0 ? -1.0 : 1.0) * Vec3::Unit(i);
        const Vec3 y = ((signs & 2) != 0 ? -1.0 : 1.0) * Vec3::Unit(j);
        Mat3 R;
        R << x, y, x.cross(y);
        turns.push_back(R);
      }
    }
  }
  return turns;
}

/// The contact in the frame of A rotated by `R`, with B raised by `rise` [m].
struct Placed {
  const Shape& A;
  const Shape& B;
  Pose X_WA = Pose::Identity(), X_WB = Pose::Identity();

  Placed(const Contact& c, const Mat3& R, double rise) : A(c.A), B(c.B) {
    X_WA.linear() = X_WB.linear() = R;
    X_WB.translation() = R * (c.p_AB + rise * Vec3::UnitZ());
  }
  [[nodiscard]] Separation solve(WarmStart& warm) const {
    return separation(A, X_WA, B, X_WB, {}, warm);
  }
  [[nodiscard]] Separation solve() const { return separation(A, X_WA, B, X_WB); }
};

/// [m] One unit in the last place of the height of B, or of 0.5 m if that is larger.
double ulp(const Contact& c) {
  const double z = std::max(std::abs(c.p_AB.z()), 0.5);
  return std::nextafter(z, std::numeric_limits<double>::infinity()) - z;
}

template <class Law>
void for_contacts(Law&& law) {
  for (const Contact& c : contacts()) {
    int turn = 0;
    for (const Mat3& R : right_angle_turns()) {
      SCOPED_TRACE(c.name + ", turn " + std::to_string(turn++));
      law(c, R);
    }
  }
}

void expect_contact(const Separation& s) {
  EXPECT_LE(std::abs(s.distance), 1e-15);
  EXPECT_LE(s.lower, 0.0);
  EXPECT_GE(s.upper, 0.0);
  EXPECT_LE(s.upper, 1e-13);
  EXPECT_TRUE(s.end == QueryEnd::touching || s.end == QueryEnd::converged);
  EXPECT_NEAR(s.extraction_W.norm(), 1.0, 1e-14);
}

void expect_apart(const Separation& s, double gap) {
  EXPECT_NEAR(s.distance, gap, 1e-6 * gap);
  EXPECT_GT(s.lower, 0.0);
  EXPECT_EQ(s.level, 0);
  EXPECT_EQ(s.end, QueryEnd::converged);
}

TEST(Touching, IsNeitherAGapNorAnOverlap) {
  for_contacts([](const Contact& c, const Mat3& R) { expect_contact(Placed(c, R, 0).solve()); });
}

TEST(Touching, IsNeitherAGapNorAnOverlapFromAnyWarmStart) {
  for_contacts([](const Contact& c, const Mat3& R) {
    const Placed touching(c, R, 0);
    for (const double before : {1e-15, 1e-6, 0.1, -1e-15, -1e-6, -0.1}) {
      SCOPED_TRACE(before);
      WarmStart warm;
      ASSERT_NE(Placed(c, R, before).solve(warm).end, QueryEnd::bad_input);
      expect_contact(touching.solve(warm));
      expect_contact(touching.solve(warm));
    }
  });
}

TEST(Touching, IsTheSameWithAAndBSwapped) {
  for_contacts([](const Contact& c, const Mat3& R) {
    const Placed p(c, R, 0);
    expect_contact(separation(p.B, p.X_WB, p.A, p.X_WA));
  });
}

TEST(Touching, OneUnitInTheLastPlaceApartIsApart) {
  for_contacts(
      [](const Contact& c, const Mat3& R) { expect_apart(Placed(c, R, ulp(c)).solve(), ulp(c)); });
}

TEST(Touching, OneUnitInTheLastPlaceApartIsApartFromTheWarmStartOfTheContact) {
  for_contacts([](const Contact& c, const Mat3& R) {
    WarmStart warm;
    expect_contact(Placed(c, R, 0).solve(warm));
    expect_apart(Placed(c, R, ulp(c)).solve(warm), ulp(c));
  });
}

TEST(Touching, OneUnitInTheLastPlaceOfOverlapIsNoGap) {
  int overlaps = 0;
  for_contacts([&](const Contact& c, const Mat3& R) {
    if (!c.solid) return;
    ++overlaps;
    const double depth = ulp(c);
    for (const double before : {1e-3, 0.0, -1e-3}) {
      WarmStart warm;
      ASSERT_NE(Placed(c, R, before).solve(warm).end, QueryEnd::bad_input);
      const Separation s = Placed(c, R, -depth).solve(warm);
      EXPECT_LE(s.distance, 0.0);
      EXPECT_GE(s.distance, -1.01 * depth - 1e-15);
      EXPECT_LE(s.lower, -0.99 * depth);
    }
  });
  EXPECT_GT(overlaps, 200);
}

TEST(Touching, TwoConvexSetsAreNotProvenToMeetWhenTheyAreApartByOneUnit) {
  for_contacts([](const Contact& c, const Mat3& R) {
    const Placed p(c, R, ulp(c));
    WarmStart warm;
    const Gap gap = gap_between(p.A.level(0).core, p.X_WA, p.B.level(0).core, p.X_WB, {}, warm);
    EXPECT_FALSE(gap.meets);
    EXPECT_NE(gap.end, QueryEnd::touching);
    EXPECT_GT(gap.lower, 0.0);
  });
}

TEST(Touching, BoxesThatShareAFaceTouchWhateverTheirTurn) {
  const Shape box = Shape::box({0.5, 0.25, 0.75});
  for (const Mat3& R : right_angle_turns()) {
    for (int axis = 0; axis < 3; ++axis) {
      Pose X_WA = Pose::Identity();
      X_WA.linear() = R;
      Pose X_WB = X_WA;
      X_WB.translation() = 2.0 * R * Vec3(0.5, 0.25, 0.75).cwiseProduct(Vec3::Unit(axis));
      expect_contact(separation(box, X_WA, box, X_WB));
    }
  }
}

// A radius is subtracted, not found by iteration: here the difference is exact.
TEST(Touching, RoundedShapesTouchExactly) {
  const Shape box = Shape::box({0.5, 0.75, 0.25});
  const Shape ball = Shape::sphere(0.5);
  const Shape capsule = Shape::capsule(0.125, 0.5);
  for (const Mat3& R : right_angle_turns()) {
    Pose X_WA = Pose::Identity();
    X_WA.linear() = R;
    const auto from_a = [&](const Shape& A, const Shape& B, double z) {
      Pose X_WB = X_WA;
      X_WB.translation() = R * Vec3(0, 0, z);
      return separation(A, X_WA, B, X_WB);
    };
    EXPECT_EQ(from_a(ball, ball, 1.0).distance, 0.0);
    EXPECT_EQ(from_a(box, ball, 0.75).distance, 0.0);
    EXPECT_EQ(from_a(box, capsule, 0.875).distance, 0.0);
    EXPECT_EQ(from_a(capsule, capsule, 1.25).distance, 0.0);
    EXPECT_GT(from_a(ball, ball, std::nextafter(1.0, 2.0)).distance, 0.0);
    EXPECT_GT(from_a(box, ball, std::nextafter(0.75, 2.0)).distance, 0.0);
    EXPECT_LT(from_a(box, ball, std::nextafter(0.75, 0.0)).distance, 0.0);
  }
}

TEST(Touching, ACylinderStandingOnABoxTouchesIt) {
  const Shape box = Shape::box({1.0, 1.0, 0.25});
  const Shape cylinder = Shape::cylinder(0.25, 0.5);
  for (const Mat3& R : right_angle_turns()) {
    Pose X_WA = Pose::Identity();
    X_WA.linear() = R;
    Pose X_WB = X_WA;
    X_WB.translation() = R * Vec3(0.125, 0.25, 0.75);
    expect_contact(separation(box, X_WA, cylinder, X_WB));
  }
}

}  // namespace touching_test
}  // namespace repel
