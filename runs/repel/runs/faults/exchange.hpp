// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What passes between an arm and its cell in a tick, for a fault to change.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <repel/network/operator.hpp>
#include <repel/world/arm_kinematics.hpp>

namespace repel::faults {

/// The last values of something. Allocates at construction only.
template <class T>
class Past {
 public:
  /// @param most that are kept, 1 or more @param like what has their size
  Past(std::size_t most, const T& like) : values_(most, like) {}

  /// The newest one. It has the size of the others.
  void push(const T& value) {
    newest_ = (newest_ + 1) % values_.size();
    values_[newest_] = value;
    count_ = std::min(count_ + 1, values_.size());
  }
  /// That of so many pushes before the newest, or the oldest there is.
  [[nodiscard]] const T& operator[](std::size_t age) const {
    const std::size_t all = values_.size();
    return values_[(newest_ + all - std::min(age, count_ - 1)) % all];
  }

 private:
  std::vector<T> values_;  // a ring
  std::size_t newest_ = 0, count_ = 0;
};

/// Positions [rad] or [m] and rates of the joints.
struct Reading {
  std::vector<double> q, v;
};

/// What kinematics answer at a pose.
struct Answers {
  Pose X_WT = Pose::Identity();
  Jacobian J;
  std::vector<double> gravity;  ///< [N m]
  Eigen::MatrixXd M;            ///< [kg m^2]
};

/// What the drive of a joint does in a tick. Torques [N m] or [N].
struct DriveOfJoint {
  double torque = 0.0;       ///< that the motor is to give; it gives its effort limit at most
  double effort = 0.0;       ///< its effort limit
  double brake_holds = 1.0;  ///< share of the brake's torque while brakes are on
  double brake_drags = 0.0;  ///< the same while they are off
};

/// A tick. A fault changes what belongs to its class; all else is for it to read.
struct Exchange {
  std::int64_t since = -1;  ///< ticks since the fault began, 0 in its first; below 0: not yet
  double period = 0.0;      ///< [s]
  std::size_t shoulder = 0, wrist = 0;  ///< joints that most and least move the tool
  std::vector<double> away;  ///< sign of a reading's error by which a joint seems farther off
  std::mt19937_64 random;

  Reading read;         ///< class readings
  Reading held;         ///< that of the last tick before the fault
  Past<Reading> older;  ///< sound ones, the newest is that of this tick

  Answers answers;  ///< class kinematics
  Answers known;    ///< those of the last tick before the fault

  std::chrono::nanoseconds now{0};    ///< class clock
  std::chrono::nanoseconds begun{0};  ///< that of the last tick before the fault
  int missed = 0;                     ///< class clock: ticks that the loop stands still before it

  std::vector<DriveOfJoint> drive;  ///< class drive
  bool stops = false;               ///< class drive: it stops by itself
  Past<std::vector<double>> sent;   ///< [N m] torques
  std::size_t late = 0;             ///< [ticks] by which the drive is late, as told

  network::Command command;  ///< class operator
  Vec3 inward{0, 0, 0};      ///< unit, into the wall

  /// Of an arm that begins at rest. Faults of it allocate nothing.
  /// @param start [rad] or [m] @param tick [s] its period @param delay [ticks] of its drive, as
  /// told
  Exchange(const std::vector<double>& start, double tick, std::size_t delay)
      : period(tick),
        away(start.size(), 1.0),
        read{start, std::vector<double>(start.size())},
        held(read),
        older(static_cast<std::size_t>(std::max(6, ticks(0.06))), read),
        drive(start.size()),
        sent(delay + 6, read.v),
        late(delay) {
    const auto n = static_cast<Eigen::Index>(start.size());
    answers.J.setZero(6, n);
    answers.M.setZero(n, n);
    answers.gravity.resize(start.size());
    known = answers;
  }

  /// [s] since the fault began.
  [[nodiscard]] double time() const { return static_cast<double>(since) * period; }
  /// Normally distributed.
  double noise(double deviation) {
    return std::normal_distribution<double>(0.0, deviation)(random);
  }
  /// The sound reading of so many ticks before.
  [[nodiscard]] const Reading& before(std::int64_t ticks) const {
    return older[static_cast<std::size_t>(ticks)];
  }
  /// Of so much time [s], to the nearest.
  [[nodiscard]] int ticks(double seconds) const { return static_cast<int>(seconds / period + 0.5); }

  double& q() { return read.q[shoulder]; }
  double& v() { return read.v[shoulder]; }
  double& wrist_q() { return read.q[wrist]; }
  double& wrist_v() { return read.v[wrist]; }
  [[nodiscard]] double held_q() const { return held.q[shoulder]; }
  double& torque() { return drive[shoulder].torque; }
  double& wrist_torque() { return drive[wrist].torque; }
  Twist& ball() { return command.hand.ball; }

  /// Torques that act where the drive is later than told.
  void delay_drive(std::size_t ticks) {
    const std::vector<double>& then = sent[late + ticks];
    for (std::size_t i = 0; i < drive.size(); ++i) drive[i].torque = then[i];
  }
  /// A reading of a joint is off by `error` [rad], which makes it seem farther off the wall.
  void shift(std::size_t joint, double error) { read.q[joint] += away[joint] * error; }
  /// The same, by an error that grows [rad/s].
  void drift(std::size_t joint, double rate) { shift(joint, rate * time()); }
  /// A joint reports what it did before the fault.
  void freeze(std::size_t joint) {
    read.q[joint] = held.q[joint];
    read.v[joint] = held.v[joint];
  }
  /// A joint reports `factor` times its way since then, and its rate.
  void stretch(std::size_t joint, double factor) {
    read.q[joint] = held.q[joint] + factor * (read.q[joint] - held.q[joint]);
    read.v[joint] *= factor;
  }
};

/// At which place of the loop a fault is.
enum class Kind { readings, kinematics, clock, drive, operators };

/// "readings", "kinematics", "clock", "drive" or "operator".
inline const char* to_text(Kind kind) {
  static constexpr const char* names[] = {"readings", "kinematics", "clock", "drive", "operator"};
  return names[static_cast<std::size_t>(kind)];
}

/// What is asked of the loop.
enum class Demand {
  hold,    ///< to keep the arm out of a hard wall
  notice,  ///< no loop can hold it: to say so
};

/// What an arm must have for a fault to make a difference.
enum class Needs {
  nothing,
  two_joints,
  joint_brakes,  ///< a brake for each joint, which simulated arms of scenes do not have
};

/// A fault, by name.
struct Fault {
  const char* name;           ///< what it is
  Kind kind;                  ///< where it acts
  void (*change)(Exchange&);  ///< what it does in a tick
  int every = 1;  ///< it acts in every so many ticks from its first on; 0: in its first alone
  Demand demand = Demand::hold;  ///< what is asked of the loop
  Needs needs = Needs::nothing;  ///< without which it is none

  /// Acts if it is of this kind and its time has come.
  void act(Kind place, Exchange& x) const {
    if (kind != place || x.since < 0) return;
    if (every == 0 ? x.since == 0 : x.since % every == 0) change(x);
  }
};

/// All of them.
[[nodiscard]] std::span<const Fault> all_faults();

}  // namespace repel::faults
