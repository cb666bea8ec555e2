#include <repel/network/modules/relief.hpp>

#include <gtest/gtest.h>

#include "network/drawn.hpp"

namespace repel::network {
namespace relief_test {

using test::Cell;
using test::DrawnEnds;
using test::DrawnSignals;
using test::Matrix;
using test::period;
using test::Rng;
using test::Vector;

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
