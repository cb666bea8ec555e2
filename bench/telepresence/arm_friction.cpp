// SPDX-License-Identifier: BSD-3-Clause
// The arm is led through free space against the dry friction of its joints.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <repel/network/modules/puma_joints.hpp>

#include "arm_run.hpp"
#include "part.hpp"
#include "spectrum.hpp"

namespace repel::telepresence {

namespace {

constexpr double lever_scale = 0.1;  // [m/rad] of MULTIPLEX
constexpr int settling = 4;          // ticks after a phase has begun, whose steps do not count

struct Motion {
  const char* name;
  bool turns;      // the tool, in place
  double seconds;  // of the script
  std::string script;
};

std::string phase_of(const std::string& name, double seconds, const std::string& device) {
  return "{name: " + name + ", duration: " + to_text(seconds) + " s, device: " + device + "}";
}

std::string and_stop(const std::string& device) {
  return phase_of("lead", 2.0, device) + ", " + phase_of("stop", 1.0, "spaceball");
}

std::string to_and_fro(const std::string& there, const std::string& back) {
  std::string script;
  for (int i = 0; i < 4; ++i) {
    if (i > 0) script += ", ";
    script += phase_of("to " + std::to_string(i), 0.5, "spaceball, " + there) + ", " +
              phase_of("fro " + std::to_string(i), 0.5, "spaceball, " + back);
  }
  return script;
}

std::vector<Motion> motions() {
  return {
      {"50 mm/s, and stop", false, 3.0, and_stop("spaceball, linear: 30 40 0 mm/s")},
      {"5 mm/s, and stop", false, 3.0, and_stop("spaceball, linear: 3 4 0 mm/s")},
      {"1 deg/s, and stop", true, 3.0, and_stop("spaceball, angular: 0 0 1 deg/s")},
      {"by the lever, and stop", false, 3.0,
       and_stop("torque_arm, direction: -1 -1 0, lever: 30 deg/s")},
      {"50 mm/s, to and fro", false, 4.0,
       to_and_fro("linear: 30 40 0 mm/s", "linear: -30 -40 0 mm/s")},
      {"15 mm/s, to and fro", false, 4.0,
       to_and_fro("linear: 9 12 0 mm/s", "linear: -9 -12 0 mm/s")},
      {"5 deg/s, to and fro", true, 4.0,
       to_and_fro("angular: 3 0 4 deg/s", "angular: -3 0 -4 deg/s")},
  };
}

// The pose that the operator asks for, from the first tick on.
class Asked {
 public:
  explicit Asked(double period) : period_(period) {}

  void begin(const Pose& X_WT) { X_ = X_WT; }
  void step(const network::HandInput& hand) {
    X_.translation() +=
        period_ * (hand.ball.linear + lever_scale * hand.lever_rate * hand.direction_W);
    const double angle = period_ * hand.ball.angular.norm();
    if (angle > 0.0) {
      X_.linear() = Eigen::AngleAxisd(angle, hand.ball.angular.normalized()) * X_.linear();
    }
  }
  // [m] or [rad] from there to a pose.
  [[nodiscard]] double distance(const Pose& X, bool turns) const {
    if (!turns) return (X.translation() - X_.translation()).norm();
    return Eigen::AngleAxisd(Mat3(X.linear() * X_.linear().transpose())).angle();
  }

 private:
  double period_;  // [s]
  Pose X_ = Pose::Identity();
};

// A torque of every joint: its content above 30 Hz, and its greatest step.
struct Torques {
  std::vector<std::vector<double>> samples{};  // [N m] by joint
  std::vector<double> step{};                  // [N m] from tick to tick

  void add(std::size_t joint, double torque, bool counts) {
    if (samples.size() <= joint) {
      samples.resize(joint + 1);
      step.resize(joint + 1, 0.0);
    }
    std::vector<double>& all = samples[joint];
    if (counts && !all.empty()) {
      step[joint] = std::max(step[joint], std::abs(torque - all.back()));
    }
    all.push_back(torque);
  }
  // Of the joint where it is greatest in proportion to its friction.
  [[nodiscard]] double greatest_step(const std::vector<double>& friction) const {
    double most = 0.0;
    for (std::size_t i = 0; i < step.size(); ++i) most = std::max(most, step[i] / friction[i]);
    return most;
  }
  [[nodiscard]] double chatter(const std::vector<double>& friction, double rate_hz) const {
    double most = 0.0;
    for (std::size_t i = 0; i < step.size(); ++i) {
      most = std::max(most, rms_above(samples[i], rate_hz, 30.0) / friction[i]);
    }
    return most;
  }
};

struct Led {
  Torques sent;
  Torques compensation;  // and gravity, which changes slowly
  double most = 0.0;     // [m] or [rad] behind what is asked for
  double rms = 0.0;
  double start = 0.0;  // [N] or [N m] of the coupling before the tool has moved by 0.1 mm or mrad
  ArmEnd end;
};

Led lead(const Motion& motion, bool compensates, double encoder, double rate_hz) {
  ArmScene scene{
      .tool = "{name: rod, shape: capsule, radius: 15 mm, length: 60 mm, position: 0 0 -30 mm}",
      .obstacles = "",
      .script = motion.script,
      .rate_hz = rate_hz,
      .compensates_friction = compensates,
      .encoder = encoder};
  Led led;
  Asked asked(1.0 / rate_hz);
  Asked first(1.0 / rate_hz);
  int phase = -1;
  int since = 0;
  bool rests = true;
  double sum = 0.0;
  double ticks = 0.0;
  led.end = run_arm(scene, motion.seconds, [&](const ArmTick& tick) {
    const TickRecord& r = tick.record;
    if (phase < 0) {
      asked.begin(tick.X_WT);
      first.begin(tick.X_WT);
    }
    since = r.phase == phase ? since + 1 : 0;
    phase = r.phase;
    const auto of_network = tick.network.find<network::PumaJoints>()->torques();
    for (std::size_t i = 0; i < tick.q.size(); ++i) {
      const double net = of_network(static_cast<Eigen::Index>(i));
      led.sent.add(i, r.torques[i], since >= settling);
      led.compensation.add(i, r.torques[i] - net, since >= settling);
    }
    const double behind = asked.distance(tick.X_WT, motion.turns);
    led.most = std::max(led.most, behind);
    sum += behind * behind;
    ticks += 1.0;
    rests = rests && first.distance(tick.X_WT, motion.turns) < 1e-4;
    const double load = motion.turns ? r.coupling.torque.norm() : r.coupling.force.norm();
    if (rests) led.start = std::max(led.start, load);
    asked.step(r.command.hand);
  });
  led.rms = std::sqrt(sum / ticks);
  return led;
}

}  // namespace

Result friction(const Options& options) {
  Result result{
      .title = "Against dry friction",
      .columns = {"motion", "rate [Hz]", "compensation", "encoder [mrad]", "step of a torque [%]",
                  "step of the compensation [%]", "chatter above 30 Hz [%]", "unit",
                  "farthest behind", "rms behind", "load to start"},
      .notes = {"Torques are in percent of the dry friction of their joint, of the joint with the "
                "most; steps are from one tick to the next, without the 10 ms after a change of "
                "the command. Behind is the tool, what is asked for ahead. The load is that of the "
                "coupling before the tool has moved by 0.1 mm or mrad. With an encoder, angles are "
                "read in its steps, and rates are their differences. A row fails if the arm "
                "follows no better than without compensation."}};
  const std::vector<double> rates = options.quick ? std::vector{400.0} : std::vector{400.0, 1000.0};
  const std::vector<Motion> all = motions();
  struct Setting {
    bool compensates;
    double encoder;  // [rad]
  };
  constexpr Setting settings[] = {{false, 0.0}, {true, 0.0}, {true, 1e-4}};
  std::size_t done = 0;
  for (const double rate_hz : rates) {
    for (const Motion& motion : all) {
      double without = 0.0;
      for (const auto& [compensates, encoder] : settings) {
        if (encoder > 0.0 && rate_hz > 400.0) continue;  // differences of so coarse steps are noise
        const Led led = lead(motion, compensates, encoder, rate_hz);
        const std::vector<double>& friction = led.end.dry_friction;
        result.fail(motion.name, led.end.complaint);
        if (!compensates) without = led.rms;
        if (compensates && !(led.rms < without)) result.fail(motion.name, "it follows no better");
        result.rows.push_back({motion.name, rate_hz, compensates ? "yes" : "no", 1e3 * encoder,
                               100.0 * led.sent.greatest_step(friction),
                               100.0 * led.compensation.greatest_step(friction),
                               100.0 * led.sent.chatter(friction, rate_hz),
                               motion.turns ? "mrad, N m" : "mm, N", 1e3 * led.most, 1e3 * led.rms,
                               led.start});
      }
      progress("friction", ++done, all.size() * rates.size());
    }
  }
  return result;
}

}  // namespace repel::telepresence
