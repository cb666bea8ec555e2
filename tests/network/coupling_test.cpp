#include <repel/network/coupling.hpp>

#include <gtest/gtest.h>

#include "support/families.hpp"

namespace repel::network {
namespace {

constexpr double period = 0.0025;
constexpr unsigned seed = 9;

TEST(Coupling, AtRestThereIsNoForce) {
  families::Rng random(seed);
  for (int i = 0; i < 100; ++i) {
    const Pose X_WT = families::random_pose(random, 0.0, 1.0);
    Coupling coupling{CouplingGains{}};
    coupling.reset(X_WT);
    const Wrench F = coupling.step({}, X_WT, {}, period);
    EXPECT_LE(F.force.norm(), 1e-9) << "seed " << seed;
    EXPECT_LE(F.torque.norm(), 1e-9) << "seed " << seed;
  }
}

TEST(Coupling, IsASpringBetweenCommandAndTool) {
  const CouplingGains gains{
      .stiffness = 1000.0, .damping = 0.0, .angular_stiffness = 50.0, .angular_damping = 0.0};
  Coupling coupling(gains);
  coupling.reset(Pose::Identity());
  const Twist ahead{{0.4, 0.0, 0.0}, {0.0, 0.0, 2.0}};
  const Wrench F = coupling.step(ahead, Pose::Identity(), {}, period);
  EXPECT_LE((F.force - Vec3(1000.0 * 0.4 * period, 0, 0)).norm(), 1e-12);
  EXPECT_LE((F.torque - Vec3(0, 0, 50.0 * 2.0 * period)).norm(), 1e-12);
}

TEST(Coupling, SpringIsLimitedInLengthAndKeepsItsDirection) {
  const CouplingGains gains{.damping = 0.0, .angular_damping = 0.0};
  Coupling coupling(gains);
  coupling.reset(Pose::Identity());
  const Twist ahead{{0.3, 0.4, 0.0}, {0.0, 0.6, 0.8}};
  Wrench F;
  for (int tick = 0; tick < 4000; ++tick) {
    F = coupling.step(ahead, Pose::Identity(), {}, period);
    ASSERT_LE(F.force.norm(), gains.force_limit * (1.0 + 1e-12));
    ASSERT_LE(F.torque.norm(), gains.torque_limit * (1.0 + 1e-9));
  }
  EXPECT_LE((F.force - gains.force_limit * Vec3(0.6, 0.8, 0.0)).norm(), 1e-9);
  EXPECT_LE((F.torque - gains.torque_limit * Vec3(0.0, 0.6, 0.8)).norm(), 1e-6);
}

TEST(Coupling, HeldUpToolWindsNothingUp) {
  const CouplingGains gains{.damping = 0.0, .angular_damping = 0.0};
  Coupling brief(gains);
  Coupling patient(gains);
  const Twist push{{0.2, 0, 0}, {}};
  const Twist back{{-0.2, 0, 0}, {}};
  for (int tick = 0; tick < 100; ++tick) (void)brief.step(push, Pose::Identity(), {}, period);
  for (int tick = 0; tick < 10000; ++tick) (void)patient.step(push, Pose::Identity(), {}, period);
  for (int tick = 0; tick < 20; ++tick) {
    const Wrench after_brief = brief.step(back, Pose::Identity(), {}, period);
    const Wrench after_long = patient.step(back, Pose::Identity(), {}, period);
    EXPECT_NEAR(after_long.force.x(), after_brief.force.x(), 1e-9);
    const double expected = gains.force_limit - gains.stiffness * 0.2 * period * (tick + 1);
    EXPECT_NEAR(after_long.force.x(), expected, 1e-9);  // it lets go with the first tick
  }
}

// A tool between springs: with the operator at rest the coupling never gives more than the spring
// held at the start.
TEST(Coupling, SpringAndDamperAtRestOnlyGiveBackWhatTheSpringHeld) {
  families::Rng random(seed);
  for (int run = 0; run < 50; ++run) {
    CouplingGains gains;
    gains.stiffness = families::uniform(random, 100.0, 3000.0);
    gains.damping = families::uniform(random, gains.stiffness * period, 300.0 + 10.0);
    gains.force_limit = 1e6;
    Coupling coupling(gains);
    const double mass = families::uniform(random, 2.0, 20.0);
    Pose X_WT = Pose::Identity();
    X_WT.translation() = 0.05 * families::direction(random);
    coupling.reset(Pose::Identity());
    Vec3 v = families::uniform(random, 0.0, 0.2) * families::direction(random);
    const double at_first =
        0.5 * mass * v.squaredNorm() + 0.5 * gains.stiffness * X_WT.translation().squaredNorm();
    for (int tick = 0; tick < 4000; ++tick) {
      const Wrench F = coupling.step({}, X_WT, {v, Vec3::Zero()}, period);
      v += period / mass * F.force;
      X_WT.translation() += period * v;
      const double energy =
          0.5 * mass * v.squaredNorm() + 0.5 * gains.stiffness * X_WT.translation().squaredNorm();
      ASSERT_LE(energy, 1.1 * at_first) << "tick " << tick << ", run " << run << ", seed " << seed;
    }
    const double at_last =
        0.5 * mass * v.squaredNorm() + 0.5 * gains.stiffness * X_WT.translation().squaredNorm();
    EXPECT_LT(at_last, 0.1 * at_first) << "run " << run << ", seed " << seed;
  }
}

TEST(Coupling, CommandedFrameStaysRigidForMillionsOfTurns) {
  families::Rng random(seed);
  Coupling coupling{CouplingGains{}};
  Pose X_WT = Pose::Identity();
  coupling.reset(X_WT);
  for (int tick = 0; tick < 200000; ++tick) {
    const Twist V{families::direction(random), 3.0 * families::direction(random)};
    (void)coupling.step(V, X_WT, {}, period);
    if (tick % 100 == 0) X_WT.linear() = families::small_rotation(random, 0.05) * X_WT.linear();
    if (tick % 1000 == 0) X_WT.linear() = Eigen::Quaterniond(X_WT.linear()).toRotationMatrix();
  }
  EXPECT_TRUE(is_rigid(coupling.commanded(), 1e-9)) << "seed " << seed;
}

TEST(Coupling, HalfATurnAwayStaysFiniteAndLimited) {
  const CouplingGains gains{.torque_limit = 1e3};
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.6, 0.0, 0.8)}) {
    Coupling coupling(gains);
    Pose X_WT = Pose::Identity();
    coupling.reset(X_WT);
    for (const double angle : {3.14159, 3.141592653589793, 3.1416}) {
      X_WT.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
      const Wrench F = coupling.step({}, X_WT, {}, period);
      EXPECT_TRUE(is_finite(F));
      EXPECT_LE(F.torque.norm(), 3.2 * gains.angular_stiffness);
    }
  }
}

}  // namespace
}  // namespace repel::network
