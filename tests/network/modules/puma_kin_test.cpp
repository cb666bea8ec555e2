// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/puma_kin.hpp>

#include <gtest/gtest.h>

#include "network/drawn.hpp"

namespace repel::network {
namespace puma_kin_test {

using test::period;

constexpr unsigned seed = 17;

TEST(PumaKin, UsesOneJacobianBothWaysAndLosesNothing) {
  for (const int joints : {1, 3, 6, 8, 16}) {
    for (const Side root : {Side::left, Side::right}) {
      SCOPED_TRACE(std::string(test::to_text(root)) + ", " + std::to_string(joints) +
                   " joints, seed " + std::to_string(seed));
      Rng rng(seed);
      DrawnSignals drawn(rng, joints);
      DrawnEnds tool(rng, 6, 20.0);
      DrawnEnds arm(rng, joints, 5.0);
      Cell cell(PumaKin(), root);
      for (int tick = 0; tick < families::draws(1000000) / 10; ++tick) {
        const bool right = root == Side::right;
        const auto behind = !right          ? arm.definite()
                            : tick % 3 == 0 ? tool.slack()
                                            : tool.definite();
        const auto at = !right ? tool.slack() : tick % 3 == 0 ? arm.moved(1.0) : arm.definite();
        const Signals& signals = drawn.next();
        ASSERT_TRUE(cell.run(signals, behind, at));
        const auto& in_tool = right ? cell.at_leaf : cell.at_root;
        const auto& in_joints = right ? cell.at_root : cell.at_leaf;
        const auto& J = signals.jacobian;
        // The effort caused by rounding of the root's flow is fed back through the shown
        // equivalent.
        const double loop = right ? 1.0 : 1.0 + cell.shown.matrix.norm() * at.matrix.norm();
        ASSERT_LE((in_tool.flow - J * in_joints.flow).norm(),
                  1e-14 * loop * loop * (1.0 + in_tool.flow.norm()));
        ASSERT_LE((in_joints.effort - J.transpose() * in_tool.effort).norm(),
                  1e-9 * (1.0 + in_tool.effort.norm()));
        ASSERT_LE(cell.error_behind(behind), 1e-8);
      }
      EXPECT_GT(cell.ledger.passed, 1.0);
      EXPECT_LE(std::abs(cell.ledger.energy), 1e-9 * cell.ledger.passed);
      EXPECT_LE(cell.ledger.deficit(), 1e-9);
    }
  }
}

/// A Jacobian with a norm of at most one that is rank-deficient in the direction `lost` of the
/// tool, exactly or nearly.
Signals near_singularity(Rng& rng, const Vec3& lost, double left) {
  Signals signals;
  const Vector rates = test::drawn_vector(rng, 6, 1.0);
  signals.joints = signals.rates = signals.mean_rates = rates;
  signals.jacobian = test::drawn_gain(rng, 6, 0.1, 1.0);
  const Mat3 kept = Mat3::Identity() - (1.0 - left) * lost * lost.transpose();
  signals.jacobian.topRows<3>() = (kept * signals.jacobian.topRows<3>()).eval();
  return signals;
}

TEST(PumaKin, NothingGrowsAtASingularity) {
  Rng rng(seed);
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "draw", i));
    const Vec3 lost = families::direction(rng);
    const double left = i % 2 == 0 ? 0.0 : families::log_uniform(rng, 1e-15, 1e-3);
    const Signals signals = near_singularity(rng, lost, left);
    const double most = signals.jacobian.norm();
    for (const Side root : {Side::left, Side::right}) {
      const bool right = root == Side::right;
      DrawnEnds ends(rng, 6, 10.0);
      Cell cell(PumaKin(), root);
      const auto behind = ends.definite();
      ASSERT_TRUE(cell.run(signals, behind, right ? ends.moved(1.0) : ends.definite()));
      const auto& in_tool = right ? cell.at_leaf : cell.at_root;
      const auto& in_joints = right ? cell.at_root : cell.at_leaf;
      EXPECT_LE(in_joints.effort.norm(), most * in_tool.effort.norm() * (1.0 + 1e-9));
      EXPECT_LE(in_tool.flow.norm(), most * in_joints.flow.norm() * (1.0 + 1e-9));
      // The lost direction transmits neither motion nor force.
      EXPECT_LE(std::abs(lost.dot(in_tool.flow.head<3>())),
                (left + 1e-9) * (1.0 + in_joints.flow.norm()));
      Vector felt = in_tool.effort;
      felt.head<3>() -= lost.dot(in_tool.effort.head<3>()) * lost;
      EXPECT_LE((in_joints.effort - signals.jacobian.transpose() * felt).norm(),
                (left + 1e-9) * (1.0 + in_tool.effort.norm()));
    }
  }
}

// A mass behind a singular arm keeps its momentum in the lost direction.
TEST(PumaKin, SingularArmHoldsItsToolStill) {
  Rng rng(seed);
  Signals signals = near_singularity(rng, Vec3::UnitZ(), 0.0);
  Cell cell(PumaKin(), Side::right);
  Equivalent<any_size> pushed;
  pushed.set_impedance(Matrix::Zero(6, 6), 10.0 * Vector::Unit(6, 2));
  Equivalent<any_size> light;
  light.set_impedance(1e-6 * Matrix::Identity(6, 6), Vector::Zero(6));
  ASSERT_TRUE(cell.run(signals, pushed, light));
  EXPECT_LE(cell.at_root.effort.norm(), 1e-12);
  EXPECT_LE(cell.at_leaf.flow.norm(), 1e-6);
}

TEST(PumaKin, RefusesWhatIsRigidBehindIt) {
  Rng rng(seed);
  DrawnSignals drawn(rng, 6);
  for (const Side root : {Side::left, Side::right}) {
    DrawnEnds ends(rng, 6, 10.0);
    Cell cell(PumaKin(), root);
    const auto behind = root == Side::right ? ends.moved(1.0) : ends.slack();
    EXPECT_FALSE(cell.run(drawn.next(), behind, ends.definite()));
  }
}

}  // namespace puma_kin_test
}  // namespace repel::network
