// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/guide.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>

#include "network/drawn.hpp"

namespace repel::network {
namespace guide_test {

using test::period;

constexpr unsigned seed = 67;

std::vector<FixtureOptions> some_fixtures() {
  FixtureOptions line{.name = "line", .kind = FixtureKind::line, .alignment = Alignment::axis};
  line.X_WF.translation() = Vec3(0.02, 0.01, 0.0);
  FixtureOptions seam{.name = "seam", .kind = FixtureKind::path};
  seam.points = {{-0.1, 0, 0}, {0, 0.03, 0}, {0.1, 0, 0.02}, {0.1, 0.08, 0.02}, {0, 0.08, 0}};
  seam.frames.assign(5, Mat3::Identity());
  seam.frames[2] = Eigen::AngleAxisd(0.4, Vec3::UnitX()).toRotationMatrix();
  seam.alignment = Alignment::all;
  FixtureOptions cone{.name = "cone", .kind = FixtureKind::cone, .is_on = false};
  FixtureOptions ball{.name = "ball", .radius = 0.03, .stiffness = 3000.0, .is_on = false};
  FixtureOptions plane{.name = "plane", .kind = FixtureKind::plane, .is_on = false};
  return {line, seam, cone, ball, plane};
}

/// A tool in free space whose joints are its motion; moved, or pushed as a mass.
struct Tool {
  explicit Tool(const GuideOptions& options, double T = period) : guide(options) {
    guide.prepare(T);
    signals.joints = signals.rates = signals.mean_rates = Vec<any_size>::Zero(6);
    signals.jacobian = Jacobian::Identity(6, 6);
    signals.period = T;
  }
  /// Moves by a twist for a tick; returns the work of the guide on the tool [J] by the ports of the
  /// network.
  double move(const Twist& V) {
    const double T = signals.period;
    signals.rates = signals.mean_rates = to_vec(V);
    guide.read(signals);
    const double work = T * power(guide.on_tool(), V);
    ledger += T * guide.supplied() - work;
    least = std::min(least, ledger);
    supplied += T * guide.supplied();
    signals.X_WT.translation() += T * V.linear;
    const double angle = T * norm(V.angular);
    if (angle > 0.0) {
      signals.X_WT.linear() =
          Eigen::AngleAxisd(angle, V.angular.normalized()) * signals.X_WT.linear();
    }
    return work;
  }
  /// One tick of a mass of 2 kg and 0.01 kg m^2 on which `F` acts, with some friction.
  void push(const Wrench& F) {
    const Wrench sum = F + guide.on_tool();
    velocity.linear = 0.999 * (velocity.linear + signals.period / 2.0 * sum.force);
    velocity.angular = 0.999 * (velocity.angular + signals.period / 0.01 * sum.torque);
    (void)move(velocity);
  }
  void wait(int ticks) {
    for (int tick = 0; tick < ticks; ++tick) (void)move({});
  }

  Guide guide;
  Signals signals;
  Twist velocity{};
  double ledger = 0.0, least = 0.0, supplied = 0.0;
};

TEST(Guide, ComesWithoutAJumpAndPullsOnToTheFixture) {
  Tool tool({.fixtures = {{.name = "point"}}});
  tool.signals.X_WT.translation() = Vec3(0.03, -0.01, 0.02);
  double last = 0.0, most_change = 0.0;
  for (int tick = 0; tick < 2000; ++tick) {
    tool.push({});
    const double force = norm(tool.guide.on_tool().force);
    most_change = std::max(most_change, std::abs(force - last));
    last = force;
  }
  EXPECT_LE(norm(origin(tool.signals.X_WT)), 1e-4);
  EXPECT_LE(most_change, 30.0 * period / 0.25 + 1000.0 * 1e-3 * 0.3);
  EXPECT_EQ(tool.guide.fixtures()[0].gain, 1.0);
  EXPECT_GT(tool.supplied, 0.1) << "someone has to pay for the way in";
  EXPECT_LE(tool.supplied, 1.0);
  EXPECT_GE(tool.least, 0.0);
}

// With the module's own energy gone, a fixture comes as far as motion has paid for it.
TEST(Guide, WithNextToNoEntryEnergyWaitsForTheTool) {
  Tool tool({.fixtures = {{.name = "point"}}, .entry_energy = 1e-3});
  tool.signals.X_WT.translation() = Vec3(0.03, 0, 0);
  tool.wait(1000);
  EXPECT_LT(tool.guide.fixtures()[0].gain, 0.01);
  for (int tick = 0; tick < 400; ++tick)
    (void)tool.move({{-tool.signals.X_WT.translation().x() / 0.1, 0, 0}, {0, 0, 0}});
  tool.wait(200);
  EXPECT_EQ(tool.guide.fixtures()[0].gain, 1.0) << "at the fixture it costs nothing";
  EXPECT_LE(tool.supplied, 1e-3 * (1.0 + 1600 * period / EntryEnergy::refill));
  EXPECT_GE(tool.least, -1e-9);
}

// Round and round, through the fixtures and out of them: what is gained is at most rounding.
TEST(Guide, ClosedPathsGainNothing) {
  for (const bool turns : {false, true}) {
    GuideOptions options{.fixtures = some_fixtures()};
    for (FixtureOptions& fixture : options.fixtures) {
      fixture.damping = 0.5 * 3000.0 * period;
      fixture.angular_damping = 0.5 * 20.0 * period;
      fixture.is_on = true;
    }
    Tool tool(options);
    tool.wait(400);
    double passed = 0.0;
    for (int loop = 0; loop < 12; ++loop) {
      double gained = 0.0;
      constexpr int ticks = 4000;
      const double w = 2.0 * M_PI / (ticks * period);
      for (int tick = 0; tick < ticks; ++tick) {
        const double t = (tick + 0.5) * period;
        Twist V;
        V.linear =
            w * Vec3(0.08 * std::sin(w * t), 0.05 * std::sin(2.0 * w * t), 0.03 * std::cos(w * t));
        if (turns) V.angular.x() = 0.5 * w * std::sin(w * t);
        const double work = tool.move(V);
        gained += work;
        passed += std::abs(work);
      }
      if (loop < 2) continue;  // the gains are up
      EXPECT_LE(gained, 1e-6 * passed) << "loop " << loop;
      EXPECT_GE(gained, -0.2 * passed) << "and it does not drag";
    }
    for (const Guide::Held& held : tool.guide.fixtures()) EXPECT_EQ(held.gain, 1.0);
    EXPECT_GT(passed, 1.0);
    EXPECT_GE(tool.least, -1e-9);
  }
}

// The hand pushes at random, in and out; fixtures and strength are switched at random.
TEST(Guide, SwitchedAtRandomKeepsItsLedgerItsLimitsAndItsRateOfChange) {
  Rng rng(seed);
  const GuideOptions options{.fixtures = some_fixtures()};
  Tool tool(options);
  Wrench hand;
  Vec3 last(0, 0, 0);
  Vec3 last_v(0, 0, 0);
  double last_dissipated = 0.0, most_part = 0.0, highest = 0.0;
  int checked = 0, switched_on = 0;
  std::vector<bool> acted(options.fixtures.size(), false);
  for (int tick = 0; tick < families::draws(400000); ++tick) {
    if (tick % 100 == 0) {
      hand.force = families::uniform(rng, 0.0, 25.0) * families::direction(rng) -
                   Vec3(60.0 * origin(tool.signals.X_WT));
      hand.torque = families::uniform(rng, 0.0, 0.1) * families::direction(rng);
    }
    if (tick % 300 == 0) {
      tool.signals.hand.guides = families::count_between(rng, -1, 31);
      tool.signals.hand.guide_strength = families::uniform(rng, -0.2, 1.2);
    }
    tool.push(
        {hand.force - 8.0 * tool.velocity.linear, hand.torque - 0.02 * tool.velocity.angular});
    const Vec3 force = tool.guide.on_tool().force;
    double stiffness = 0.0, ramps = 0.0, damping = 0.0, limits = 0.0;
    for (std::size_t i = 0; i < acted.size(); ++i) {
      const Guide::Held& held = tool.guide.fixtures()[i];
      const bool acted_before = acted[i];
      acted[i] = held.acts();
      if (!acted[i] && !acted_before) continue;
      ++switched_on;
      stiffness += held.along.stiffness();
      ramps += held.along.peak();
      damping += held.damping;
      limits += held.options.most_force;
      ASSERT_LE(held.most_force, held.options.most_force * (1.0 + 1e-9));
      highest = std::max(highest, held.most_force);
    }
    // Where the passivity controller does not act: springs, gains and dampers.
    const bool alone = tool.guide.passivity().dissipated == last_dissipated;
    const double speed = norm(tool.velocity.linear),
                 motion = period * std::max(speed, norm(last_v));
    const double bound =
        stiffness * (1.0 + FixtureGeometry::most_ahead) * motion + ramps * period / 0.25 +
        damping * (norm(Vec3(tool.velocity.linear - last_v)) + 0.2 * std::max(speed, norm(last_v)));
    if (alone) {
      ASSERT_LE(norm(Vec3(force - last)), bound + 1e-9) << tick << ", seed " << seed;
      ASSERT_LE(norm(force), limits + 1e-9);
      most_part = std::max(most_part, norm(Vec3(force - last)) / (bound + 1e-9));
      ++checked;
    }
    ASSERT_GE(tool.ledger, -1e-9) << tick << ", seed " << seed;
    ASSERT_LE(tool.guide.stored(), 20.0);
    last = force;
    last_v = tool.velocity.linear;
    last_dissipated = tool.guide.passivity().dissipated;
  }
  EXPECT_GT(checked, families::draws(400000) / 4);
  EXPECT_GT(switched_on, families::draws(400000) / 2);
  EXPECT_GT(most_part, 0.3) << "the bound means something";
  EXPECT_GT(highest, 29.0);
}

TEST(Guide, AddsItsForceOnTheSameFlowWithALedgerAboveZero) {
  for (const Side root : {Side::left, Side::right}) {
    Rng rng(seed);
    DrawnSignals drawn(rng, 6);
    DrawnEnds ends(rng, 6, 20.0);
    Cell cell(Guide({.fixtures = some_fixtures()}), root);
    for (int tick = 0; tick < families::draws(100000); ++tick) {
      const Signals& signals = drawn.next();
      Equivalent<any_size> measured;
      measured.set_admittance(test::Matrix::Zero(6, 6), signals.tool_flow());
      const auto behind = tick % 2 == 0 ? ends.slack() : ends.definite();
      ASSERT_TRUE(cell.run(signals, behind, measured));
      ASSERT_EQ(cell.at_root.flow, cell.at_leaf.flow);
      const test::Vector added = cell.at_leaf.effort - cell.at_root.effort;
      ASSERT_LE((added - to_vec(cell.module.on_tool())).norm(),
                1e-12 * (1.0 + cell.at_leaf.effort.norm()));
    }
    EXPECT_GT(cell.ledger.passed, 1.0);
    EXPECT_LE(cell.ledger.deficit(), 1e-9) << test::to_text(root) << ", seed " << seed;
  }
}

TEST(Guide, LetsGoAtRestAndForgetsWhereNothingIsTrusted) {
  Tool tool({.fixtures = {{.name = "point"}}});
  tool.signals.X_WT.translation() = Vec3(0.02, 0, 0);
  tool.wait(400);
  EXPECT_NEAR(norm(tool.guide.on_tool().force), 19.2, 1.0);
  tool.signals.at_rest = true;
  tool.wait(50);
  EXPECT_NEAR(tool.guide.fixtures()[0].gain, 0.5, 0.02);
  tool.wait(60);
  EXPECT_EQ(norm(tool.guide.on_tool().force), 0.0);
  tool.signals.at_rest = false;
  tool.wait(400);
  EXPECT_GT(norm(tool.guide.on_tool().force), 15.0);
  EXPECT_NEAR(tool.supplied, 0.19, 0.03) << "what was let go pays for coming again";
  tool.signals.released = true;
  tool.wait(1);
  EXPECT_EQ(norm(tool.guide.on_tool().force), 0.0);
  EXPECT_EQ(tool.guide.stored(), 0.0);
}

// The branches of a bent path: outside of its range the tool goes from one to the other.
TEST(Guide, MeetsAPathAgainElsewhere) {
  FixtureOptions path{.name = "bend", .kind = FixtureKind::path, .range = 0.02};
  path.points = {{0, 0, 0}, {0.3, 0, 0}, {0.3, 0.1, 0}, {0, 0.1, 0}};
  path.course = Course::straight;
  Tool tool({.fixtures = {path}});
  tool.signals.X_WT.translation() = Vec3(0.1, 0.005, 0);
  tool.wait(400);
  EXPECT_LT(tool.guide.on_tool().force.y(), -1.0);
  double last = 0.0, most = 0.0;
  for (int tick = 0; tick < 900; ++tick) {
    (void)tool.move({{0, 0.04, 0}, {0, 0, 0}});
    const double force = tool.guide.on_tool().force.y();
    if (tick > 0) most = std::max(most, std::abs(force - last));
    last = force;
  }
  EXPECT_GT(tool.guide.on_tool().force.y(), 1.0) << "towards the other branch";
  EXPECT_LE(most, 3.0);
  EXPECT_GE(tool.least, -1e-9);
}

TEST(Guide, DampsAsMuchAsItsSpringNeeds) {
  FixtureOptions point{.name = "point", .stiffness = 4000.0, .damping = 10.0};
  Guide guide({.fixtures = {point}});
  guide.suit({.wall_ticks = 2.5});
  EXPECT_THROW(guide.prepare(period), SetupError);  // needs 25 N s/m
  point.damping = 25.0;
  Guide enough({.fixtures = {point}});
  enough.suit({.wall_ticks = 2.5});
  EXPECT_NO_THROW(enough.prepare(period));
  point.damping = automatic;
  Guide chosen({.fixtures = {point}});
  chosen.suit({.mass = 1.0, .response = 1.5 * period, .wall_ticks = 2.5});
  chosen.prepare(period);
  EXPECT_NEAR(chosen.fixtures()[0].damping, 2.0 * std::sqrt(4000.0), 1e-9);
  point.stiffness = automatic;
  Guide hard({.fixtures = {point}});
  hard.suit({.mass = 1.0, .response = 1.5 * period, .wall_ticks = 0.5});
  hard.prepare(period);
  EXPECT_NEAR(hard.fixtures()[0].along.stiffness(), 0.25 / (1.5 * 1.5 * period * period), 1.0);
  EXPECT_GE(hard.fixtures()[0].damping, 0.5 * period * hard.fixtures()[0].along.stiffness());
}

TEST(Guide, TellsItsDampingToWhoeverPredicts) {
  FixtureOptions line{.name = "line", .kind = FixtureKind::line, .damping = 40.0};
  Tool tool({.fixtures = {line}});
  tool.wait(400);
  Mat<any_size> damping = Mat<any_size>::Zero(6, 6);
  tool.guide.add_wall_damping(tool.signals.jacobian, damping);
  EXPECT_NEAR(damping(0, 0), 40.0, 1e-12);
  EXPECT_NEAR(damping(1, 1), 40.0, 1e-12);
  EXPECT_NEAR(damping(2, 2), 0.0, 1e-12) << "free along the line";
  EXPECT_NEAR(damping(3, 3), 0.0, 1e-12);
  (void)tool.move({{0.1, 0, 0.3}, {0, 0, 0}});
  EXPECT_NEAR(tool.guide.on_tool().force.x(), -4.0, 1e-9);
  EXPECT_NEAR(tool.guide.on_tool().force.z(), 0.0, 1e-12);
}

TEST(Guide, RefusesNumbersOutOfRange) {
  EXPECT_THROW(Guide({.ramp = 0.0}), SetupError);
  EXPECT_THROW(Guide({.entry_energy = 0.0}), SetupError);
  EXPECT_THROW(Guide({.passivity = {.most_energy = -1.0}}), SetupError);
  EXPECT_THROW(Guide({.fixtures = std::vector<FixtureOptions>(31)}), SetupError);
  EXPECT_THROW(Guide({.fixtures = {{.radius = -1.0}}}), SetupError);
}

}  // namespace guide_test
}  // namespace repel::network
