// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/admittance.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <string>

#include <repel/cell/cell.hpp>

#include "cell/sliders.hpp"

namespace repel {
namespace admittance_test {

/// Three rails that follow rates or positions after a dead time, as a first-order lag.
struct FollowingRails {
  double dead = 0.01;  // [s]
  double lag = 0.02;   // [s]
  bool by_position = false;
  bool is_blocked = false;
  std::array<double, 3> q{}, v{};
  std::deque<std::array<double, 3>> under_way{};
  double most_rate = 0.0, most_acceleration = 0.0;  // commanded

  void step(const JointAdmittance& end, double period) {
    std::array<double, 3> command{};
    std::copy_n((by_position ? end.positions() : end.rates()).begin(), 3, command.begin());
    for (const double rate : end.rates()) most_rate = std::max(most_rate, std::abs(rate));
    under_way.push_back(command);
    const auto late = static_cast<std::size_t>(std::lround(dead / period));
    if (under_way.size() > late + 1) under_way.pop_front();
    const std::array<double, 3> none = by_position ? q : std::array<double, 3>{};
    const std::array<double, 3> wanted = under_way.size() > late ? under_way.front() : none;
    const double share = lag > 0.0 ? 1.0 - std::exp(-period / lag) : 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (is_blocked) {
        v[i] = 0.0;
      } else if (by_position) {
        const double way = share * (wanted[i] - q[i]);
        q[i] += way;
        v[i] = way / period;
      } else {
        v[i] += share * (wanted[i] - v[i]);
        q[i] += period * v[i];
      }
    }
  }
};

struct Trial {
  double rate_hz = 400.0;
  AdmittanceOptions options{.inertia = {5.0, 5.0, 5.0}, .acceleration = 20.0};
  FollowingRails rails{};
  Status seen = 0;
  double deepest_q = -1.0;  // [m] furthest of the ball's centre; the wall begins at 0.2
  double late_speed = 0.0;  // [m/s] greatest in the last quarter
  double peak = 0.0;        // [N]

  [[nodiscard]] double period() const { return 1.0 / rate_hz; }
  [[nodiscard]] CellDescription description() const {
    CellDescription cell = test::sliders();
    cell.rate_hz = rate_hz;
    for (ArmLink& link : cell.arms[0].model.links) link.velocity_limit = 0.3;
    for (ObstacleDescription& wall : cell.obstacles) wall.law.damping_may_rise = true;
    cell.arms[0] = admitted(std::move(cell.arms[0]), options, period());
    return cell;
  }
  /// Pushes to the wall at `speed` [m/s] for six seconds.
  void push(double speed) {
    Cell cell(description());
    JointAdmittance end(cell.description().arms[0].model, options.response, period());
    network::Command hands;
    hands.hand.ball.linear.x() = speed;
    std::chrono::nanoseconds now{0};
    const int ticks = static_cast<int>(6.0 * rate_hz);
    for (int tick = 0; tick < ticks; ++tick) {
      const ArmReadings readings{rails.q, rails.v};
      const TickRecord& record = cell.step(readings, hands, now += cell.period());
      seen |= record.status;
      end.step(readings, record.torques, record.brakes);
      rails.step(end, period());
      deepest_q = std::max(deepest_q, rails.q[0]);
      peak = std::max(peak, record.virtual_force.force.norm());
      if (tick > 3 * ticks / 4) late_speed = std::max(late_speed, std::abs(rails.v[0]));
    }
  }
  [[nodiscard]] std::string said() const {
    return to_text(rate_hz) + " Hz, dead " + to_text(rails.dead) + " s, lag " + to_text(rails.lag) +
           " s, " + (rails.by_position ? "positions" : "rates");
  }
};

TEST(Admittance, BringsAnArmThatTakesRatesOrPositionsToAWallAndNoFurther) {
  for (const double rate_hz : {125.0, 400.0, 1000.0}) {
    for (const bool by_position : {false, true}) {
      for (const auto& [dead, lag] : {std::pair{0.0, 0.0}, {0.01, 0.02}, {0.03, 0.03}}) {
        for (const auto& [mass, told] : {std::pair{0.2, 1.0},
                                         {5.0, 1.0},
                                         {50.0, 1.0},
                                         {0.2, 0.7},
                                         {5.0, 0.7},
                                         {5.0, 1.6},
                                         {50.0, 1.6}}) {
          Trial trial{.rate_hz = rate_hz};
          trial.options.inertia = {mass, mass, mass};
          trial.options.response = told * (dead + lag);
          trial.rails.dead = dead;
          trial.rails.lag = lag;
          trial.rails.by_position = by_position;
          SCOPED_TRACE(trial.said() + ", told " + to_text(told) + " times that, " + to_text(mass) +
                       " kg");
          trial.push(0.1);
          EXPECT_EQ(trial.seen & status::failsafe, 0U) << to_text(trial.seen);
          EXPECT_GT(trial.deepest_q, 0.17) << "the ball must come near the wall";
          EXPECT_LT(trial.deepest_q, 0.2);
          EXPECT_GT(trial.peak, 5.0);
          EXPECT_LT(trial.late_speed, 1e-3) << "it must come to rest";
          EXPECT_LE(trial.rails.most_rate, 0.3);
        }
      }
    }
  }
}

TEST(Admittance, TheStiffestWallOfTheCheckIsHeldAndABitMoreIsRefused) {
  Trial trial;
  CellDescription cell = trial.description();
  ForceLaw& law = cell.obstacles[0].law;
  law.damping_may_rise = false;
  law.damping = 1.001 * (0.5 * trial.period() + 2.0 * trial.options.response) * law.stiffness();
  EXPECT_NO_THROW(Cell(std::move(cell)));
  cell = trial.description();
  cell.obstacles[0].law.damping_may_rise = false;
  cell.obstacles[0].law.damping = 0.5 * trial.options.response * cell.obstacles[0].law.stiffness();
  try {
    Cell refused(std::move(cell));
    FAIL() << "must be refused";
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find("drive delay of 12 ticks"), std::string::npos)
        << error.what();
  }
}

// Its 50 N s/m were taken for a choice, and refused with a number that was refused again.
TEST(Admittance, WallWithTheDefaultLawGetsTheDampingThatItNeeds) {
  for (const double rate_hz : {125.0, 400.0, 500.0, 1000.0, 999.9}) {
    Trial trial{.rate_hz = rate_hz};
    CellDescription description = trial.description();
    description.obstacles[0].law = {};
    const Cell cell(std::move(description));
    const ForceLaw& law = cell.description().obstacles[0].law;
    const double needed = (0.5 * trial.period() + 2.0 * trial.options.response) * law.stiffness();
    EXPECT_NEAR(law.damping, needed, 1e-6 * needed);
    EXPECT_TRUE(cell.warnings().empty()) << cell.warnings().front();
  }
}

TEST(Admittance, AdviceForAWallThatIsTooStiffCanBeFollowedAndNoRateIsAdvisedThatWouldNotDo) {
  Trial trial{.rate_hz = 500.0};
  const auto refusal = [&](double damping) {
    CellDescription description = trial.description();
    description.obstacles[0].law = {
        .range = 0.02, .surface_force = 100.0, .damping = damping, .damping_is_meant = true};
    try {
      const Cell cell(std::move(description));
      return cell.warnings().empty() ? std::string() : cell.warnings().front();
    } catch (const SetupError& error) {
      return std::string(error.what());
    }
  };
  for (const double damping : {5.0, 50.0, 599.0, 605.0}) {
    const std::string said = refusal(damping);
    const std::string words = "this wall needs ";
    ASSERT_NE(said.find(words), std::string::npos) << said;
    const double advised = std::stod(said.substr(said.find(words) + words.size()));
    EXPECT_EQ(advised, 610.0) << said;
    EXPECT_EQ(refusal(advised), "");
    // 60 ms of the response alone need 600 N s/m.
    EXPECT_EQ(said.find("no rate would do") < said.size(), damping < 600.0) << said;
    EXPECT_EQ(said.find("answers within 29.45 ms") < said.size(), damping == 599.0) << said;
    EXPECT_EQ(said.find("a rate of at least 1000 Hz") < said.size(), damping == 605.0) << said;
  }
}

TEST(Admittance, AnArmThatIsBlockedDoesNotJumpWhenItIsFree) {
  for (const bool by_position : {false, true}) {
    Trial trial;
    trial.rails.by_position = by_position;
    Cell cell(trial.description());
    JointAdmittance end(cell.description().arms[0].model, trial.options.response, trial.period());
    network::Command hands;
    hands.hand.ball.linear.x() = 0.1;
    std::chrono::nanoseconds now{0};
    double at = 0.0, fastest = 0.0;
    for (int tick = 0; tick < 1600; ++tick) {
      trial.rails.is_blocked = tick >= 400 && tick < 1000;
      if (tick == 1000) hands.hand.ball.linear.x() = 0.0;
      if (tick == 1000) at = trial.rails.q[0];
      const ArmReadings readings{trial.rails.q, trial.rails.v};
      const TickRecord& record = cell.step(readings, hands, now += cell.period());
      end.step(readings, record.torques, record.brakes);
      trial.rails.step(end, trial.period());
      if (tick > 800 && tick < 1000) {
        // Blocked for a second: what waits in the command is small.
        EXPECT_NEAR(end.positions()[0], trial.rails.q[0], 0.08) << tick;
      }
      if (tick >= 1000) fastest = std::max(fastest, std::abs(trial.rails.v[0]));
    }
    EXPECT_LT(fastest, 0.31) << by_position;
    EXPECT_LT(trial.rails.q[0] - at, 0.1) << "the hand's spring is at its limit, no more";
  }
}

TEST(Admittance, StopsByItselfWithinItsAcceleration) {
  Trial trial;
  const ArmDescription arm = std::move(trial.description().arms[0]);
  JointAdmittance end(arm.model, trial.options.response, trial.period());
  std::array<double, 3> q{}, v{};
  const std::array<double, 3> torques{1e6, -1e6, 0.0};
  end.step({q, v}, torques, false);  // the first tick only takes the pose over
  double last = 0.0;
  for (int tick = 0; tick < 400; ++tick) {
    for (std::size_t i = 0; i < 3; ++i) v[i] = end.rates()[i], q[i] = end.positions()[i];
    end.step({q, v}, torques, tick >= 200);
    EXPECT_LE(std::abs(end.rates()[0]), 0.3);
    if (tick >= 200) {
      EXPECT_GE(end.rates()[0] - last, -20.0 * trial.period() - 1e-12) << tick;
    }
    last = end.rates()[0];
  }
  EXPECT_EQ(end.rates()[0], 0.0);
  EXPECT_EQ(end.rates()[1], 0.0);
}

TEST(Admittance, WhatCannotBeReadIsBrakedAndADriveThatIsOffIsFollowed) {
  Trial trial;
  const ArmDescription arm = std::move(trial.description().arms[0]);
  JointAdmittance end(arm.model, trial.options.response, trial.period());
  std::array<double, 3> q{0.1, 0.0, 0.0}, v{};
  const std::array<double, 3> torques{50.0, 0.0, 0.0};
  for (int tick = 0; tick < 40; ++tick) end.step({q, v}, torques, false);
  EXPECT_GT(end.rates()[0], 0.01);
  const std::array<double, 3> unreadable{std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0};
  for (int tick = 0; tick < 40; ++tick) end.step({unreadable, v}, torques, false);
  EXPECT_EQ(end.rates()[0], 0.0);
  EXPECT_TRUE(std::isfinite(end.positions()[0]));
  end.step({q, v, ArmState::stopped}, torques, false);
  EXPECT_EQ(end.positions()[0], 0.1);
  EXPECT_EQ(end.rates()[0], 0.0);
}

TEST(Admittance, SendsNothingThatLeadsOutOfTheRangeOfAJoint) {
  Trial trial;
  ArmDescription arm = std::move(trial.description().arms[0]);
  arm.model.links[0].lower = -0.05;
  arm.model.links[0].upper = 0.05;
  JointAdmittance end(arm.model, trial.options.response, trial.period());
  std::array<double, 3> q{}, v{};
  const std::array<double, 3> torques{100.0, 0.0, 0.0};
  for (int tick = 0; tick < 800; ++tick) {
    end.step({q, v}, torques, false);
    for (std::size_t i = 0; i < 3; ++i) v[i] = end.rates()[i], q[i] = end.positions()[i];
  }
  EXPECT_EQ(q[0], 0.05);
  EXPECT_EQ(end.rates()[0], 0.0);
}

TEST(Admittance, AForceSensorIsRefused) {
  Trial trial;
  CellDescription cell = trial.description();
  cell.arms[0].network = test::plan_with({network::Obstacle()}, {network::ForceSensor()});
  try {
    Cell refused(std::move(cell));
    FAIL() << "must be refused";
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find("force_sensor"), std::string::npos) << error.what();
  }
}

TEST(Admittance, RefusesWhatNoArmCanShow) {
  const auto refusal = [](const AdmittanceOptions& options) {
    CellDescription cell = test::sliders();
    try {
      (void)admitted(std::move(cell.arms[0]), options, 0.0025);
      return std::string();
    } catch (const SetupError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(refusal({.inertia = {1.0, 1.0, 1.0}}), "");
  EXPECT_NE(refusal({.inertia = {1.0}}).find("for each joint"), std::string::npos);
  EXPECT_NE(refusal({.inertia = {1.0, -1.0, 1.0}}).find("admittance inertia"), std::string::npos);
  EXPECT_NE(refusal({.inertia = {1.0, 1.0, 1.0}, .response = 0.3}).find("response"),
            std::string::npos);
  EXPECT_NE(refusal({.inertia = {1.0, 1.0, 1.0}, .rest_time = 0.0}).find("rest time"),
            std::string::npos);
}

}  // namespace admittance_test
}  // namespace repel
