// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/kbb2.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>
#include <repel/network/elements/one_ports.hpp>

#include "network/drawn.hpp"

namespace repel::network {
namespace kbb2_test {

using test::period;

constexpr unsigned seed = 9;
constexpr double no_limit = 1e6;

Kbb2 fitted(const Kbb2Options& options, Space space, int size) {
  Kbb2 kbb2(options);
  kbb2.fit(space, size);
  return kbb2;
}
Equivalent<any_size> moved(const Vector& flow) {
  Equivalent<any_size> source;
  source.set_admittance(Matrix::Zero(flow.size(), flow.size()), flow);
  return source;
}
/// Applies `effort` to the rest of the network.
Equivalent<any_size> push(const Vector& effort) {
  Equivalent<any_size> source;
  source.set_impedance(Matrix::Zero(effort.size(), effort.size()), -effort);
  return source;
}
Vector one(double x) {
  return Vector::Constant(1, x);
}

// The limit is active all the time; it is where energy could be lost or gained.
TEST(Kbb2, GivesBackWhatItsSpringHeldAtMost) {
  for (const Space space : {Space::lever, Space::tool}) {
    for (const Side root : {Side::left, Side::right}) {
      SCOPED_TRACE(std::string(test::to_text(root)) + ", seed " + std::to_string(seed));
      Rng rng(seed);
      const int size = space == Space::tool ? 6 : 1;
      DrawnSignals drawn(rng, 0);
      DrawnEnds ends(rng, size, 20.0);
      const Kbb2Options options{
          .damping = 5.0, .shunt = 2.0, .force_limit = 5.0, .torque_limit = 0.5};
      Cell cell(fitted(options, space, size), root);
      double lost = 0.0;
      int limited = 0;
      const int ticks = families::draws(1000000) / (space == Space::tool ? 8 : 2);
      for (int tick = 0; tick < ticks; ++tick) {
        const auto behind = tick % 3 == 0 ? ends.slack() : ends.moved(0.5);
        ASSERT_TRUE(
            cell.run(drawn.next(), behind, tick % 2 == 0 ? ends.definite() : ends.moved(0.5)));
        ASSERT_LE(cell.error_behind(behind), 1e-9);
        limited += cell.module.saturated() ? 1 : 0;
        const double lost_now = cell.ledger.energy - cell.module.stored();
        ASSERT_GE(lost_now, lost - 1e-12 * (1.0 + cell.ledger.passed)) << "tick " << tick;
        lost = lost_now;
      }
      EXPECT_GT(limited, ticks / 50);
      EXPECT_LT(limited, ticks * 19 / 20);
      EXPECT_LE(cell.ledger.deficit(), 1e-9);
    }
  }
}

TEST(Kbb2, IsASpringAndADamperBetweenItsSides) {
  const Kbb2Options options{.stiffness = 1000.0,
                            .damping = 40.0,
                            .force_limit = no_limit,
                            .angular_stiffness = 50.0,
                            .angular_damping = 2.0,
                            .torque_limit = no_limit};
  for (const Side root : {Side::left, Side::right}) {
    Cell cell(fitted(options, Space::tool, 6), root);
    const Vector rate = (Vector(6) << 0.1, 0.2, 0.3, 0.4, 0.5, 0.6).finished();
    for (int tick = 1; tick <= 100; ++tick) {
      ASSERT_TRUE(cell.run({}, moved(Vector::Zero(6)), moved(rate)));
      for (int i = 0; i < 6; ++i) {
        const double k = i < 3 ? 1000.0 : 50.0;
        const double b = i < 3 ? 40.0 : 2.0;
        // The middle of the period, by the trapezoidal rule.
        EXPECT_NEAR(cell.at_root.effort(i), (k * period * (tick - 0.5) + b) * rate(i), 1e-9);
      }
      EXPECT_EQ(cell.module.effort(), cell.at_leaf.effort);
    }
  }
}

TEST(Kbb2, StretchesByForceOverStiffness) {
  for (const Side root : {Side::left, Side::right}) {
    Cell cell(fitted({.stiffness = 500.0, .damping = 30.0}, Space::lever, 1), root);
    double stretch = 0.0;
    for (int tick = 0; tick < 2000; ++tick) {
      ASSERT_TRUE(cell.run({}, moved(one(0.0)), push(one(10.0))));
      stretch += period * cell.at_root.flow(0);
    }
    EXPECT_NEAR(stretch, 10.0 / 500.0, 1e-9);
    EXPECT_NEAR(cell.module.stored(), 0.5 * 10.0 * 10.0 / 500.0, 1e-9);
  }
}

// By the bilinear rule w = 2 / T atan(sqrt(K / M) T / 2), at any period.
TEST(Kbb2, SwingsWithAMassAtTheFrequencyOfTheBilinearRule) {
  const double K = 2000.0;
  const double M = 0.5;
  Mass<any_size> mass(M * Matrix::Identity(1, 1));
  mass.prepare(period);
  mass.incident(one(4.0 * M / period));  // initial velocity
  Cell cell(fitted({.stiffness = K, .damping = 0.0, .force_limit = no_limit}, Space::lever, 1),
            Side::right);
  int turns = 0;
  int last_turn = 0;
  double last = 1.0;
  for (int tick = 0; tick < 20000; ++tick) {
    Equivalent<any_size> root;
    root.set_impedance(mass.resistance(), mass.reflected());
    ASSERT_TRUE(cell.run({}, moved(one(0.0)), root));
    const double flow = cell.at_root.flow(0);
    mass.incident(mass.resistance() * cell.at_root.flow - cell.at_root.effort);
    if (flow > 0.0 && last <= 0.0) {
      ++turns;
      last_turn = tick;
    }
    last = flow;
    ASSERT_NEAR(mass.stored() + cell.module.stored(), 0.5 * M * 4.0, 1e-9);
  }
  const double omega = 2.0 / period * std::atan(0.5 * period * std::sqrt(K / M));
  EXPECT_NEAR(2.0 * M_PI * turns / omega, last_turn * period, 0.6 * M_PI / omega);
}

TEST(Kbb2, HeldUpToolWindsNothingUpAndLetsGoAtOnce) {
  const Kbb2Options options{.stiffness = 2000.0, .damping = 0.0, .force_limit = 60.0};
  for (const Side root : {Side::left, Side::right}) {
    Cell brief(fitted(options, Space::lever, 1), root);
    Cell patient(fitted(options, Space::lever, 1), root);
    for (int tick = 0; tick < 100; ++tick)
      ASSERT_TRUE(brief.run({}, moved(one(0.2)), moved(one(0))));
    for (int tick = 0; tick < 10000; ++tick) {
      ASSERT_TRUE(patient.run({}, moved(one(0.2)), moved(one(0))));
      ASSERT_LE(std::abs(patient.at_root.effort(0)), 60.0 + 0.5 * 2000.0 * 0.2 * period + 1e-9);
      ASSERT_LE(patient.module.stored(), 60.0 * 60.0 / (2.0 * 2000.0) + 1e-9);
    }
    EXPECT_TRUE(patient.module.saturated());
    for (int tick = 0; tick < 20; ++tick) {
      ASSERT_TRUE(brief.run({}, moved(one(-0.2)), moved(one(0))));
      ASSERT_TRUE(patient.run({}, moved(one(-0.2)), moved(one(0))));
      EXPECT_NEAR(patient.at_root.effort(0), brief.at_root.effort(0), 1e-9);
      const double expected = 60.0 - 2000.0 * 0.2 * period * (tick + 0.5);
      EXPECT_NEAR(std::abs(patient.at_root.effort(0)), expected, 1e-9);
    }
    EXPECT_FALSE(patient.module.saturated());
  }
}

TEST(Kbb2, LimitKeepsTheDirectionOfTheSpring) {
  const Kbb2Options options{.damping = 0.0, .angular_damping = 0.0};
  Cell cell(fitted(options, Space::tool, 6), Side::right);
  const Vector ahead = (Vector(6) << 0.3, 0.4, 0.0, 0.0, 0.6, 0.8).finished();
  for (int tick = 0; tick < 4000; ++tick) {
    ASSERT_TRUE(cell.run({}, moved(-ahead), moved(Vector::Zero(6))));
  }
  Vector half = 0.5 * period * ahead;  // increment of the last tick before the limit
  half.head<3>() *= options.stiffness;
  half.tail<3>() *= options.angular_stiffness;
  const Vector spring = cell.at_root.effort - half;
  EXPECT_LE((spring.head<3>() - 60.0 * Vec3(0.6, 0.8, 0.0)).norm(), 1e-9);
  EXPECT_LE((spring.tail<3>() - 8.0 * Vec3(0.0, 0.6, 0.8)).norm(), 1e-9);
}

// b = f - Z v as seen by the line; without the shunt all of it is reflected.
TEST(Kbb2, ShuntOfTheLinesImpedanceReflectsNothingWhenTheFarSideIsFree) {
  const Kbb2Options matched{.shunt = 20.0, .angular_shunt = 0.5};
  for (const Side free_side : {Side::left, Side::right}) {
    Kbb2 kbb2 = fitted(matched, Space::tool, 6);
    kbb2.face(free_side == Side::right ? Side::left : Side::right);
    kbb2.prepare(period);
    Equivalent<any_size> shown;
    ASSERT_TRUE(kbb2.reflected(push(Vector::Zero(6)), shown));
    const Vector Z = (Vector(6) << 20, 20, 20, 0.5, 0.5, 0.5).finished();
    if (free_side == Side::right) {
      EXPECT_LE((shown.matrix - Matrix(Z.asDiagonal())).norm(), 1e-12);
    } else {  // the shunt is on the left only
      EXPECT_GT((shown.matrix - Matrix(Z.asDiagonal())).norm(), 1.0);
    }
    EXPECT_EQ(shown.offset.norm(), 0.0);
  }
}

TEST(Kbb2, ForgetsTheSpringAtRest) {
  Cell cell(fitted({}, Space::lever, 1), Side::right);
  for (int tick = 0; tick < 10; ++tick) ASSERT_TRUE(cell.run({}, moved(one(0)), moved(one(0.1))));
  EXPECT_GT(cell.module.stored(), 0.0);
  Signals rest;
  rest.at_rest = true;
  cell.module.read(rest);
  EXPECT_EQ(cell.module.stored(), 0.0);
}

TEST(Kbb2, RefusesNumbersOutOfRange) {
  EXPECT_THROW(Kbb2({.stiffness = 0.0}), SetupError);
  EXPECT_THROW(Kbb2({.damping = -1.0}), SetupError);
  EXPECT_THROW(Kbb2({.shunt = std::nan("")}), SetupError);
  EXPECT_THROW(Kbb2({.force_limit = -1.0}), SetupError);
  EXPECT_THROW(Kbb2({.angular_stiffness = 0.0}), SetupError);
  EXPECT_THROW(Kbb2({.angular_damping = 2e6}), SetupError);
  EXPECT_THROW(Kbb2({.angular_shunt = -1.0}), SetupError);
  EXPECT_THROW(Kbb2({.torque_limit = -1.0}), SetupError);
}

}  // namespace kbb2_test
}  // namespace repel::network
