// SPDX-License-Identifier: BSD-3-Clause
// The equations of motion of the arms compared with independently known results.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <repel/base/setup_error.hpp>
#include <repel/robots/dynamics.hpp>

#include "arms.hpp"

namespace repel {
namespace dynamics_test {

using std::numbers::pi;
constexpr unsigned seed = 1986;
constexpr double infinite = std::numeric_limits<double>::infinity();

Eigen::MatrixXd inertia_of(const ArmModel& arm, const std::vector<double>& q) {
  Dynamics dynamics(arm);
  Eigen::MatrixXd M(dynamics.links(), dynamics.links());
  dynamics.inertia(q, M);
  return M;
}

TEST(Dynamics, InertiaIsThatOfTheLinksMovingWithTheirJacobians) {
  std::mt19937_64 random(seed);
  for (const ArmModel& arm : test::all_arms()) {
    SCOPED_TRACE(arm.name + ", seed " + std::to_string(seed));
    Kinematics kinematics(arm);
    const int n = kinematics.links();
    for (int sample = 0; sample < 20; ++sample) {
      const auto q = test::random_joints(arm, random);
      kinematics.update(q);
      Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(n, n);
      for (int i = 0; i < n; ++i) {
        const ArmLink& link = arm.links[static_cast<std::size_t>(i)];
        Eigen::Matrix<double, 6, Eigen::Dynamic> J(6, n);
        const Pose& X_WL = kinematics.X_WL(i);
        kinematics.jacobian(i, X_WL * link.p_LC, J);
        const Mat3 I_W = X_WL.linear() * link.I_C_L * X_WL.linear().transpose();
        expected += link.mass * J.topRows<3>().transpose() * J.topRows<3>() +
                    J.bottomRows<3>().transpose() * I_W * J.bottomRows<3>();
        expected(i, i) += link.rotor_inertia;
      }
      ASSERT_LT((inertia_of(arm, q) - expected).norm(), 1e-12 * expected.norm());
    }
  }
}

// P. Corke, Robotics, Vision and Control: p560.inertia(qn), motors included.
TEST(Dynamics, StandardPumaHasTheInertiaOfTheToolbox) {
  const Eigen::MatrixXd M =
      inertia_of(load_arm("robots/puma560.urdf").arm, {0, pi / 4, pi, 0, pi / 4, 0});
  Eigen::Matrix<double, 6, 6> published;
  published << 3.6594, -0.4044, 0.1006, -0.0025, 0, 0,  //
      -0.4044, 4.4137, 0.3509, 0, 0.0024, 0,            //
      0.1006, 0.3509, 0.9378, 0, 0.0015, 0,             //
      -0.0025, 0, 0, 0.1925, 0, 0,                      //
      0, 0.0024, 0.0015, 0, 0.1713, 0,                  //
      0, 0, 0, 0, 0, 0.1941;
  EXPECT_LT((M - published).cwiseAbs().maxCoeff(), 1e-4) << M;
}

// B. Armstrong, O. Khatib and J. Burdick 1986: inertial constants of the explicit model [kg m^2]
// and their factors. Two of the constants, and the sum of two more, follow from the published
// masses and inertias only with other numbers for links 1 to 3 (docs/robots.md) and are not
// checked.
TEST(Dynamics, ArmstrongPumaHasThePublishedInertialConstants) {
  ArmModel arm = load_arm("robots/puma560_armstrong.urdf").arm;
  for (ArmLink& link : arm.links) link.rotor_inertia = 0.0;  // published separately
  Dynamics dynamics(arm);
  Eigen::MatrixXd M(6, 6);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> any(-pi, pi);
  for (int sample = 0; sample < 200; ++sample) {
    std::vector<double> q(6);
    for (double& x : q) x = any(random);
    dynamics.inertia(q, M);
    const double s2 = std::sin(q[1]), c2 = std::cos(q[1]);
    const double s3 = std::sin(q[2]), c3 = std::cos(q[2]);
    const double s23 = std::sin(q[1] + q[2]), c23 = std::cos(q[1] + q[2]);
    const double s4 = std::sin(q[3]), c4 = std::cos(q[3]);
    const double s5 = std::sin(q[4]), c5 = std::cos(q[4]);
    const double m13 = -0.134 * c23 - 0.00379 * s23 - 0.00125 * c23 * s4 * s5 +
                       0.000431 * (s23 * c4 * s5 - c23 * c5) + 0.0003 * s23 * s4 * c4;
    const double m12 = m13 + 0.690 * s2 + 0.0238 * c2 + 0.00124 * s2 * s4 * s5;
    const double lever = s3 * c5 + c3 * c4 * s5;
    const double m22_less_m33 = 1.75 + 2.0 * (0.372 * s3 - 0.0110 * c3 + 0.00124 * lever);
    ASSERT_NEAR(M(0, 1), m12, 1e-3) << "seed " << seed;
    ASSERT_NEAR(M(0, 2), m13, 5e-4) << "seed " << seed;
    ASSERT_NEAR(M(1, 1) - M(2, 2), m22_less_m33, 5e-3) << "seed " << seed;
    ASSERT_NEAR(M(1, 2) - M(2, 2), 0.372 * s3 - 0.0110 * c3 + 0.00124 * lever, 1e-3);
    ASSERT_NEAR(M(3, 3), 0.00164 + 0.000202 * s5 * s5, 1e-5);
    ASSERT_NEAR(M(4, 4), 0.000642, 1e-5);
    ASSERT_NEAR(M(5, 5), 0.00004, 1e-5);
  }
}

// The same for rotation about the vertical: the squared lever arm of the forearm and its products.
TEST(Dynamics, ArmstrongPumaTurnsAboutTheVerticalWithThePublishedConstants) {
  ArmModel arm = load_arm("robots/puma560_armstrong.urdf").arm;
  Dynamics dynamics(arm);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> any(-pi, pi);
  constexpr int samples = 200;
  Eigen::MatrixXd M(6, 6), factors(samples, 7);
  Eigen::VectorXd m11(samples);
  for (int sample = 0; sample < samples; ++sample) {
    const double q2 = any(random), q23 = any(random);
    dynamics.inertia(std::vector<double>{0, q2, q23 - q2, 0, pi / 2, 0}, M);
    m11(sample) = M(0, 0);
    factors.row(sample) << 1.0, std::pow(std::cos(q2), 2), std::pow(std::sin(q23), 2),
        std::sin(q23) * std::cos(q23), std::sin(q2) * std::cos(q2),
        2.0 * std::cos(q2) * std::sin(q23), 2.0 * std::cos(q2) * std::cos(q23);
  }
  const Eigen::VectorXd constants = factors.colPivHouseholderQr().solve(m11);
  EXPECT_LT((factors * constants - m11).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_NEAR(constants(2), 0.298, 0.002);
  // The wrist, bent by a right angle, adds I15 and I16.
  EXPECT_NEAR(constants(3), -0.0213 + 2.0 * 0.00125, 0.001);
  EXPECT_NEAR(constants(4), -0.0142, 0.001);
  EXPECT_NEAR(constants(5), 0.372, 0.002);
  EXPECT_NEAR(constants(6), -0.0110 + 0.00124, 0.001);
}

/// One link that rotates about the horizontal axis y and hangs down at zero.
ArmModel pendulum() {
  ArmModel arm;
  arm.name = "pendulum";
  ArmLink link;
  link.name = "rod";
  link.joint_name = "pivot";
  link.mass = 2.0;
  link.p_LC = Vec3(0, 0, -0.5);
  link.I_C_L = Vec3(0.03, 0.03, 0.001).asDiagonal();
  link.axis_J = Vec3::UnitY();
  link.lower = -infinite;
  link.upper = infinite;
  arm.links.push_back(link);
  return arm;
}

double position(const ReferenceArm& arm) {
  double q = 0.0;
  arm.read_positions({&q, 1});
  return q;
}

TEST(ReferenceArm, PendulumSwingsWithThePeriodOfTheEllipticIntegral) {
  const ArmModel model = pendulum();
  const double amplitude = 1.0;
  const double inertia = 0.03 + 2.0 * 0.25;
  const double omega = std::sqrt(2.0 * 9.81 * 0.5 / inertia);
  double a = 1.0;  // complete elliptic integral by the arithmetic-geometric mean
  double b = std::cos(0.5 * amplitude);
  for (int i = 0; i < 10; ++i) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  const double period = 2.0 * pi / (omega * a);
  ReferenceArm arm(model);
  arm.reset(std::vector{amplitude});
  for (int step = 0; step < 1000; ++step) arm.step(10.0 * period / 1000.0);
  EXPECT_NEAR(position(arm), amplitude, 1e-10);
}

/// Energy [J] of an arm: kinetic plus gravitational.
double energy_of(ReferenceArm& arm, const ArmModel& model) {
  Kinematics kinematics(model);
  std::vector<double> q(model.links.size());
  arm.read_positions(q);
  kinematics.update(q);
  double energy = arm.kinetic_energy();
  for (int i = 0; i < kinematics.links(); ++i) {
    const ArmLink& link = model.links[static_cast<std::size_t>(i)];
    energy -= link.mass * model.gravity_W.dot(kinematics.X_WL(i) * link.p_LC);
  }
  return energy;
}

// Halving the step reduces the error by a factor of 16: fourth order.
TEST(ReferenceArm, EnergyOfAFallingPumaStaysToTheFourthOrder) {
  ArmModel model = load_arm("robots/puma560_armstrong.urdf").arm;
  for (ArmLink& link : model.links) link.viscous_friction = link.coulomb_friction = 0.0;
  const auto drift = [&](int substeps) {
    ReferenceArm arm(model, {.substeps = substeps});
    arm.reset(std::vector{0.0, -1.2, 0.4, 0.3, 0.5, 0.0});
    const double before = energy_of(arm, model);
    for (int tick = 0; tick < 400; ++tick) arm.step(1.0 / 400.0);
    EXPECT_GT(arm.kinetic_energy(), 10.0) << "it must have fallen";
    return std::abs(energy_of(arm, model) - before);
  };
  const double coarse = drift(1);
  EXPECT_LT(coarse, 1e-4);
  EXPECT_LT(drift(2), coarse / 10.0);
  EXPECT_LT(drift(16), 1e-8);
}

TEST(ReferenceArm, FrictionEndsInTheSpeedWhereItTakesAllTorque) {
  ArmModel model = pendulum();
  model.gravity_W.setZero();
  model.links[0].viscous_friction = 2.0;
  model.links[0].coulomb_friction = 3.0;
  ReferenceArm arm(model);
  arm.set_torques(std::vector{4.0});
  for (int tick = 0; tick < 4000; ++tick) arm.step(1.0 / 400.0);
  double v = 0.0;
  arm.read_velocities({&v, 1});
  EXPECT_NEAR(v, (4.0 - 3.0) / 2.0, 1e-9);
}

TEST(ReferenceArm, RefusesWhatHasNoMotionAndLivesThroughBadInput) {
  ArmModel light = pendulum();
  light.links[0].mass = 0.0;
  light.links[0].I_C_L.setZero();
  EXPECT_THROW(ReferenceArm{light}, SetupError);
  EXPECT_THROW((ReferenceArm{pendulum(), {.substeps = 0}}), SetupError);
  ReferenceArm arm(pendulum());
  EXPECT_THROW(arm.reset(std::vector{0.0, 0.0}), SetupError);
  EXPECT_THROW(arm.reset(std::vector{infinite}), SetupError);
  arm.set_torques(std::vector{std::nan("")});
  arm.step(std::nan(""));
  arm.step(-1.0);
  EXPECT_EQ(position(arm), 0.0);
  arm.set_torques(std::vector{1e300});
  for (int tick = 0; tick < 100; ++tick) arm.step(0.1);
  EXPECT_TRUE(std::isfinite(position(arm)));
}

}  // namespace dynamics_test
}  // namespace repel
