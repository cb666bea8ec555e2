// SPDX-License-Identifier: BSD-3-Clause
// Virtual fixtures in the whole loop: on three rails, at several rates, masses and delays.
#include <gtest/gtest.h>

#include <cmath>

#include <repel/simulated/delayed_arm.hpp>

#include "loop/slider.hpp"

namespace repel {
namespace guided_motion_test {

using namespace network;

/// Three rails with a guide and a force ball.
struct Guided {
  Guided(const Script& script, const GuideOptions& guide, double rate, int delay, double mass,
         const Kbb2Options& coupling = {.stiffness = automatic, .damping = automatic})
      : hands(script), T(1.0 / rate), cell(described(guide, rate, delay, coupling)) {
    auto owned = std::make_unique<test::SliderArm>();
    owned->mass = mass;
    owned->friction = 2.0;
    rails = owned.get();
    arm = std::make_unique<DelayedArm>(std::move(owned), 3, delay);
    port.emplace(*arm, 3);
  }

  const TickRecord& tick() {
    now += std::chrono::nanoseconds(std::lround(1e9 * T));
    const TickRecord& record =
        cell.step(port->read(), hands.step(cell.X_WT(0).linear(), cell.elapsed()), now);
    port->apply(record);
    arm->step(T);
    return record;
  }
  const TickRecord& run(double seconds) {
    for (int i = 1; i < std::lround(seconds / T); ++i) (void)tick();
    return tick();
  }
  [[nodiscard]] Vec3 p() const { return {rails->q[0], rails->q[1], rails->q[2]}; }
  [[nodiscard]] Vec3 v() const { return {rails->v[0], rails->v[1], rails->v[2]}; }
  [[nodiscard]] const Guide& guide() const { return *cell.network(0).find<Guide>(); }

  static CellDescription described(const GuideOptions& guide, double rate, int delay,
                                   const Kbb2Options& coupling) {
    CellDescription description;
    description.rate_hz = rate;
    ArmDescription& arm = description.arms.emplace_back();
    arm.model = test::slider_model(1000.0);
    arm.options.drive_delay = delay;
    arm.kinematics = std::make_unique<test::SliderKinematics>();
    arm.parts.push_back({"ball", Shape::sphere(0.05)});
    arm.network = Plan()
                      .add("torque_arm", TorqueArm())
                      .add("multiplex", Multiplex())
                      .add("spaceball", Spaceball())
                      .add("relief", Relief())
                      .add("kbb2", Kbb2(coupling))
                      .add("obstacle", Obstacle())
                      .add("guide", Guide(guide))
                      .add("puma_kin", PumaKin())
                      .add("puma_joints", PumaJoints(3));
    return description;
  }

  ScriptedOperator hands;
  double T;
  Cell cell;
  test::SliderArm* rails = nullptr;
  std::unique_ptr<TorqueDrivenArm> arm;
  std::optional<ArmPort> port;
  std::chrono::nanoseconds now{0};
};

FixtureOptions of_kind(FixtureKind kind) {
  FixtureOptions fixture{.name = "fixture", .kind = kind};
  fixture.X_WF.translation() = Vec3(0.02, -0.015, 0.01);
  fixture.points = {{-0.2, 0, 0}, {0, 0.02, 0}, {0.1, 0.02, 0.03}, {0.3, -0.05, 0}};
  fixture.half_angle = 0.6;
  fixture.X_WF.linear() = Eigen::AngleAxisd(0.8, Vec3(1, 2, 0).normalized()).toRotationMatrix();
  return fixture;
}

// The hand pushes the tool off, and lets go. Soft fixtures, and ones as hard as the arm allows.
TEST(GuidedMotion, ComesToRestAtEveryRateMassAndDelay) {
  int runs = 0;
  for (const FixtureKind kind : {FixtureKind::point, FixtureKind::line, FixtureKind::plane,
                                 FixtureKind::path, FixtureKind::cone}) {
    for (const double stiffness : {1000.0, automatic}) {
      for (const double rate : {125.0, 400.0, 1000.0}) {
        for (const int delay : {0, 3}) {
          for (const double mass : {0.3 * 5.0, 1.7 * 5.0}) {
            if ((runs++ % 3) != 0 && kind != FixtureKind::path) continue;
            SCOPED_TRACE("kind " + std::to_string(static_cast<int>(kind)) + ", " +
                         std::to_string(stiffness) + " N/m, " + std::to_string(rate) + " Hz, " +
                         std::to_string(delay) + " ticks, " + std::to_string(mass) + " kg");
            GuideOptions options{.fixtures = {of_kind(kind)}};
            options.fixtures[0].stiffness = stiffness;
            Phase push;
            push.duration = 1.0;
            push.rates.linear = Vec3(0.02, 0.03, -0.02);
            Guided guided({push}, options, rate, delay, mass);
            Status status = 0;
            double most = 0.0;
            for (int tick = 0; tick < 8.0 * rate; ++tick) {
              status |= guided.tick().status;
              most = std::max(most, norm(guided.v()));
            }
            EXPECT_LT(norm(guided.v()), 1e-4);
            EXPECT_LT(most, 0.5);
            EXPECT_EQ(status & (status::failsafe | status::energy_gain), 0U) << to_text(status);
            const Node* node = guided.cell.network(0).node_of<Guide>();
            EXPECT_LE(node->ledger.deficit(), 1e-9);
            EXPECT_GT(guided.guide().fixtures()[0].most_force, 0.2);
          }
        }
      }
    }
  }
}

// With the tool held by nothing but a coupling to a hand at rest.
TEST(GuidedMotion, HoldsTheToolOnTheLineWhileTheHandStrays) {
  Phase stray;
  stray.duration = 2.0;
  stray.rates.linear = Vec3(0.0, 0.006, 0.03);
  FixtureOptions line{.name = "line", .kind = FixtureKind::line, .stiffness = automatic};
  const Kbb2Options soft;
  Guided guided({stray}, {.fixtures = {line}}, 400.0, 0, 5.0, soft);
  Guided alone({stray}, {}, 400.0, 0, 5.0, soft);
  (void)guided.run(2.0);
  (void)alone.run(2.0);
  EXPECT_GT(alone.p().y(), 0.01);
  EXPECT_LT(std::abs(guided.p().y()), 0.1 * alone.p().y());
  EXPECT_NEAR(guided.p().z(), alone.p().z(), 0.002) << "free along it";
}

TEST(GuidedMotion, LetsGoWhereTheOperatorsForceIsRemoved) {
  Phase ball;
  ball.duration = 1.0;
  Phase broken = ball;
  broken.duration = 2.0;
  broken.rates.linear.x() = std::nan("");
  FixtureOptions point{.name = "point"};
  point.X_WF.translation() = Vec3(0, 0.02, 0);
  Guided guided({ball, broken}, {.fixtures = {point}}, 400.0, 0, 5.0);
  (void)guided.run(0.9);
  EXPECT_GT(guided.guide().fixtures()[0].gain, 0.99);
  (void)guided.run(1.5);
  EXPECT_EQ(guided.guide().fixtures()[0].gain, 0.0);
  EXPECT_EQ(norm(guided.guide().on_tool().force), 0.0);
}

TEST(GuidedMotion, IsSwitchedByThePhasesOfAScript) {
  Phase off;
  off.duration = 1.0;
  off.guides = 0;
  Phase on = off;
  on.guides = 2;
  Phase half = off;
  half.guides = as_before;
  half.guide_strength = 0.5;
  FixtureOptions line{.name = "line", .kind = FixtureKind::line};
  FixtureOptions point{.name = "point"};
  point.X_WF.translation() = Vec3(0.01, 0, 0);
  Guided guided({off, on, half}, {.fixtures = {line, point}}, 400.0, 0, 5.0);
  (void)guided.run(0.9);
  EXPECT_EQ(guided.guide().fixtures()[0].gain, 0.0);
  EXPECT_EQ(guided.guide().fixtures()[1].gain, 0.0);
  (void)guided.run(1.0);
  EXPECT_EQ(guided.guide().fixtures()[0].gain, 0.0);
  EXPECT_EQ(guided.guide().fixtures()[1].gain, 1.0);
  (void)guided.run(1.0);
  EXPECT_NEAR(guided.guide().fixtures()[1].gain, 0.5, 1e-12);
}

}  // namespace guided_motion_test
}  // namespace repel
