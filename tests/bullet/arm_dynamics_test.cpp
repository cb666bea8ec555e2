// SPDX-License-Identifier: BSD-3-Clause
// The free motion of the simulated arm compared with analytical mechanics: closed forms for one and
// two links, and conservation of energy, which holds for any chain.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "arms.hpp"

namespace repel::bullet::test {
namespace arm_dynamics_test {

/// The arm without friction and stops, which conserves energy.
ArmModel without_losses(ArmModel model) {
  for (ArmLink& link : model.links) {
    link.viscous_friction = link.coulomb_friction = 0.0;
    link.lower = -infinity;
    link.upper = infinity;
  }
  return model;
}

/// Time [s] between the first and the last of `swings` + 1 upward passages through zero, per swing.
double measured_period(Arm& arm, double period, int swings) {
  double first = 0.0, last = 0.0, before = positions(arm)[0];
  int passages = 0;
  for (int tick = 1; passages <= swings; ++tick) {
    arm.step(period);
    const double now = positions(arm)[0];
    if (before < 0.0 && now >= 0.0) {
      last = period * (tick - now / (now - before));
      if (passages++ == 0) first = last;
    }
    before = now;
  }
  return (last - first) / swings;
}

TEST(BulletArmDynamics, PendulumSwingsWithThePeriodOfTheEllipticIntegral) {
  const ArmModel model = pendulum();
  const double amplitude = 1.0;  // large: linear theory would be wrong by 6 %
  const double m = 2.0, l = 0.5, inertia = 0.03 + m * l * l;
  // T = 4 K(sin(A / 2)) / w = 2 pi / (w AGM(1, cos(A / 2)))
  double larger = 1.0, smaller = std::cos(amplitude / 2);
  for (int i = 0; i < 6; ++i) {
    const double mean = (larger + smaller) / 2;
    smaller = std::sqrt(larger * smaller);
    larger = mean;
  }
  const double expected = 2 * pi / (std::sqrt(m * 9.81 * l / inertia) * larger);
  Arm arm(model);
  arm.reset(std::vector{amplitude});
  EXPECT_NEAR(measured_period(arm, 1.0 / 400, 20) / expected, 1.0, 2e-6);
}

TEST(BulletArmDynamics, PendulumNeitherGainsNorLosesEnergyOverAMinute) {
  const ArmModel model = pendulum();
  Arm arm(model);
  arm.reset(std::vector{1.0});
  const double lowest = potential_energy(model, {0.0});
  const double start = energy(model, arm) - lowest;
  const auto largest_over = [&](int ticks) {
    double largest = 0.0;
    for (int tick = 0; tick < ticks; ++tick) {
      arm.step(1.0 / 400);
      largest = std::max(largest, energy(model, arm) - lowest);
    }
    return largest;
  };
  const double early = largest_over(4000);
  largest_over(16000);
  const double late = largest_over(4000);
  RecordProperty("relative_ripple", std::to_string((early - start) / start));
  RecordProperty("relative_drift", std::to_string((late - early) / start));
  EXPECT_NEAR(early, start, 2e-3 * start);  // the scheme oscillates once per swing ...
  EXPECT_NEAR(late, early, 1e-6 * start);   // ... and returns
}

struct TwoLink {
  double m1 = 3.0, m2 = 2.0, l1 = 0.7, c1 = 0.3, c2 = 0.25, I1 = 0.05, I2 = 0.02;
  double r1 = 0.4, r2 = 0.15;  // rotor inertias
  double g = 9.81;

  /// Both axes along y, both links along -z at zero, so that the arm hangs down at q = 0.
  [[nodiscard]] ArmModel model() const {
    ArmModel arm;
    arm.name = "two links";
    arm.links = {link_with(m1, {0, 0, -c1}, {I1, I1, 0.001}),
                 link_with(m2, {0, 0, -c2}, {I2, I2, 0.001})};
    arm.links[0].axis_J = arm.links[1].axis_J = Vec3::UnitY();
    arm.links[1].X_PJ.translation() = Vec3(0, 0, -l1);
    arm.links[0].rotor_inertia = r1;
    arm.links[1].rotor_inertia = r2;
    return arm;
  }

  /// From L = T - V with T, V as functions of the angles; textbook closed form, rotors on the
  /// diagonal.
  [[nodiscard]] Eigen::Vector2d acceleration(const std::vector<double>& q,
                                             const std::vector<double>& v,
                                             const std::vector<double>& tau) const {
    const double k = m2 * l1 * c2, ck = k * std::cos(q[1]), sk = k * std::sin(q[1]);
    const double b = I2 + m2 * c2 * c2;
    Eigen::Matrix2d M;
    M << I1 + m1 * c1 * c1 + m2 * l1 * l1 + b + 2 * ck + r1, b + ck, b + ck, b + r2;
    const double s1 = std::sin(q[0]), s12 = std::sin(q[0] + q[1]);
    const Eigen::Vector2d coriolis(-sk * (2 * v[0] * v[1] + v[1] * v[1]), sk * v[0] * v[0]);
    const Eigen::Vector2d gravity((m1 * c1 + m2 * l1) * g * s1 + m2 * c2 * g * s12,
                                  m2 * c2 * g * s12);
    return M.inverse() * (Eigen::Vector2d(tau[0], tau[1]) - coriolis - gravity);
  }
};

TEST(BulletArmDynamics, TwoLinksAccelerateAsTheLagrangianSaysWithAndWithoutRotors) {
  const unsigned seed = 560;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> angle(-pi, pi), speed(-3, 3), effort(-20, 20);
  for (const bool with_rotors : {true, false}) {
    TwoLink two;
    if (!with_rotors) two.r1 = two.r2 = 0.0;
    Arm arm(two.model(), {.substeps = 1});
    for (int sample = 0; sample < 200; ++sample) {
      const std::vector q{angle(generator), angle(generator)};
      const std::vector v{speed(generator), speed(generator)};
      const std::vector tau{effort(generator), effort(generator)};
      const Eigen::Vector2d expected = two.acceleration(q, v, tau);
      const std::vector<double> a = accelerations(arm, q, v, tau);
      EXPECT_NEAR(a[0], expected[0], 1e-7);
      EXPECT_NEAR(a[1], expected[1], 1e-7);
    }
  }
}

TEST(BulletArmDynamics, FirstOrderInTheSubStepTheEnergyOfASixLinkArmStays) {
  const ArmModel model = without_losses(puma560());
  const auto error_after_a_second = [&](int substeps) {
    Arm arm(model, {.substeps = substeps});
    arm.reset(std::vector{0.3, 0.8, -0.5, 0.4, 0.9, -0.2},
              std::vector{1.0, -0.5, 0.8, 2., -1., 3.});
    const double start = energy(model, arm);
    double largest = 0.0;
    for (int tick = 0; tick < 400; ++tick) {
      arm.step(1.0 / 400);
      largest = std::max(largest, std::abs(energy(model, arm) - start));
    }
    return largest;
  };
  const double coarse = error_after_a_second(4);
  const double fine = error_after_a_second(16);
  RecordProperty("largest_energy_error_J", std::to_string(coarse));
  EXPECT_LT(coarse, 0.5);                // of about 60 J exchanged
  EXPECT_NEAR(coarse / fine, 4.0, 0.5);  // second order: equations correct, only the step is coarse
}

TEST(BulletArmDynamics, TurningTheBaseAndGravityTogetherChangesNothing) {
  const ArmModel upright = puma560();
  ArmModel turned = upright;
  turned.X_WB = Eigen::Translation3d(1, -2, 3) * Eigen::AngleAxisd(2.0, Vec3(1, 2, -2) / 3.0) *
                Pose::Identity();
  turned.gravity_W = turned.X_WB.linear() * upright.gravity_W;
  Arm a(upright), b(turned);
  const std::vector q{0.3, 0.8, -0.5, 0.4, 0.9, -0.2};
  a.reset(q);
  b.reset(q);
  for (int tick = 0; tick < 100; ++tick) {
    a.step(1.0 / 400);
    b.step(1.0 / 400);
  }
  for (std::size_t i = 0; i < q.size(); ++i) {
    EXPECT_NEAR(positions(a)[i], positions(b)[i], 1e-10) << i;
  }
}

TEST(BulletArmDynamics, ARotatedBaseAloneChangesWhatGravityDoes) {
  ArmModel model = puma560();
  model.X_WB.linear() = Eigen::AngleAxisd(1.0, Vec3::UnitX()).toRotationMatrix();
  Arm arm(model);
  const std::vector q{0.3, 0.8, -0.5, 0.4, 0.9, -0.2};
  EXPECT_GT(std::abs(holding_torques(model, q)[0]), 1.0);  // upright, joint 1 has no gravity torque
  arm.reset(q);
  arm.set_torques(holding_torques(model, q));
  for (int tick = 0; tick < 400; ++tick) arm.step(1.0 / 400);
  for (std::size_t i = 0; i < q.size(); ++i) EXPECT_NEAR(positions(arm)[i], q[i], 1e-8) << i;
}

TEST(BulletArmDynamics, InertiaOffThePrincipalAxesIsRespected) {
  ArmModel model = turntable(0.0);
  const Mat3 R = Eigen::AngleAxisd(0.7, Vec3(2, -1, 2) / 3.0).toRotationMatrix();
  model.links[0].I_C_L = R * Vec3(0.3, 0.5, 0.7).asDiagonal() * R.transpose();
  Arm arm(model, {.substeps = 1});
  EXPECT_NEAR(accelerations(arm, {0.4}, {0.0}, {2.0})[0], 2.0 / model.links[0].I_C_L(2, 2), 1e-9);
}

TEST(BulletArmDynamics, APrismaticJointFallsFreelyAndCarriesWhatFollows) {
  ArmModel model;
  model.name = "lift";
  model.links = {link_with(3.0, {0.1, 0, 0}, {0.1, 0.1, 0.1}),
                 link_with(2.0, {0, 0, -0.5}, {0.03, 0.03, 0.001})};
  model.links[0].type = JointType::prismatic;
  model.links[1].axis_J = Vec3::UnitY();
  model.links[0].rotor_inertia = 1.5;
  Arm arm(model, {.substeps = 1});
  const std::vector<double> held =
      accelerations(arm, {0.2, 0.0}, {0.0, 0.0}, {5.0 * 9.81 + 13.0, 0.0});
  EXPECT_NEAR(held[0], 13.0 / (3.0 + 2.0 + 1.5), 1e-8);  // hanging straight down: no rotation
  EXPECT_NEAR(held[1], 0.0, 1e-8);
  arm.reset(std::vector{0.0, 0.0});
  for (int tick = 0; tick < 400; ++tick) arm.step(1.0 / 400);
  // Without the motor's 1.5 kg it would be 9.81.
  EXPECT_NEAR(velocities(arm)[0], -9.81 * 5.0 / 6.5, 1e-9);
}

TEST(BulletArmDynamics, SpeedIsNotClamped) {
  Arm arm(turntable(1e-3));
  arm.reset(std::vector{0.0}, std::vector{500.0});
  for (int tick = 0; tick < 4000; ++tick) arm.step(1.0 / 400);
  EXPECT_NEAR(velocities(arm)[0], 500.0, 1e-9);
}

}  // namespace arm_dynamics_test
}  // namespace repel::bullet::test
