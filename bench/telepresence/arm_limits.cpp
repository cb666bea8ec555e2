// SPDX-License-Identifier: BSD-3-Clause
// The operator drives the arm to a joint limit and keeps pushing.

#include <algorithm>
#include <cmath>

#include <repel/base/status.hpp>
#include <repel/network/modules/limits.hpp>

#include "arm_run.hpp"
#include "part.hpp"

namespace repel::telepresence {

namespace {

constexpr double seconds = 6.0;

struct PushedJoint {
  const char* pushed;
  const char* start;
  const char* script;
};
constexpr PushedJoint pushed_joints[] = {
    {"elbow, by the lever", "0 70 -218 0 -30 0 deg",
     "device: torque_arm, direction: -1 0 0, lever: 0.8 rad/s"},
    {"waist, by the lever", "152 45 -180 0 -45 0 deg",
     "device: torque_arm, direction: -0.4 -1 0, lever: 0.8 rad/s"},
    {"wrist bend, by the ball", "0 45 -180 0 -80 0 deg",
     "device: spaceball, angular: 0 20 0 deg/s"},
};

struct Pushed {
  std::size_t joint = 0;  // the joint nearest to a limit at the end
  double margin = 0.0;    // least distance to its limit [rad]
  double torque = 0.0;    // of LIMITS on it, mean over the last second [N m]
  Trace felt;             // torque at the lever [N m]
  Trace drive;            // commanded torque of that joint [N m]
  Trace angle;            // [rad]
  ArmEnd end;
};

double margin_of(double q, const network::JointRange& range) {
  return std::min(q - range.lower, range.upper - q);
}

Pushed push(const PushedJoint& each, double rate_hz) {
  ArmScene scene{
      .tool = "{name: rod, shape: capsule, radius: 15 mm, length: 60 mm, position: 0 0 -30 mm}",
      .obstacles = "",
      .start = each.start,
      .rate_hz = rate_hz};
  scene.script = std::string("{name: push, duration: 6 s, ") + each.script + "}";
  Pushed pushed;
  pushed.felt.rate_hz = pushed.drive.rate_hz = pushed.angle.rate_hz = rate_hz;
  std::vector<std::vector<double>> q;
  std::vector<std::vector<double>> torques;
  std::vector<std::vector<double>> commands;
  pushed.end = run_arm(scene, seconds, [&](const ArmTick& tick) {
    q.emplace_back(tick.q.begin(), tick.q.end());
    const auto limits = tick.network.find<network::Limits>()->torques();
    torques.emplace_back(limits.begin(), limits.end());
    commands.emplace_back(tick.record.torques.begin(), tick.record.torques.end());
    pushed.felt.samples.push_back(tick.record.lever_torque);
  });
  const auto& ranges = pushed.end.ranges;
  for (std::size_t i = 1; i < ranges.size(); ++i) {
    if (margin_of(q.back()[i], ranges[i]) <
        margin_of(q.back()[pushed.joint], ranges[pushed.joint])) {
      pushed.joint = i;
    }
  }
  pushed.margin = INFINITY;
  Trace torque{.rate_hz = rate_hz};
  for (std::size_t k = 0; k < q.size(); ++k) {
    pushed.margin = std::min(pushed.margin, margin_of(q[k][pushed.joint], ranges[pushed.joint]));
    pushed.angle.samples.push_back(q[k][pushed.joint]);
    torque.samples.push_back(torques[k][pushed.joint]);
    pushed.drive.samples.push_back(commands[k][pushed.joint]);
  }
  pushed.torque = torque.mean();
  return pushed;
}

}  // namespace

Result joint_limits(const Options& options) {
  Result result{
      .title = "A joint at its end",
      .columns = {"pushed", "rate [Hz]", "joint", "least margin [deg]", "torque of LIMITS [N m]",
                  "torque at the lever [N m]", "its chatter above 30 Hz [mN m]",
                  "swing of the joint [mdeg]", "jump of the lever torque [mN m]",
                  "chatter of the joint above 30 Hz [N m]", "jump of the joint torque [N m]"},
      .notes = {"The operator drives that joint to its limit and keeps pushing for 6 s; "
                "figures are of the last second. A row fails if the joint reaches its "
                "mechanical stop, or LIMITS do not hold it. The torque of the "
                "joint is the commanded one; jumps are from one tick to the next."}};
  std::size_t done = 0;
  const std::vector<double> rates = options.quick ? std::vector{400.0} : std::vector{400.0, 4000.0};
  constexpr double degree = M_PI / 180.0;
  for (const PushedJoint& each : pushed_joints) {
    for (const double rate_hz : rates) {
      const Pushed p = push(each, rate_hz);
      const std::string row = each.pushed;
      result.fail(row, p.end.complaint);
      if (!(p.margin > 0.0)) result.fail(row, "the joint reached its stop");
      if (!(std::abs(p.torque) > 1.0)) result.fail(row, "LIMITS did not act");
      result.rows.push_back({each.pushed, rate_hz, p.joint + 1, p.margin / degree, p.torque,
                             p.felt.mean(), 1e3 * p.felt.chatter(), 1e3 * p.angle.swing() / degree,
                             1e3 * p.felt.jump(), p.drive.chatter(), p.drive.jump()});
      progress("limits", ++done, std::size(pushed_joints) * rates.size());
    }
  }
  return result;
}

}  // namespace repel::telepresence
