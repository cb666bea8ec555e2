// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// An arm of three prismatic joints with a chosen fault while it moves towards a wall.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "loop/slider.hpp"

namespace repel::test {

/// The fault; permanent unless marked as occurring once.
enum class Fault {
  none,
  silent_operator,
  bad_command,      ///< NaN in the command
  not_a_number,     ///< one position is NaN
  never_a_number,   ///< from the start
  frame_of_zeros,   ///< once
  frozen_frame,     ///< all positions and rates
  frozen_position,  ///< one; its rate is right
  frozen_encoder,   ///< one position, and the velocity derived from it
  jump,             ///< of one position by 0.1 m, once
  huge_position,    ///< 1e308 m, once
  huge_rate,        ///< -1e308 m/s, once
  bad_pose,         ///< of the kinematics
  bad_gravity,      ///< gravity torque is NaN, once
  arm_stops,        ///< on its own, once
  late_loop,        ///< no tick for 1.5 s, once
};

inline const char* name_of(Fault fault) {
  static constexpr const char* names[] = {
      "none",           "silent operator", "bad command",     "not a number",   "never a number",
      "frame of zeros", "frozen frame",    "frozen position", "frozen encoder", "jump",
      "huge position",  "huge rate",       "bad pose",        "bad gravity",    "arm stops",
      "late loop"};
  return names[static_cast<std::size_t>(fault)];
}

/// Three masses on rails, one of which may carry a weight. `since` counts ticks since the fault.
struct FaultySlider : SliderArm {
  void read_positions(std::span<double> out) const noexcept override {
    std::copy(q.begin(), q.end(), out.begin());
    if (fault == Fault::never_a_number) out[1] = std::numeric_limits<double>::quiet_NaN();
    if (since < 0) return;
    if (fault == Fault::not_a_number) out[0] = std::numeric_limits<double>::quiet_NaN();
    if (fault == Fault::frozen_frame) std::copy(frozen_q.begin(), frozen_q.end(), out.begin());
    if (fault == Fault::frozen_position || fault == Fault::frozen_encoder) out[0] = frozen_q[0];
    if (since > 0) return;
    if (fault == Fault::frame_of_zeros) std::fill(out.begin(), out.end(), 0.0);
    if (fault == Fault::jump) out[0] += 0.1;
    if (fault == Fault::huge_position) out[0] = 1e308;
  }
  void read_velocities(std::span<double> out) const noexcept override {
    std::copy(v.begin(), v.end(), out.begin());
    if (since < 0) return;
    if (fault == Fault::frozen_frame) std::copy(frozen_v.begin(), frozen_v.end(), out.begin());
    if (fault == Fault::frozen_encoder) out[0] = 0.0;
    if (since > 0) return;
    if (fault == Fault::frame_of_zeros) std::fill(out.begin(), out.end(), 0.0);
    if (fault == Fault::huge_rate) out[0] = -1e308;
  }
  void step(double period) noexcept override {
    force[2] -= weight;
    SliderArm::step(period);
    force[2] += weight;
  }
  /// Keeps the readings of the previous tick.
  void begin_tick(int tick_since) noexcept {
    since = tick_since;
    if (since >= 0) return;
    frozen_q = q;
    frozen_v = v;
  }

  Fault fault = Fault::none;
  int since = -1;
  double weight = 0.0;  // [N] of the third
  std::array<double, 3> frozen_q{}, frozen_v{};
};

/// The same with a drive that stops on its own and brakes that hold at once.
struct BrakedSlider : FaultySlider {
  void enable() noexcept override { state_ = ArmState::enabled; }
  void stop() noexcept override { state_ = ArmState::stopped; }
  void engage_brakes(bool on) noexcept override { brakes = on; }
  [[nodiscard]] ArmState state() const noexcept override { return state_; }
  void step(double period) noexcept override {
    if (fault == Fault::arm_stops && since == 0) stop();
    if (brakes || state_ != ArmState::enabled) {
      v.fill(0.0);
    } else {
      FaultySlider::step(period);
    }
  }

  ArmState state_ = ArmState::enabled;
  bool brakes = false;
};

/// Gravity of a weight, and once NaN.
struct WeighedKinematics : SliderKinematics {
  void gravity_torques(std::span<double> out) noexcept override {
    std::fill(out.begin(), out.end(), 0.0);
    out[2] = no_number ? std::numeric_limits<double>::quiet_NaN() : weight;
  }
  double weight = 0.0;  // [N]
  bool no_number = false;
};

/// Results of a run, from the fault on. Lengths [m], forces [N].
struct FaultRun {
  double deepest = -1.0;  ///< penetration of the ball into the wall
  double way = 0.0;       ///< displacement of the ball from its start
  double top_speed = 0.0, speed_at_end = 0.0;
  double largest_force = 0.0, largest_change = 0.0;
  int noticed = -1;           ///< ticks from the fault to a stop; -1: none
  Stop stop = Stop::running;  ///< the worst
  Status status = 0;
  bool brakes = false;
  std::int64_t missing = 0;  ///< ticks
  TickRecord last;
};

/// Four seconds of a slider whose operator continues to move, with the fault after `before` [s].
template <class Arm>
FaultRun run_slider(Fault fault, network::Script script, double before, double friction,
                    double weight, double effort_limit) {
  ArmModel model = slider_model(effort_limit);
  for (ArmLink& link : model.links) link.viscous_friction = friction;
  Arm arm;
  arm.friction = friction;
  arm.fault = fault;
  arm.weight = weight;
  CellDescription description;
  description.gain_check = network::GainCheck::warning;
  ArmDescription& sliders = description.arms.emplace_back();
  sliders.model = model;
  auto owned = std::make_unique<WeighedKinematics>();
  WeighedKinematics& kinematics = *owned;
  kinematics.weight = weight;
  sliders.kinematics = std::move(owned);
  sliders.parts.push_back({"ball", Shape::sphere(0.05)});
  sliders.network = sliders_network();
  sliders.options.has_brakes = std::is_same_v<Arm, BrakedSlider>;
  Pose X_WB = Pose::Identity();
  X_WB.translation().x() = 0.3;
  description.obstacles.push_back({"wall",
                                   Shape::box({0.1, 1.0, 1.0}),
                                   X_WB,
                                   {.range = 0.02, .surface_force = 100.0, .damping = 50.0}});
  Cell cell(std::move(description));
  ArmPort port(arm, 3);
  network::ScriptedOperator hands(std::move(script));
  const double period = 1e-9 * static_cast<double>(SliderCell::period.count());
  const int begins = static_cast<int>(std::lround(before / period));
  FaultRun run;
  std::chrono::nanoseconds now{0};
  std::array<double, 3> sent = arm.force;
  for (int k = 0; k < begins + 1600; ++k) {
    const int since = k - begins;
    arm.begin_tick(since);
    kinematics.spoilt = fault == Fault::bad_pose && since >= 0;
    kinematics.no_number = fault == Fault::bad_gravity && since == 0;
    now += (fault == Fault::late_loop && since == 0 ? 600 : 1) * SliderCell::period;
    const ArmReadings readings = port.read();
    cell.sense({&readings, 1}, now);
    const network::Command& command = hands.step(cell.X_WT(0).linear(), cell.elapsed());
    run.last = *cell.act({&command, 1}).front();
    port.apply(run.last);
    for (std::size_t i = 0; i < 3 && k > 0; ++i) {
      run.largest_change = std::max(run.largest_change, std::abs(arm.force[i] - sent[i]));
    }
    sent = arm.force;
    arm.step(period);
    if (since < 0) continue;
    if (run.last.stop != Stop::running && run.noticed < 0) run.noticed = since;
    run.stop = std::max(run.stop, run.last.stop);
    run.status |= run.last.status;
    run.brakes = run.brakes || run.last.brakes;
    run.missing += run.last.elapsed - 1;
    for (const double force : arm.force) {
      run.largest_force = std::max(run.largest_force, std::abs(force) + (force - force));
    }
    run.deepest = std::max(run.deepest, arm.q[0] - 0.15);
    run.top_speed = std::max(run.top_speed, std::abs(arm.v[0]));
    run.way = std::max(run.way, std::abs(arm.q[0]));
  }
  run.speed_at_end = std::abs(arm.v[0]);
  return run;
}

/// The operator moves the ball towards the wall, and into it unless a fault occurs 40 mm before the
/// ball touches its face, which is 20 mm before the force range.
template <class Arm>
FaultRun run_into_wall(Fault fault, double speed, double friction, double weight = 0.0,
                       double effort_limit = 1000.0) {
  const double before = 0.12 / speed;
  network::Script script = push(before, speed);
  network::Phase after = script.front();
  after.duration = 0.05 / speed;  // to 10 mm behind the face
  after.silent = fault == Fault::silent_operator;
  if (fault == Fault::bad_command) after.rates.linear.x() = std::nan("");
  if (after.silent || fault == Fault::bad_command) after.duration = 10.0;
  script.push_back(after);
  return run_slider<Arm>(fault, script, before, friction, weight, effort_limit);
}

/// The operator starts moving after the fault.
inline FaultRun run_from_rest(Fault fault, double speed, double friction) {
  return run_slider<BrakedSlider>(fault, push(10.0, speed), 0.0, friction, 0.0, 1000.0);
}

/// A lever that turns at `rate` [rad/s] towards the wall.
inline FaultRun run_with_lever(double rate, double friction) {
  network::Script script = push(10.0, 0.0);
  script.front().master = network::Master::torque_arm;
  script.front().lever_rate = rate;
  return run_slider<FaultySlider>(Fault::none, script, 0.0, friction, 0.0, 1000.0);
}

}  // namespace repel::test
