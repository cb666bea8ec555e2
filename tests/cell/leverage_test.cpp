// SPDX-License-Identifier: BSD-3-Clause
// The leverage of a tool over the parts of links, beside answers computed by hand.
#include <repel/cell/leverage.hpp>

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/cell/layout.hpp>

namespace repel {
namespace leverage_test {

constexpr double first_length = 0.4;   // [m]
constexpr double second_length = 0.6;  // [m]

/// Two links in the plane z = 0, each turning about z where it begins.
struct PlanarKinematics : ArmKinematics {
  void update(std::span<const double> joints) noexcept override {
    q = {joints[0], joints[1]};
    ++updates;
  }
  [[nodiscard]] Pose X_WT() const noexcept override {
    Pose X = X_WL(1);
    X.translation() = X * Vec3(second_length, 0.0, 0.0);
    return X;
  }
  void tool_jacobian(JacobianRef J) const noexcept override {
    jacobian(1, X_WT().translation(), J);
  }
  [[nodiscard]] Pose X_WL(int link) const noexcept override {
    Pose X = Pose::Identity();
    X.linear() = Eigen::AngleAxisd(q[0], Vec3::UnitZ()).toRotationMatrix();
    if (link == 0) return X;
    const Vec3 elbow = X * Vec3(first_length, 0.0, 0.0);
    X.linear() = Eigen::AngleAxisd(q[0] + q[1], Vec3::UnitZ()).toRotationMatrix();
    X.translation() = elbow;
    return X;
  }
  void jacobian(int link, const Vec3& p_WQ, JacobianRef J) const noexcept override {
    J.setZero();
    for (int joint = 0; joint <= link; ++joint) {
      J.col(joint).head<3>() = Vec3::UnitZ().cross(Vec3(p_WQ - X_WL(joint).translation()));
      J.col(joint).tail<3>() = Vec3::UnitZ();
    }
  }
  void gravity_torques(std::span<double> out) noexcept override {
    std::fill(out.begin(), out.end(), 0.0);
  }

  std::array<double, 2> q{};
  int updates = 0;
};

/// A rod along x, of no thickness, from `from` to `to` [m] of its link.
ArmPart rod(const char* name, double from, double to, int link) {
  Pose X = Pose::Identity();
  X.translation().x() = 0.5 * (from + to);
  return {name, Shape::box({0.5 * (to - from), 0.0, 0.0}), X, link};
}

ArmDescription planar_arm() {
  ArmDescription arm;
  for (const char* name : {"upper", "lower"}) {
    ArmLink link;
    link.name = link.joint_name = name;
    link.lower = -std::numbers::pi;
    link.upper = std::numbers::pi;
    arm.model.links.push_back(link);
  }
  arm.kinematics = std::make_unique<PlanarKinematics>();
  arm.start = {0.3, 1.2};
  arm.kinematics->update(arm.start);
  arm.parts = {{"tip", Shape::sphere(0.02)},
               rod("upper rod", 0.0, first_length, 0),
               rod("half rod", 0.0, 0.5 * first_length, 0),
               rod("lower rod", 0.0, 0.5 * second_length, 1)};
  return arm;
}

Pose at(double x, double y) {
  Pose X = Pose::Identity();
  X.translation() = Vec3(x, y, 0.0);
  return X;
}

TEST(Leverage, IsTheRatioOfTheReachesAboutAJoint) {
  const ArmLevers levers(planar_arm());
  // Stretched out, the tool is 1 m from the first joint, the ends of the rods 0.4 m and 0.2 m.
  EXPECT_NEAR(levers.leverage(1), 1.0 / 0.4, 0.01);
  EXPECT_NEAR(levers.leverage(2), 1.0 / 0.2, 0.01);
  // About the first joint 1 m to 0.7 m, about the second 0.6 m to 0.3 m: the latter is the greater.
  EXPECT_NEAR(levers.leverage(3), 0.6 / 0.3, 0.01);
  EXPECT_EQ(levers.leverage(0), 1.0) << "a part of the tool";
}

TEST(Leverage, CountsAboutTheFirstJointAtMostAsFarAsTheObstacleIsFromIt) {
  const ArmLevers levers(planar_arm());
  const double farthest = levers.meeting(Shape::sphere(0.05), at(0.0, 0.2));
  EXPECT_NEAR(farthest, 0.25, 1e-9);
  EXPECT_NEAR(levers.leverage(1, 0, farthest), 1.0 / 0.25, 0.01);
  EXPECT_NEAR(levers.leverage(1, 0, levers.meeting(Shape::sphere(0.05), at(3.0, 0.0))), 2.5, 0.01)
      << "too far away to bound it";
}

TEST(Leverage, OfTwoPartsOfOneArmIsThatOverTheOuterOneAboutTheJointsBetweenThem) {
  const ArmLevers levers(planar_arm());
  EXPECT_NEAR(levers.between(1, 3), 0.6 / 0.3, 0.01);
  EXPECT_EQ(levers.between(3, 1), levers.between(1, 3));
  EXPECT_EQ(levers.between(0, 1), 1.0) << "the tool meets a link";
  EXPECT_EQ(levers.between(1, 0), 1.0);
}

TEST(Leverage, EndsAtItsBoundAndLeavesOutWhatAJointDoesNotMove) {
  ArmDescription arm = planar_arm();
  arm.parts = {rod("stub", 0.0, 0.05, 0), {"hub", Shape::cylinder(0.1, 0.1), Pose::Identity(), 0}};
  const ArmLevers levers(arm);
  EXPECT_EQ(levers.leverage(0), most_leverage);
  EXPECT_EQ(levers.leverage(1), 1.0) << "round about the joint";
}

TEST(Leverage, IsOneOnRails) {
  Pose X = Pose::Identity();
  const Twist rail{{0.0, 1.0, 0.0}, {0.0, 0.0, 0.0}};
  EXPECT_EQ(lever_of(Shape::sphere(0.1), X, rail, Vec3::Zero()), 1.0);
  EXPECT_EQ(farthest_from_axis(Shape::sphere(0.1), X, rail, Vec3::Zero()),
            std::numeric_limits<double>::infinity());
}

TEST(Leverage, LeavesTheArmAtItsStartAndAloneWithoutLinkParts) {
  ArmDescription arm = planar_arm();
  auto& kinematics = static_cast<PlanarKinematics&>(*arm.kinematics);
  (void)ArmLevers(arm);
  EXPECT_EQ(kinematics.q[0], 0.3);
  EXPECT_EQ(kinematics.q[1], 1.2);
  arm.parts.erase(arm.parts.begin() + 1, arm.parts.end());
  kinematics.updates = 0;
  EXPECT_EQ(ArmLevers(arm).leverage(0), 1.0);
  EXPECT_EQ(kinematics.updates, 0);
}

TEST(Leverage, ScalesForcesAndDampingOfALawThatIsGivenAtTheTool) {
  ForceLaw law{.range = 0.02, .surface_force = 120.0, .damping = 80.0, .ceiling = 50.0};
  EXPECT_EQ(at_part(law, 4.0).surface_force, 120.0);
  law.given_at = GivenAt::tool;
  const ForceLaw scaled = at_part(law, 4.0);
  EXPECT_EQ(scaled.surface_force, 480.0);
  EXPECT_EQ(scaled.damping, 320.0);
  EXPECT_EQ(scaled.ceiling, 200.0);
  EXPECT_EQ(scaled.range, 0.02);
  EXPECT_EQ(scaled.stiffness() / scaled.damping, law.stiffness() / law.damping);
}

/// The pairs of the planar arm with a ball near its base, under this law.
World world_with(const ForceLaw& law) {
  World world;
  const ArmDescription arm = planar_arm();
  const std::vector<ArmLayout> arms{detail::add_arm(world, arm)};
  const ObstacleDescription ball{"ball", Shape::sphere(0.05), at(0.0, 0.2), law};
  (void)detail::add_obstacle(world, ball, arms);
  EXPECT_NEAR(leverage(world, arms, world.pairs()[1].a, world.pairs()[1].b), 4.0, 0.02);
  return world;
}

TEST(Leverage, OfEachPairScalesItsLawAtSetUp) {
  ForceLaw law{.range = 0.02, .surface_force = 120.0, .damping = 80.0};
  const World unscaled = world_with(law);
  for (const Pair& pair : unscaled.pairs()) EXPECT_EQ(pair.law.surface_force, 120.0);
  law.given_at = GivenAt::tool;
  const World world = world_with(law);
  ASSERT_EQ(world.pairs().size(), 4U);
  EXPECT_EQ(world.pairs()[0].law.surface_force, 120.0) << "of the tool";
  EXPECT_NEAR(world.pairs()[1].law.surface_force, 480.0, 3.0);
  EXPECT_NEAR(world.pairs()[2].law.surface_force, 600.0, 3.0);
}

TEST(Leverage, OfTwoArmsIsTheGreaterAndOverAMovingObstacleHasNoBound) {
  World world;
  ArmDescription arm = planar_arm();
  std::vector<ArmLayout> arms{detail::add_arm(world, arm)};
  arm.name = "other";
  arms.push_back(detail::add_arm(world, arm));
  const auto over = [&](PartId a, PartId b) { return leverage(world, arms, a, b); };
  EXPECT_NEAR(over(arms[0].parts[1], arms[1].parts[3]), 2.5, 0.01);
  EXPECT_NEAR(over(arms[0].parts[3], arms[1].parts[1]), 2.5, 0.01);
  EXPECT_NEAR(over(arms[0].parts[0], arms[1].parts[3]), 2.0, 0.01) << "its tool on a link";
  EXPECT_EQ(over(arms[0].parts[0], arms[1].parts[0]), 1.0);
  EXPECT_NEAR(over(arms[1].parts[1], arms[1].parts[3]), 2.0, 0.01) << "of one arm";
  ObstacleDescription door{"door", Shape::sphere(0.05), at(0.0, 0.2)};
  door.motion = ReciprocatingMotion{Vec3::UnitX(), 2.0};
  (void)detail::add_obstacle(world, door, arms);
  const PartId last{static_cast<std::int32_t>(world.parts().size()) - 1};
  EXPECT_NEAR(over(arms[0].parts[1], last), 2.5, 0.01);
}

TEST(Leverage, ThatALawCannotFollowIsRefusedWithWhatToDo) {
  ForceLaw law{.surface_force = 0.9 * ForceLaw::most, .given_at = GivenAt::tool};
  try {
    (void)world_with(law);
    FAIL();
  } catch (const SetupError& error) {
    const std::string text = error.what();
    for (const char* word : {"'upper rod' and 'ball'", "4 times", "allowed: 0 to 1e+09",
                             "or a law given at the part"}) {
      EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
    }
  }
}

}  // namespace leverage_test
}  // namespace repel
