// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/force_sensor.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include <repel/base/setup_error.hpp>
#include <repel/network/modules.hpp>
#include <repel/network/plan.hpp>

#include "network/drawn.hpp"

namespace repel::network {
namespace force_sensor_test {

constexpr double T = 0.0025;  // [s]
constexpr unsigned seed = 71;
const ForceSensorOptions unfiltered{.cutoff = 0.0};

ForceSensor ready(const ForceSensorOptions& options = unfiltered, int joints = 6) {
  ForceSensor sensor(options);
  sensor.fit(Space::joints, joints);
  sensor.prepare(T);
  return sensor;
}
Signals signals_with(const Wrench& F, int joints = 6) {
  Signals signals = detail::neutral_signals(joints, T);
  signals.measured = F;
  signals.is_measured = true;
  return signals;
}
/// Reads for `seconds`.
void feed(ForceSensor& sensor, const Signals& signals, double seconds) {
  for (int tick = 0; tick < std::lround(seconds / T); ++tick) sensor.read(signals);
}
/// Torques to the robot for `left`, those from the left [N m].
Vec<any_size> to_robot(ForceSensor& sensor, const Vec<any_size>& left) {
  Equivalent<any_size> behind, shown;
  behind.set_impedance(Mat<any_size>::Zero(left.size(), left.size()), -left);
  EXPECT_TRUE(sensor.reflected(behind, shown));
  return -shown.offset;
}

TEST(ForceSensor, AddsItsShareOfWhatIsLeftOverByTheContact) {
  ForceSensor sensor = ready();
  const Signals signals = signals_with({{10, 20, 30}, {1, 2, 3}});
  feed(sensor, signals, 1.0);
  EXPECT_EQ(sensor.gain(), 0.5);
  Vec<any_size> left(6);
  left << 1.0, -2.0, 3.0, -4.0, 5.0, -6.0;
  const Vec<any_size> torque =
      signals.jacobian.transpose() * to_vec(signals.measured);  // of the contact
  EXPECT_LT((to_robot(sensor, left) - (1.5 * left + 0.5 * torque)).norm(), 1e-12);
  // A contact that carries what comes from the left leaves nothing to add.
  EXPECT_LT((to_robot(sensor, -torque) + torque).norm(), 1e-12);
}

TEST(ForceSensor, BalancesItsLedgerWithWhatItSupplies) {
  for (const Side root : {Side::left, Side::right}) {
    SCOPED_TRACE(std::string(test::to_text(root)) + ", seed " + std::to_string(seed));
    test::Rng rng(seed);
    test::DrawnSignals drawn(rng, 6);
    test::DrawnEnds ends(rng, 6, 20.0);
    ForceSensor fitted;
    fitted.fit(Space::joints, 6);
    test::Cell cell(fitted, root);
    for (int tick = 0; tick < families::draws(1000000) / 2; ++tick) {
      // A flow source behind it would leave the robot no flow of its own.
      const auto behind = tick % 3 == 0 ? ends.slack() : ends.definite();
      ASSERT_TRUE(cell.run(drawn.next(), behind, ends.moved(0.5)));
      ASSERT_EQ(cell.at_root.flow, cell.at_leaf.flow);
      ASSERT_LE(cell.error_behind(behind), 1e-9);
    }
    EXPECT_GT(std::abs(cell.ledger.supplied), 1e-3 * cell.ledger.passed);
    EXPECT_LE(std::abs(cell.ledger.energy), 1e-9 * cell.ledger.passed);
    EXPECT_LE(cell.ledger.deficit(), 1e-9);
  }
}

TEST(ForceSensor, ShowsAnAdmittanceAsWell) {
  test::Rng rng(seed);
  test::DrawnEnds ends(rng, 6, 20.0);
  ForceSensor sensor = ready();
  feed(sensor, signals_with({{10, 20, 30}, {1, 2, 3}}), 1.0);
  for (int i = 0; i < 100; ++i) {
    Equivalent<any_size> behind = ends.definite();
    Equivalent<any_size> by_flow, by_effort;
    ASSERT_TRUE(sensor.reflected(behind, by_flow));
    ASSERT_TRUE(behind.take_form(Form::admittance));
    ASSERT_TRUE(sensor.reflected(behind, by_effort));
    ASSERT_EQ(by_effort.form, Form::admittance);
    ASSERT_TRUE(by_effort.take_form(Form::impedance));
    EXPECT_LT((by_flow.matrix - by_effort.matrix).norm(), 1e-8 * by_flow.matrix.norm());
    EXPECT_LT((by_flow.offset - by_effort.offset).norm(), 1e-8 * (1.0 + by_flow.offset.norm()));
  }
}

TEST(ForceSensor, ReadsInTheAxesOfTheToolAndWeighsIt) {
  test::Rng rng(seed);
  for (int i = 0; i < 20; ++i) {
    const Wrench F{{10, 20, 30}, {1, 2, 3}};  // world axes
    const Pose X_WT = families::random_pose(rng, 0.0, 1.0);
    const Mat3 R_TW = X_WT.linear().transpose();
    const Vec3 p_TC(0.1, -0.2, 0.3);
    ForceSensor sensor = ready({.cutoff = 0.0, .mass = 2.0, .p_TC = p_TC});
    Signals signals =
        signals_with(rotated(R_TW, F) + wrench_of_force(R_TW * Vec3(0, 0, -2.0 * 9.81), p_TC));
    signals.X_WT = X_WT;
    feed(sensor, signals, 0.1);
    EXPECT_LT((sensor.force().force - F.force).norm(), 1e-12) << "seed " << seed;
    EXPECT_LT((sensor.force().torque - F.torque).norm(), 1e-12) << "seed " << seed;
  }
}

TEST(ForceSensor, LowPassReachesAStepInItsTimeConstant) {
  ForceSensor sensor = ready({.cutoff = 2.0});
  feed(sensor, signals_with(Wrench()), 1.0);
  const double time = 1.0 / (2.0 * std::numbers::pi * 2.0);
  feed(sensor, signals_with({{10, 0, 0}, {0, 0, 0}}), time);
  EXPECT_NEAR(sensor.force().force.x(), 10.0 * (1.0 - std::exp(-1.0)), 0.1);
}

TEST(ForceSensor, TakesTheMeanReadingAtRestAsItsBias) {
  ForceSensor sensor = ready({.cutoff = 0.0, .tare = 0.2});
  Signals signals = signals_with({{1, 2, 3}, {0.1, 0.2, 0.3}});
  signals.mean_rates(0) = 0.02;  // moves: nothing is learnt
  feed(sensor, signals, 1.0);
  EXPECT_FALSE(sensor.is_tared());
  EXPECT_EQ(sensor.gain(), 0.0);
  signals.mean_rates(0) = 0.0;
  feed(sensor, signals, 0.1);
  signals.measured.force.x() = 3.0;
  feed(sensor, signals, 0.1 + T);
  EXPECT_TRUE(sensor.is_tared());
  EXPECT_NEAR(sensor.bias().force.x(), 2.0, 0.05);
  EXPECT_NEAR(sensor.bias().torque.z(), 0.3, 1e-12);
  signals.measured.force.x() = sensor.bias().force.x() + 5.0;
  feed(sensor, signals, 1.0);
  EXPECT_NEAR(sensor.force().force.x(), 5.0, 1e-12);
  EXPECT_EQ(sensor.gain(), 0.5);
}

TEST(ForceSensor, ReadingBeyondTheRangeIsClippedAndCounted) {
  ForceSensor sensor = ready({.cutoff = 0.0, .force_range = 50.0, .torque_range = 5.0});
  feed(sensor, signals_with({{49, 0, 0}, {0, 4.9, 0}}), 1.0);
  EXPECT_FALSE(sensor.saturated());
  feed(sensor, signals_with({{70, -60, 10}, {0, 0, 0}}), 10 * T);
  EXPECT_TRUE(sensor.saturated());
  EXPECT_FALSE(sensor.is_lost());
  EXPECT_EQ(sensor.saturated_ticks(), 10);
  EXPECT_EQ(sensor.force().force, Vec3(50, -50, 10));
  EXPECT_NEAR(sensor.peak_force(), Vec3(50, 50, 10).norm(), 1e-12);
}

TEST(ForceSensor, FadesOutWithoutAJumpWhereItCannotBeBelieved) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Signals silent = signals_with(Wrench());
  silent.is_measured = false;
  const Signals bad[] = {silent, signals_with({{0, nan, 0}, {0, 0, 0}}),
                         signals_with({{2001, 0, 0}, {0, 0, 0}}),
                         signals_with({{0, 0, 0}, {0, -1e308, 0}})};
  const Signals sound = signals_with({{20, 0, 0}, {0, 0, 0}});
  const Vec<any_size> left = Vec<any_size>::Constant(6, 30.0);
  for (const Signals& failed : bad) {
    ForceSensor sensor = ready();
    feed(sensor, sound, 1.0);
    Vec<any_size> last = to_robot(sensor, left);
    const auto follow = [&](const Signals& signals, double seconds, double slope) {
      for (int tick = 0; tick < std::lround(seconds / T); ++tick) {
        sensor.read(signals);
        const Vec<any_size> next = to_robot(sensor, left);
        ASSERT_LE((next - last).lpNorm<Eigen::Infinity>(), 0.5 * 50.0 * T / slope + 1e-9);
        last = next;
      }
    };
    follow(failed, 0.05, ForceSensor::fall);
    EXPECT_TRUE(sensor.is_lost());
    EXPECT_EQ(sensor.gain(), 0.0);
    EXPECT_LT((last - left).norm(), 1e-12) << "the arm is simply without it";
    EXPECT_EQ(sensor.lost_ticks(), 20);
    follow(sound, ForceSensor::hold - T, ForceSensor::rise);
    EXPECT_EQ(sensor.gain(), 0.0);
    EXPECT_FALSE(sensor.is_lost());
    follow(sound, ForceSensor::rise + 2 * T, ForceSensor::rise);
    EXPECT_EQ(sensor.gain(), 0.5);
  }
}

TEST(ForceSensor, FallsToZeroAlsoWhereASingleReadingIsMissing) {
  ForceSensor sensor = ready();
  Signals signals = signals_with({{20, 0, 0}, {0, 0, 0}});
  feed(sensor, signals, 1.0);
  signals.is_measured = false;
  feed(sensor, signals, T);
  signals.is_measured = true;
  signals.measured.force.x() = 100.0;
  feed(sensor, signals, 0.04);
  EXPECT_NEAR(sensor.force().force.x(), 20.0, 1e-12) << "the last force, until the share is zero";
  feed(sensor, signals, 0.02);
  EXPECT_EQ(sensor.gain(), 0.0);
  EXPECT_NEAR(sensor.force().force.x(), 100.0, 1e-12);
}

TEST(ForceSensor, LetsGoAtRestAndForgetsWhenReleased) {
  ForceSensor sensor = ready({.cutoff = 0.0, .tare = 0.1});
  Signals signals = signals_with({{1, 0, 0}, {0, 0, 0}});
  feed(sensor, signals, 1.0);
  signals.at_rest = true;
  feed(sensor, signals, 0.05);
  EXPECT_EQ(sensor.gain(), 0.0);
  signals.at_rest = false;
  feed(sensor, signals, 1.0);
  EXPECT_EQ(sensor.gain(), 0.5);
  signals.at_rest = signals.released = true;
  feed(sensor, signals, T);
  EXPECT_EQ(sensor.gain(), 0.0);
  EXPECT_EQ(sensor.force().force, Vec3::Zero());
  EXPECT_EQ(sensor.bias().force, Vec3(1, 0, 0)) << "the bias is that of the sensor";
}

TEST(ForceSensor, RefusesNumbersOutOfRange) {
  EXPECT_THROW(ForceSensor({.gain = 0.71}), SetupError);
  EXPECT_THROW(ForceSensor({.gain = -0.1}), SetupError);
  EXPECT_THROW(ForceSensor({.cutoff = -1.0}), SetupError);
  EXPECT_THROW(ForceSensor({.force_range = 0.0}), SetupError);
  EXPECT_THROW(ForceSensor({.torque_range = std::nan("")}), SetupError);
  EXPECT_THROW(ForceSensor({.tare = 101.0}), SetupError);
  EXPECT_THROW(ForceSensor({.mass = -1.0}), SetupError);
  EXPECT_THROW(ForceSensor({.p_TC = Vec3(11, 0, 0)}), SetupError);
}

Plan plan_ending_in(const std::vector<std::pair<std::string, Module>>& end) {
  Plan plan;
  plan.add("hand", FlowSource<any_size>(Vec<any_size>::Zero(6))).add("kbb2", Kbb2());
  for (const auto& [name, module] : end) plan.add(name, module);
  return plan;
}
std::string complaint(const Plan& plan) {
  try {
    (void)plan.build(T, PredictionOptions{});
  } catch (const SetupError& error) {
    return error.what();
  }
  return {};
}

TEST(ForceSensor, MustBeTheLastModuleBeforeTheRobot) {
  const std::vector<JointRange> ranges(6, {-1.0, 1.0});
  const std::pair<std::string, Module> kin{"puma_kin", PumaKin()}, walls{"arm", ArmObstacle()},
      stops{"limits", Limits({}, ranges)}, view{"visual", Visual()},
      sensor{"force_sensor", ForceSensor()}, robot{"puma_joints", PumaJoints(6)};
  EXPECT_EQ(complaint(plan_ending_in({kin, walls, stops, view, sensor, robot})), "");
  EXPECT_EQ(complaint(plan_ending_in({kin, sensor, robot})), "");
  for (const auto& [plan, between] :
       {std::pair(plan_ending_in({kin, walls, sensor, stops, robot}), "'limits'"),
        std::pair(plan_ending_in({kin, sensor, view, robot}), "'visual'"),
        std::pair(plan_ending_in({kin, sensor, {"second", ForceSensor()}, robot}), "'second'")}) {
    const std::string said = complaint(plan);
    EXPECT_NE(said.find("'force_sensor' must be the last module before 'puma_joints'"),
              std::string::npos)
        << said;
    EXPECT_NE(said.find(between), std::string::npos) << said;
  }
  EXPECT_NE(complaint(plan_ending_in({sensor, kin, robot})), "") << "the tool is not its space";
}

// Otherwise what is predicted on its left would be without what it adds.
TEST(ForceSensor, PredictionIsOnItsLeft) {
  const Network network = plan_ending_in({{"puma_kin", PumaKin()},
                                          {"force_sensor", ForceSensor()},
                                          {"puma_joints", PumaJoints(6)}})
                              .build(T, PredictionOptions{});
  const Node* sensor = network.find("force_sensor");
  EXPECT_EQ(network.connection(sensor->left).left, "prediction");
  EXPECT_EQ(network.connection(sensor->toward_root).right, "puma_joints");
}

TEST(ForceSensor, GainsThatSuitTheArmSuitALighterOne) {
  RobotEnd robot{.mass = 3.0, .inertia = 0.3, .response = 1.5 * T};
  robot.joints.setConstant(6, 1.0);
  const auto damping = [&](const std::vector<std::pair<std::string, Module>>& end) {
    Plan plan;
    plan.add("hand", FlowSource<any_size>(Vec<any_size>::Zero(6)))
        .add("kbb2", Kbb2({.stiffness = automatic, .damping = automatic, .force_limit = 1e6}));
    for (const auto& [name, module] : end) plan.add(name, module);
    return plan.build(T, PredictionOptions{}, robot).find<Kbb2>()->options().damping;
  };
  const std::pair<std::string, Module> kin{"puma_kin", PumaKin()}, last{"robot", PumaJoints(6)};
  const double without = damping({kin, last});
  EXPECT_NEAR(damping({kin, {"sensor", ForceSensor({.gain = 0.6})}, last}), without / 1.6,
              1e-9 * without);
}

/// A mass on a rail, held by a coupling to a hand at rest, which touches a spring without friction.
struct Touching {
  double mass = 5.0;       // [kg] true
  double model = 1.0;      // mass that is used, as a share of it
  double period = T;       // [s]
  double stiffness = 1e5;  // [N/m] of what is touched
  double damping = 0.02;   // share of the critical damping of mass and spring
  double gain = 0.5;
  double cutoff = ForceSensorOptions{}.cutoff;  // [Hz]
  bool sticks = false;  // what is touched pulls as well; else a force presses the mass on it

  /// The greatest speed in the last quarter of two seconds after a push, as a share of that in the
  /// first.
  [[nodiscard]] double growth() const {
    ForceSensor sensor({.gain = gain, .cutoff = cutoff, .force_range = 1e6, .torque_range = 1e6});
    Network network =
        plan_ending_in(
            {{"puma_kin", PumaKin()}, {"force_sensor", sensor}, {"puma_joints", PumaJoints(1)}})
            .build(period, PredictionOptions{});
    Signals signals = detail::neutral_signals(1, period);
    MeasuredFlow flow(1);
    double x = 0.0, v = 0.0, force = 0.0, first = 0.0, last = 0.0;
    const int begin = static_cast<int>(std::lround(0.6 / period));
    const int ticks = static_cast<int>(std::lround(2.0 / period));
    for (int tick = -begin; tick < ticks; ++tick) {
      flow.step(Vec<any_size>::Constant(1, x), Vec<any_size>::Constant(1, v), period);
      signals.joints(0) = x;
      signals.rates = flow.flow();
      signals.mean_rates = flow.mean();
      const double lighter = 1.0 + network.find<ForceSensor>()->gain();
      signals.inertia.setConstant(1, 1, model * mass / lighter);
      signals.measured.force.x() = force;
      signals.is_measured = true;
      EXPECT_TRUE(network.run(signals));
      if (tick == 0) v += 0.2;
      force = move(network.find<PumaJoints>()->torques()(0), x, v);
      if (tick >= 0 && tick < ticks / 4) first = std::max(first, std::abs(v));
      if (tick >= ticks - ticks / 4) last = std::max(last, std::abs(v));
      if (!(std::abs(x) < 1e6)) return 1e9;
    }
    return last / first;
  }
  /// Moves for a tick; the mean force of what is touched [N].
  double move(double torque, double& x, double& v) const {
    constexpr int parts = 100;
    const double h = period / parts;
    const double d = 2.0 * damping * std::sqrt(stiffness * mass);
    double sum = 0.0;
    for (int i = 0; i < parts; ++i) {
      double touch = -stiffness * x - d * v;
      if (!sticks) touch = x < 0.0 ? std::max(0.0, touch) : 0.0;
      v += h * (torque + touch - (sticks ? 0.0 : 60.0)) / mass;
      x += h * v;
      sum += touch;
    }
    return sum / parts;
  }
  [[nodiscard]] std::string said() const {
    return "mass " + repel::to_text(mass) + ", model " + repel::to_text(model) + ", period " +
           repel::to_text(period) + ", stiffness " + repel::to_text(stiffness) + ", gain " +
           repel::to_text(gain) + (sticks ? ", sticks" : "");
  }
};

TEST(ForceSensor, PressesOnAnythingWithoutOscillation) {
  for (const double period : {0.0025, 0.001}) {
    for (const double mass : {2.0, 5.0}) {
      for (const double model : {0.3, 0.6, 1.0, 1.7}) {
        for (const double stiffness : {1e3, 1e4, 1e5, 1e6}) {
          for (const bool sticks : {false, true}) {
            for (const double gain : {0.5, ForceSensor::most_gain}) {
              const Touching arm{.mass = mass,
                                 .model = model,
                                 .period = period,
                                 .stiffness = stiffness,
                                 .gain = gain,
                                 .sticks = sticks};
              EXPECT_LT(arm.growth(), 0.7) << arm.said();
            }
          }
        }
      }
    }
  }
}

// The lag of the low pass is a negative damping of g M 2 pi cutoff at most, where the spring that
// is touched has none; the coupling gives (1 + g) of its 120 N s/m.
TEST(ForceSensor, AHeavyArmNeedsALowCutoffWhereWhatItTouchesRings) {
  Touching arm{.mass = 10.0, .stiffness = 1e5, .damping = 0.0, .sticks = true};
  const double most = 1.5 * 120.0 / (0.5 * arm.mass * 2.0 * std::numbers::pi);  // [Hz] 5.7
  arm.cutoff = 0.7 * most;
  EXPECT_LT(arm.growth(), 0.7);
  arm.cutoff = 4.0 * most;
  EXPECT_GT(arm.growth(), 1.0);
}

TEST(ForceSensor, IsNotWhatMakesALightArmOscillateOnARingingSpring) {
  Touching arm{.mass = 0.5, .stiffness = 1e6, .damping = 0.0, .gain = 0.0, .sticks = true};
  EXPECT_GT(arm.growth(), 1.0);
  arm.damping = 0.1;
  EXPECT_LT(arm.growth(), 0.7);
  arm.gain = 0.5;
  EXPECT_LT(arm.growth(), 0.7);
}

}  // namespace force_sensor_test
}  // namespace repel::network
