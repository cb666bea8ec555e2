// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/multiplex.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>

#include "network/drawn.hpp"

namespace repel::network {
namespace multiplex_test {

using test::period;

constexpr unsigned seed = 3;
using Six = Eigen::Matrix<double, 6, 1>;

Signals toward(const Vec3& direction_W) {
  Signals signals;
  signals.hand.direction_W = direction_W;
  return signals;
}

/// d as six numbers.
Six along(const Multiplex& multiplex) {
  Six d = Six::Zero();
  d.head<3>() = multiplex.direction();
  d.tail<3>() = multiplex.turning();
  return d;
}

TEST(Multiplex, TransformsAlongItsDirectionAndLosesNothing) {
  const int ticks = families::draws(1000000) / 4;
  for (const Side root : {Side::left, Side::right}) {
    for (const double s_f : {0.2, 0.05}) {
      SCOPED_TRACE(std::string(test::to_text(root)) + ", seed " + std::to_string(seed));
      Rng rng(seed);
      DrawnSignals drawn(rng, 0);
      DrawnEnds tool(rng, 6, 20.0);
      DrawnEnds lever(rng, 1, 2.0);
      Cell cell(Multiplex({.velocity_scale = 0.2, .force_scale = s_f}), root);
      for (int tick = 0; tick < ticks; ++tick) {
        const bool right = root == Side::right;
        const Equivalent<any_size> behind = right ? lever.definite() : tool.slack();
        ASSERT_TRUE(cell.run(drawn.next(), behind, right ? tool.slack() : lever.definite()));
        const auto& at_tool = right ? cell.at_root : cell.at_leaf;
        const auto& at_lever = right ? cell.at_leaf : cell.at_root;
        const Six d = along(cell.module);
        ASSERT_LE((at_tool.flow - 0.2 * d * at_lever.flow(0)).norm(),
                  1e-11 * (1.0 + at_tool.flow.norm()));
        ASSERT_NEAR(at_lever.effort(0), s_f * d.dot(at_tool.effort), 1e-8);
        ASSERT_LE(cell.error_behind(behind), 1e-8) << tick;
      }
      EXPECT_GT(cell.ledger.passed, 1.0);
      EXPECT_LE(std::abs(cell.ledger.energy), 1e-9 * cell.ledger.passed);
      EXPECT_LE(cell.ledger.deficit(), 1e-9);
    }
  }
}

TEST(Multiplex, PassesOnItsPowerFactor) {
  Rng rng(seed);
  DrawnEnds tool(rng, 6, 20.0);
  DrawnEnds lever(rng, 1, 2.0);
  for (int i = 0; i < 1000; ++i) {
    const double s_v = families::log_uniform(rng, 1e-3, 10.0);
    const double s_f = families::log_uniform(rng, 1e-3, 10.0);
    Cell cell(Multiplex({.velocity_scale = s_v, .force_scale = s_f}), Side::right);
    ASSERT_TRUE(cell.run(toward(families::direction(rng)), lever.definite(), tool.definite()));
    const double to_lever = cell.at_leaf.power();
    EXPECT_DOUBLE_EQ(cell.module.power_factor(), s_f / s_v);
    const double moved = cell.at_root.effort.norm() * cell.at_root.flow.norm();
    EXPECT_NEAR(to_lever, s_f / s_v * cell.at_root.power(), 1e-8 * s_f / s_v * moved)
        << "seed " << seed << ", draw " << i;
  }
}

TEST(Multiplex, FirstDirectionHoldsAtOnceAndTheNextIsApproached) {
  for (const double T : {0.001, 0.0025, 0.01}) {
    Multiplex multiplex({.turning_time = 0.05});
    multiplex.prepare(T);
    multiplex.read(toward(Vec3::UnitX()));
    EXPECT_EQ(multiplex.direction(), Vec3::UnitX());
    for (int tick = 0; tick < std::lround(0.05 / T); ++tick) multiplex.read(toward(Vec3::UnitY()));
    const double left = std::exp(-1.0);
    EXPECT_LE((multiplex.direction() - Vec3(left, 1.0 - left, 0.0)).norm(), 1e-12);
  }
  Multiplex at_once({.turning_time = 0.0});
  at_once.prepare(period);
  at_once.read(toward(Vec3::UnitX()));
  at_once.read(toward(Vec3::UnitZ()));
  EXPECT_EQ(at_once.direction(), Vec3::UnitZ());
}

/// The largest step of the torque at a fixed lever while a force acts on the tool and the direction
/// is rotated.
double largest_step(double T) {
  Multiplex multiplex({.turning_time = 0.05});
  multiplex.face(Side::left);
  multiplex.prepare(T);
  Equivalent<any_size> tool;
  tool.set_impedance(test::Matrix::Zero(6, 6), test::Vector::Constant(6, 10.0));
  Equivalent<any_size> shown;
  double last = 0.0;
  double largest = 0.0;
  for (int tick = 0; tick < std::lround(0.2 / T); ++tick) {
    multiplex.read(toward(tick * T < 0.1 ? Vec3::UnitX() : Vec3(-Vec3::UnitY())));
    EXPECT_TRUE(multiplex.reflected(tool, shown));
    if (tick > 0) largest = std::max(largest, std::abs(shown.offset(0) - last));
    last = shown.offset(0);
  }
  EXPECT_LT(last, 0.0);  // finally in the opposite direction
  return largest;
}

TEST(Multiplex, FeltEffortDoesNotJumpWhenTheDirectionDoes) {
  const double coarse = largest_step(0.0025);
  EXPECT_LT(coarse, 0.11);  // a jump would be 2 N m
  EXPECT_NEAR(largest_step(0.00025) / coarse, 0.1, 0.005);
  EXPECT_NEAR(largest_step(0.000025) / coarse, 0.01, 0.0005);
}

TEST(Multiplex, AScaleThatChangesLosesNothing) {
  Rng rng(seed);
  SCOPED_TRACE("seed " + std::to_string(seed));
  DrawnSignals drawn(rng, 0);
  DrawnEnds tool(rng, 6, 20.0);
  DrawnEnds lever(rng, 1, 2.0);
  Cell cell(Multiplex({.velocity_scale = 0.2, .force_scale = 0.2}), Side::right);
  double least = 1e9, greatest = 0.0;
  for (int tick = 0; tick < families::draws(20000); ++tick) {
    Signals signals = drawn.next();
    signals.hand.scale = tick % 400 < 200 ? 0.2 : 5.0;
    ASSERT_TRUE(cell.run(signals, lever.definite(), tool.slack()));
    const double scale = cell.module.flow_scale();
    least = std::min(least, scale);
    greatest = std::max(greatest, scale);
    const Six d = along(cell.module);
    ASSERT_LE((cell.at_root.flow - scale * d * cell.at_leaf.flow(0)).norm(),
              1e-11 * (1.0 + cell.at_root.flow.norm()));
    ASSERT_NEAR(cell.at_leaf.effort(0), scale * d.dot(cell.at_root.effort), 1e-8);
  }
  EXPECT_LT(least, 0.3);
  EXPECT_GT(greatest, 0.6);
  EXPECT_LE(std::abs(cell.ledger.energy), 1e-9 * cell.ledger.passed);
}

TEST(Multiplex, AScrewPassesOnAllPowerThatItsTurningTakes) {
  Rng rng(seed);
  SCOPED_TRACE("seed " + std::to_string(seed));
  DrawnEnds tool(rng, 6, 20.0);
  DrawnEnds lever(rng, 1, 2.0);
  double moving = 0.0, turning = 0.0;
  for (int i = 0; i < families::draws(2000); ++i) {
    Signals signals = toward(families::uniform(rng, 0.0, 1.0) * families::direction(rng));
    signals.hand.turning_W = families::uniform(rng, 0.0, 10.0) * families::direction(rng);
    Cell cell(Multiplex({.velocity_scale = 0.1, .force_scale = 0.1}), Side::right);
    ASSERT_TRUE(cell.run(signals, lever.definite(), tool.definite()));
    const auto& at_tool = cell.at_root;
    ASSERT_LE((at_tool.flow.tail(3) - 0.1 * cell.at_leaf.flow(0) * signals.hand.turning_W).norm(),
              1e-9 * (1.0 + at_tool.flow.norm()));
    const double size = at_tool.effort.norm() * at_tool.flow.norm();
    ASSERT_NEAR(cell.at_leaf.power(), at_tool.power(), 1e-8 * size);
    moving += std::abs(at_tool.effort.head(3).dot(at_tool.flow.head(3)));
    turning += std::abs(at_tool.effort.tail(3).dot(at_tool.flow.tail(3)));
  }
  EXPECT_GT(moving, 0.1 * turning);
  EXPECT_GT(turning, 0.1 * moving);
}

TEST(Multiplex, ATurningIsApproachedLikeADirection) {
  Multiplex multiplex({.turning_time = 0.05});
  multiplex.prepare(0.0025);
  Signals signals = toward(Vec3::UnitX());
  multiplex.read(signals);
  EXPECT_EQ(multiplex.turning(), Vec3::Zero());
  signals.hand.turning_W = Vec3(0, 0, 10);
  for (int tick = 0; tick < 20; ++tick) multiplex.read(signals);
  EXPECT_NEAR(multiplex.turning().z(), 10.0 * (1.0 - std::exp(-1.0)), 1e-9);
}

TEST(Multiplex, RefusesNumbersOutOfRange) {
  EXPECT_THROW(Multiplex({.velocity_scale = 0.0}), SetupError);
  EXPECT_THROW(Multiplex({.force_scale = -1.0}), SetupError);
  EXPECT_THROW(Multiplex({.turning_time = std::nan("")}), SetupError);
}

}  // namespace multiplex_test
}  // namespace repel::network
