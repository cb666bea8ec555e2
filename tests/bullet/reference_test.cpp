// The Bullet arm against the equations of motion solved to a high order.
#include <gtest/gtest.h>

#include <cmath>

#include <repel/robots/dynamics.hpp>

#include "arms.hpp"

namespace repel::bullet::test {
namespace reference_test {

/// Joint positions of a second under slow torques [rad], tick by tick.
template <class Simulated>
std::vector<std::vector<double>> motion_of(Simulated arm) {
  arm.reset(std::vector{0.2, 0.9, 0.1, -0.3, 0.4, 0.5});
  std::vector<std::vector<double>> positions;
  for (int tick = 0; tick < 400; ++tick) {
    const double s = std::sin(0.02 * tick);
    arm.set_torques(std::vector{10.0 * s, 45.0 - 20.0 * s, 8.0 * s, 1.0 * s, -1.0 * s, 0.5 * s});
    arm.step(1.0 / 400.0);
    positions.emplace_back(6);
    arm.read_positions(positions.back());
  }
  return positions;
}

/// The greatest difference [rad] of a joint in any tick.
double apart(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b) {
  double most = 0.0;
  for (std::size_t tick = 0; tick < a.size(); ++tick) {
    for (std::size_t i = 0; i < a[tick].size(); ++i) {
      most = std::max(most, std::abs(a[tick][i] - b[tick][i]));
    }
  }
  return most;
}

TEST(BulletAgainstTheReference, PumaMovesAlikeToFirstOrderInTheSubStep) {
  ArmModel model = puma560();
  for (ArmLink& link : model.links) {  // the reference has no stops
    link.lower = -kInfinity;
    link.upper = kInfinity;
  }
  const auto reference = motion_of(ReferenceArm(model, {.substeps = 8}));
  EXPECT_LT(apart(reference, motion_of(ReferenceArm(model, {.substeps = 16}))), 1e-9);
  EXPECT_GT(apart(reference, {400, reference[0]}), 1.0) << "it must have moved";
  const auto error = [&](int substeps) {
    return apart(reference, motion_of(Arm(model, {.substeps = substeps})));
  };
  const double four = error(4);
  const double sixteen = error(16);
  EXPECT_LT(four, 5e-3);
  EXPECT_NEAR(sixteen / four, 0.25, 0.05);
  EXPECT_NEAR(error(64) / sixteen, 0.25, 0.05);
}

}  // namespace reference_test
}  // namespace repel::bullet::test
