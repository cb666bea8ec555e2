// SPDX-License-Identifier: BSD-3-Clause
// The links as bodies: their poses and twists, and the work of the forces on them.
#include <gtest/gtest.h>

#include <repel/loop/arms/arm_bodies.hpp>

#include "loop/slider.hpp"
#include "support/families.hpp"

namespace repel {
namespace arm_bodies_test {

using families::Rng;

constexpr unsigned seed = 41;

/// Two revolute joints, about z and then about the x axis half a metre further, and a prismatic
/// joint.
struct TurningKinematics : ArmKinematics {
  void update(std::span<const double> q) noexcept override {
    X[0] = Pose(Eigen::AngleAxisd(q[0], Vec3::UnitZ()));
    X[1] = X[0] * Eigen::Translation3d(0.5, 0.1, 0.0) * Eigen::AngleAxisd(q[1], Vec3::UnitX());
    X[2] = X[1] * Eigen::Translation3d(0.0, 0.0, 0.3 + q[2]);
  }
  [[nodiscard]] Pose X_WT() const noexcept override { return X[2]; }
  [[nodiscard]] Pose X_WL(int link) const noexcept override {
    return X[static_cast<std::size_t>(link)];
  }
  void jacobian(int link, const Vec3& p_WQ, JacobianRef J) const noexcept override {
    J.setZero();
    J.col(0) << Vec3::UnitZ().cross(p_WQ), Vec3::UnitZ();
    if (link < 1) return;
    const Vec3 x = X[1].linear().col(0);
    J.col(1) << x.cross(p_WQ - X[1].translation()), x;
    if (link > 1) J.col(2) << X[1].linear().col(2), Vec3::Zero();
  }
  void tool_jacobian(JacobianRef J) const noexcept override { jacobian(2, X[2].translation(), J); }
  void gravity_torques(std::span<double> out) noexcept override {
    std::fill(out.begin(), out.end(), 0.0);
  }
  std::array<Pose, 3> X;
};

Wrench drawn_wrench(Rng& rng) {
  const auto vector = [&] {
    return Vec3(families::uniform(rng, -9, 9), families::uniform(rng, -9, 9),
                families::uniform(rng, -9, 9));
  };
  const Vec3 force = vector();
  return {force, vector()};
}

TEST(ArmBodies, TorquesDoTheWorkOfTheForcesOnEveryLink) {
  Rng rng(seed);
  World world;
  std::vector<LinkBody> links;
  for (int link = 0; link < 3; ++link) {
    links.push_back({world.add_body("link " + std::to_string(link)), link});
  }
  ArmBodies bodies(links, 3);
  TurningKinematics kinematics;
  const BodyId tool = world.add_body("tool");
  PairForces forces(world.body_count());
  Jacobian of_tool = Jacobian::Zero(6, 3);
  network::Vec<network::any_size> torques;
  for (int sample = 0; sample < 1000; ++sample) {
    std::array<double, 3> q{};
    std::array<double, 3> v{};
    for (double& x : q) x = families::uniform(rng, -3, 3);
    for (double& x : v) x = families::uniform(rng, -3, 3);
    kinematics.update(q);
    ASSERT_TRUE(bodies.place(world, kinematics, v));
    forces.has_own = sample % 2 == 1;
    double work = 0.0;
    for (int i = 0; i < 3; ++i) {
      const auto body = static_cast<std::size_t>(links[static_cast<std::size_t>(i)].body.index);
      const BodyState& state = world.motion().bodies[body];
      ASSERT_TRUE(state.X_WB.isApprox(kinematics.X_WL(i)));
      forces.on_body[body] = drawn_wrench(rng);
      work += power(forces.on_body[body], state.V_WB);
      forces.from_own[body] = drawn_wrench(rng);
      if (forces.has_own) work += power(forces.from_own[body], state.V_WB);
    }
    kinematics.tool_jacobian(of_tool);
    // Of the forces on the tool, only those from the links: the network has a module for the rest.
    const auto at_tool = static_cast<std::size_t>(tool.index);
    forces.on_body[at_tool] = drawn_wrench(rng);
    forces.from_own[at_tool] = drawn_wrench(rng);
    if (forces.has_own) work += power(forces.from_own[at_tool], twist_through(of_tool, v));
    bodies.gather(forces, tool, of_tool, torques);
    const double at_joints = torques(0) * v[0] + torques(1) * v[1] + torques(2) * v[2];
    ASSERT_NEAR(at_joints, work, 1e-12 * (1.0 + std::abs(work))) << "seed " << seed;
  }
}

// Twists compared with differences of poses: the work above would not reveal a Jacobian of another
// point.
TEST(ArmBodies, TwistsAreThoseOfTheOriginsOfTheLinks) {
  World world;
  const BodyId last = world.add_body("last");
  ArmBodies bodies({{last, 2}}, 3);
  TurningKinematics kinematics;
  const std::array<double, 3> q{0.3, -0.8, 0.1};
  const std::array<double, 3> v{1.1, -0.7, 0.4};
  constexpr double h = 1e-6;
  std::array<double, 3> later{};
  for (std::size_t i = 0; i < 3; ++i) later[i] = q[i] + h * v[i];
  kinematics.update(later);
  const Vec3 there = kinematics.X_WL(2).translation();
  kinematics.update(q);
  ASSERT_TRUE(bodies.place(world, kinematics, v));
  const BodyState& state = world.motion().bodies[static_cast<std::size_t>(last.index)];
  EXPECT_LT(((there - state.X_WB.translation()) / h - state.V_WB.linear).norm(), 1e-5);
}

TEST(ArmBodies, TheBiasIsTheAccelerationAtConstantRates) {
  Rng rng(seed + 2);
  TurningKinematics kinematics;
  double largest = 0.0;
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed + 2) + ", case " + std::to_string(i));
    const Vec3 q = families::uniform(rng, 0.1, 1.0) * families::direction(rng);
    const Vec3 v = families::uniform(rng, 0.1, 1.0) * families::direction(rng);
    const std::vector<double> rates(v.data(), v.data() + 3);
    const auto twist_after = [&](double time) {
      const Vec3 there = q + time * v;
      kinematics.update(std::vector<double>(there.data(), there.data() + 3));
      Jacobian J(6, 3);
      kinematics.tool_jacobian(J);
      return std::pair(twist_through(J, rates), J);
    };
    const double h = 1e-5;  // [s]
    const Twist before = twist_after(-h).first;
    const Twist after = twist_after(h).first;
    const Twist bias = bias_of(twist_after(0.0).second, rates);
    EXPECT_LT((bias.linear - (after.linear - before.linear) / (2.0 * h)).norm(), 1e-8);
    EXPECT_LT((bias.angular - (after.angular - before.angular) / (2.0 * h)).norm(), 1e-8);
    largest = std::max(largest, bias.linear.norm());
  }
  EXPECT_GT(largest, 0.1);
}

TEST(ArmBodies, APoseThatIsNoneLeavesTheBodyWhereItWas) {
  World world;
  const BodyId body = world.add_body("link");
  ArmBodies bodies({{body, 0}}, 3);
  test::SliderKinematics kinematics;
  const std::array<double, 3> still{};
  kinematics.update(std::array{0.5, 0.0, 0.0});
  EXPECT_TRUE(bodies.place(world, kinematics, still));
  kinematics.spoilt = true;
  kinematics.update(std::array{0.7, 0.0, 0.0});
  EXPECT_FALSE(bodies.place(world, kinematics, still));
  EXPECT_EQ(world.motion().bodies[static_cast<std::size_t>(body.index)].X_WB.translation().x(),
            0.5);
}

}  // namespace arm_bodies_test
}  // namespace repel
