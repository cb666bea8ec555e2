// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/relief.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>

#include "network/drawn.hpp"

namespace repel::network {
namespace relief_test {

using test::period;

constexpr unsigned seed = 41;
using Six = Eigen::Matrix<double, 6, 1>;

Six turned_back(const Mat3& turn, const Vector& world) {
  Six task;
  task << turn.transpose() * world.head<3>(), turn.transpose() * world.tail<3>();
  return task;
}
Equivalent<any_size> ground() {
  Equivalent<any_size> at_rest;
  at_rest.set_admittance(Matrix::Zero(6, 6), Vector::Zero(6));
  return at_rest;
}
/// Applies `effort` to the rest of the network.
Equivalent<any_size> push(const Vector& effort) {
  Equivalent<any_size> source;
  source.set_impedance(Matrix::Zero(6, 6), -effort);
  return source;
}

// The frame jumps arbitrarily between two ticks, and the one-ports at both ends are different in
// each.
TEST(Relief, GivesWayAlongItsDirectionsOnlyAndTurningAddsNoEnergy) {
  for (const auto frame : {ReliefFrame::tool, ReliefFrame::world}) {
    for (const Side root : {Side::left, Side::right}) {
      SCOPED_TRACE(std::string(test::to_text(root)) + ", seed " + std::to_string(seed));
      Rng rng(seed);
      DrawnSignals drawn(rng, 0);
      DrawnEnds ends(rng, 6, 20.0);
      Cell cell(Relief({.compliant = {true, false, true, false, false, true},
                        .frame = frame,
                        .damping = 5.0}),
                root);
      double lost = 0.0;
      for (int tick = 0; tick < families::draws(1000000) / 4; ++tick) {
        const auto behind = tick % 3 == 0 ? ends.slack() : ends.moved(0.5);
        const Signals& signals = drawn.next();
        ASSERT_TRUE(cell.run(signals, behind, ends.definite()));
        ASSERT_EQ(cell.at_root.effort, cell.at_leaf.effort);
        const Mat3 turn =
            frame == ReliefFrame::tool ? Mat3(signals.X_WT.linear()) : Mat3::Identity();
        const Six relative = turned_back(turn, cell.at_root.flow - cell.at_leaf.flow);
        for (const int stiff : {1, 3, 4})
          ASSERT_LE(std::abs(relative(stiff)), 1e-12 * (1.0 + relative.norm()));
        ASSERT_LE(cell.error_behind(behind), 1e-8);
        const double lost_now = cell.ledger.energy - cell.module.stored();
        ASSERT_GE(lost_now, lost - 1e-12 * (1.0 + cell.ledger.passed)) << "tick " << tick;
        lost = lost_now;
      }
      EXPECT_GT(lost, 1.0);
      EXPECT_LE(cell.ledger.deficit(), 1e-9);
    }
  }
}

// A constant force from the root side; the far side is fixed.
TEST(Relief, StretchesByForceOverStiffnessAndReturns) {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  Signals signals;
  signals.X_WT.linear() = turn;
  for (const Side root : {Side::left, Side::right}) {
    Cell cell(Relief({.compliant = {true, false, false, false, true, false},
                      .stiffness = 400.0,
                      .damping = 20.0,
                      .angular_stiffness = 8.0,
                      .angular_damping = 0.4}),
              root);
    Vector effort(6);
    effort << turn * Vec3(10.0, 7.0, -3.0), turn * Vec3(1.0, 2.0, 3.0);
    Six stretch = Six::Zero();
    for (int tick = 0; tick < 2000; ++tick) {
      ASSERT_TRUE(cell.run(signals, ground(), push(effort)));
      stretch += period * turned_back(turn, cell.at_root.flow - cell.at_leaf.flow);
    }
    Six expected = Six::Zero();
    expected(0) = 10.0 / 400.0;
    expected(4) = 2.0 / 8.0;
    EXPECT_LE((stretch - expected).norm(), 1e-9) << test::to_text(root);
    EXPECT_NEAR(cell.module.stored(), 0.5 * (10.0 * 10.0 / 400.0 + 2.0 * 2.0 / 8.0), 1e-9);
    for (int tick = 0; tick < 2000; ++tick) {
      ASSERT_TRUE(cell.run(signals, ground(), push(Vector::Zero(6))));
      stretch += period * turned_back(turn, cell.at_root.flow - cell.at_leaf.flow);
    }
    EXPECT_LE(stretch.norm(), 1e-9);
    EXPECT_NEAR(cell.module.stored(), 0.0, 1e-12);
    EXPECT_LE((cell.module.most_given() - expected).norm(), 1e-9) << "the most, also afterwards";
  }
}

TEST(Relief, PureDamperCreepsAndDoesNotReturn) {
  Cell cell(Relief({.compliant = {false, true, false, true, false, false},
                    .stiffness = 0.0,
                    .damping = 50.0,
                    .angular_stiffness = 0.0,
                    .angular_damping = 0.5}),
            Side::right);
  for (int tick = 0; tick < 400; ++tick) {
    ASSERT_TRUE(cell.run({}, ground(), push(Vector::Constant(6, 2.0))));
    EXPECT_NEAR(cell.at_root.flow(1), 2.0 / 50.0, 1e-12);
    EXPECT_NEAR(cell.at_root.flow(3), 2.0 / 0.5, 1e-12);
  }
  ASSERT_TRUE(cell.run({}, ground(), push(Vector::Zero(6))));
  EXPECT_EQ(cell.at_root.flow.norm(), 0.0);
  EXPECT_EQ(cell.module.stored(), 0.0);
  EXPECT_EQ(cell.module.most_given().norm(), 0.0);
}

// A spring stretched along the tool axis pulls along the tool axis also after it has rotated.
TEST(Relief, StretchTurnsWithTheTool) {
  Cell cell(Relief({.compliant = {true, false, false, false, false, false}, .stiffness = 400.0}),
            Side::right);
  Signals signals;
  for (int tick = 0; tick < 2000; ++tick) {
    ASSERT_TRUE(cell.run(signals, ground(), push(10.0 * Vector::Unit(6, 0))));
  }
  const double stored = cell.module.stored();
  signals.X_WT.linear() = Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitZ()).toRotationMatrix();
  ASSERT_TRUE(cell.run(signals, ground(), push(10.0 * Vector::Unit(6, 1))));
  EXPECT_LE(cell.at_root.flow.norm(), 1e-9);  // the same force along the tool holds it
  EXPECT_NEAR(cell.module.stored(), stored, 1e-9);
}

TEST(Relief, LetsGoAtRest) {
  Cell cell(Relief({.compliant = {true, true, true, true, true, true}}), Side::right);
  for (int tick = 0; tick < 100; ++tick) {
    ASSERT_TRUE(cell.run({}, ground(), push(Vector::Constant(6, 2.0))));
  }
  EXPECT_GT(cell.module.stored(), 1e-3);
  Signals rest;
  rest.at_rest = true;
  cell.module.read(rest);
  EXPECT_EQ(cell.module.stored(), 0.0);
}

// A constant force through a direction that becomes rigid, and compliant again.
TEST(Relief, HoldsTheExtensionOfADirectionThatBecomesRigid) {
  Cell cell(Relief({.compliant = {true, false, false, false, false, false},
                    .stiffness = 400.0,
                    .damping = 40.0}),
            Side::right);
  Signals signals;
  double stretch = 0.0, last = 0.0, most_change = 0.0;
  const auto run = [&](int ticks) {
    for (int tick = 0; tick < ticks; ++tick) {
      ASSERT_TRUE(cell.run(signals, ground(), push(20.0 * Vector::Unit(6, 0))));
      const double rate = cell.at_root.flow(0) - cell.at_leaf.flow(0);
      most_change = std::max(most_change, std::abs(rate - last));
      last = rate;
      stretch += period * rate;
    }
  };
  run(2000);
  EXPECT_NEAR(stretch, 20.0 / 400.0, 1e-6);
  most_change = 0.0;
  signals.hand.compliant = 0;
  run(400);
  EXPECT_NEAR(stretch, 20.0 / 400.0, 1e-6) << "held";
  EXPECT_EQ(cell.module.stored(), 0.0);
  EXPECT_NEAR(cell.module.forgotten(), 0.5 * 20.0 * 20.0 / 400.0, 1e-6);
  EXPECT_FALSE(cell.module.gives(0));
  EXPECT_LE(most_change, 1e-6);
  signals.hand.compliant = 1;
  run(1);
  EXPECT_LE(cell.module.stored(), 1e-3) << "begins without force";
  run(2000);
  EXPECT_NEAR(stretch, 2.0 * 20.0 / 400.0, 1e-5) << "gives once more";
  // Without the ramp it would begin at once with the rate of its damper, 20 N / 40 N s/m.
  EXPECT_LE(most_change, 1.01 * 0.5 * period / Relief::switching_time);
  EXPECT_LE(cell.ledger.deficit(), 1e-12);
  EXPECT_NEAR(cell.ledger.energy, stretch * 20.0, 1e-9) << "all that it took is in the books";
}

TEST(Relief, MovesOnWhereADirectionBecomesRigid) {
  Cell cell(Relief({.compliant = {true, false, false, false, false, false},
                    .stiffness = 0.0,
                    .damping = 40.0}),
            Side::right);
  Signals signals;
  double last = 0.5;
  ASSERT_TRUE(cell.run(signals, ground(), push(20.0 * Vector::Unit(6, 0))));
  signals.hand.compliant = 0;
  for (int tick = 0; tick < 100; ++tick) {
    ASSERT_TRUE(cell.run(signals, ground(), push(20.0 * Vector::Unit(6, 0))));
    const double rate = cell.at_root.flow(0);
    EXPECT_LE(rate, last + 1e-12);
    EXPECT_GE(rate, last - 1.01 * 0.5 * period / Relief::switching_time);
    last = rate;
  }
  EXPECT_EQ(last, 0.0);
}

TEST(Relief, ChangesItsFrameWhileItIsRigid) {
  Cell cell(Relief({.compliant = {true, true, true, false, false, false}, .stiffness = 400.0}),
            Side::right);
  Signals signals;
  signals.X_WT.linear() = Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitZ()).toRotationMatrix();
  Vector last = Vector::Zero(6);
  const double full = 1.0 / (0.5 * 400.0 * period + ReliefOptions{}.damping);
  for (int tick = 0; tick < 2000; ++tick) {
    if (tick == 1000) signals.hand.compliant = 1 | Relief::world_bit;
    ASSERT_TRUE(cell.run(signals, ground(), push(10.0 * Vector::Unit(6, 0))));
    const Vector rate = cell.at_root.flow;
    ASSERT_LE((rate - last).norm(), tick == 0 ? 1.0 : 10.0 * full * 0.02) << tick;
    last = rate;
    if (tick == 999) {
      EXPECT_EQ(cell.module.frame(), ReliefFrame::tool);
    }
    if (tick == 1000 + 79) {
      EXPECT_FALSE(cell.module.gives(0));
    }
  }
  EXPECT_EQ(cell.module.frame(), ReliefFrame::world);
  EXPECT_TRUE(cell.module.gives(0));
  EXPECT_FALSE(cell.module.gives(1));
  EXPECT_NEAR(cell.module.stored(), 0.5 * 10.0 * 10.0 / 400.0, 1e-4) << "along x of the world";
  signals.hand.compliant = -1;
  for (int tick = 0; tick < 1000; ++tick) {
    ASSERT_TRUE(cell.run(signals, ground(), push(10.0 * Vector::Unit(6, 0))));
  }
  EXPECT_EQ(cell.module.frame(), ReliefFrame::tool);
  EXPECT_TRUE(cell.module.gives(2));
}

TEST(Relief, SwitchedAtRandomReturnsNoMoreThanItTook) {
  for (const Side root : {Side::left, Side::right}) {
    Rng rng(seed);
    DrawnSignals drawn(rng, 0);
    DrawnEnds ends(rng, 6, 20.0);
    Cell cell(Relief({.compliant = {true, false, true, false, false, true}, .damping = 5.0}), root);
    double lost = 0.0;
    int changes = 0;
    for (int tick = 0; tick < families::draws(400000); ++tick) {
      if (tick % 60 == 0) {
        drawn.signals.hand.compliant = families::count_between(rng, -1, 127);
        ++changes;
      }
      const auto behind = tick % 3 == 0 ? ends.slack() : ends.moved(0.5);
      const Signals& signals = drawn.next();
      ASSERT_TRUE(cell.run(signals, behind, ends.definite()));
      ASSERT_EQ(cell.at_root.effort, cell.at_leaf.effort);
      ASSERT_LE(cell.error_behind(behind), 1e-8);
      const double lost_now = cell.ledger.energy - cell.module.stored();
      ASSERT_GE(lost_now, lost - 1e-12 * (1.0 + cell.ledger.passed)) << "tick " << tick;
      lost = lost_now;
    }
    EXPECT_GT(changes, 10);
    EXPECT_GT(cell.module.forgotten(), 1e-3);
    EXPECT_LE(cell.ledger.deficit(), 1e-9) << test::to_text(root) << ", seed " << seed;
  }
}

TEST(Relief, RefusesADirectionThatHoldsNothing) {
  const ReliefOptions slack{
      .compliant = {true, false, false, false, false, false}, .stiffness = 0.0, .damping = 0.0};
  EXPECT_THROW(Relief{slack}, SetupError);
  const ReliefOptions turning{.compliant = {false, false, false, false, false, true},
                              .angular_stiffness = 0.0,
                              .angular_damping = 0.0};
  EXPECT_THROW(Relief{turning}, SetupError);
  EXPECT_NO_THROW(Relief({.stiffness = 0.0, .damping = 0.0}));  // no direction at all
  EXPECT_THROW(Relief({.stiffness = -1.0}), SetupError);
  EXPECT_THROW(Relief({.angular_damping = std::nan("")}), SetupError);
}

}  // namespace relief_test
}  // namespace repel::network
