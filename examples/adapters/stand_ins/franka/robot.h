// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Stand-in for <franka/robot.h> of libfranka, with the published signatures of what the adapter
/// uses, and a simulated arm in place of the robot. Time is simulated: `control` runs as fast as
/// it can.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>

#include <franka/control_types.h>
#include <franka/exception.h>

namespace franka {

enum class RobotMode {
  kOther,
  kIdle,
  kMove,
  kGuiding,
  kReflex,
  kUserStopped,
  kAutomaticErrorRecovery
};
inline constexpr double kMaxCutoffFrequency = 1000.0;     // [Hz]
inline constexpr double kDefaultCutoffFrequency = 100.0;  // [Hz]

class Duration {  // of whole milliseconds
 public:
  Duration() noexcept = default;
  explicit Duration(uint64_t milliseconds) noexcept : milliseconds_(milliseconds) {}
  Duration(std::chrono::duration<uint64_t, std::milli> time) noexcept
      : milliseconds_(time.count()) {}
  operator std::chrono::duration<uint64_t, std::milli>() const noexcept {
    return std::chrono::duration<uint64_t, std::milli>(milliseconds_);
  }
  double toSec() const noexcept { return 1e-3 * static_cast<double>(milliseconds_); }
  uint64_t toMSec() const noexcept { return milliseconds_; }
  Duration operator-(const Duration& rhs) const noexcept {
    return Duration(milliseconds_ - rhs.milliseconds_);
  }

 private:
  uint64_t milliseconds_ = 0;
};

struct RobotState {
  std::array<double, 16> F_T_EE{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  std::array<double, 7> tau_J{};    // [N m] measured, with gravity
  std::array<double, 7> tau_J_d{};  // [N m] desired, without gravity
  std::array<double, 7> q{};        // [rad]
  std::array<double, 7> dq{};       // [rad/s]
  double control_command_success_rate{};
  RobotMode robot_mode = RobotMode::kIdle;
  Duration time{1000};  // since the robot was switched on
};

class Model;

/// What `Robot::control` calls back.
template <class Command>
using Callback = std::function<Command(const RobotState&, Duration)>;

class Robot {
 public:
  explicit Robot(const std::string& /*franka_address*/,
                 RealtimeConfig /*realtime_config*/ = RealtimeConfig::kEnforce,
                 size_t /*log_size*/ = 50) {
    state_.q = {0.0, -M_PI / 4, 0.0, -3 * M_PI / 4, 0.0, M_PI / 2, M_PI / 4};
  }
  Robot(Robot&&) noexcept = default;
  Robot& operator=(Robot&&) noexcept = default;
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;
  virtual ~Robot() noexcept = default;

  Model loadModel();
  RobotState readOnce() { return state_; }
  void automaticErrorRecovery() { state_.robot_mode = RobotMode::kIdle; }

  /// Calls back every millisecond until the motion is finished. Does not filter.
  /// @throws ControlException as the robot would, and what the callback throws; the arm then stands
  void control(Callback<Torques> control_callback, bool limit_rate = false,
               double /*cutoff*/ = kDefaultCutoffFrequency) {
    if (state_.robot_mode != RobotMode::kIdle) throw ControlException("command not possible");
    state_.robot_mode = RobotMode::kMove;
    state_.tau_J_d = {};
    try {
      Duration last = state_.time;
      for (bool is_finished = false; !is_finished;) {
        Torques command = control_callback(state_, state_.time - last);
        if (limit_rate) limit(command.tau_J);
        last = state_.time;
        is_finished = command.motion_finished;
        obey(command);
      }
      stand(RobotMode::kIdle);
    } catch (...) {
      if (state_.robot_mode == RobotMode::kMove) stand(RobotMode::kIdle);  // motion cancelled
      throw;
    }
  }

  // The other ways to lead the robot: only their signatures are here.
  void control(Callback<Torques>, Callback<JointPositions>, bool = false,
               double = kDefaultCutoffFrequency) {
    refuse();
  }
  void control(Callback<Torques>, Callback<JointVelocities>, bool = false,
               double = kDefaultCutoffFrequency) {
    refuse();
  }
  void control(Callback<Torques>, Callback<CartesianPose>, bool = false,
               double = kDefaultCutoffFrequency) {
    refuse();
  }
  void control(Callback<Torques>, Callback<CartesianVelocities>, bool = false,
               double = kDefaultCutoffFrequency) {
    refuse();
  }
  void control(Callback<JointPositions>, ControllerMode = ControllerMode::kJointImpedance,
               bool = false, double = kDefaultCutoffFrequency) {
    refuse();
  }
  void control(Callback<JointVelocities>, ControllerMode = ControllerMode::kJointImpedance,
               bool = false, double = kDefaultCutoffFrequency) {
    refuse();
  }
  void control(Callback<CartesianPose>, ControllerMode = ControllerMode::kJointImpedance,
               bool = false, double = kDefaultCutoffFrequency) {
    refuse();
  }
  void control(Callback<CartesianVelocities>, ControllerMode = ControllerMode::kJointImpedance,
               bool = false, double = kDefaultCutoffFrequency) {
    refuse();
  }

  // What follows belongs to the stand-in alone.

  /// The next packets are lost: the robot goes on with its last torques meanwhile.
  void lose(int packets) { lost_ = packets; }
  /// What the robot reports from now on, in place of the truth; `nullptr`: the truth.
  std::function<void(RobotState&)> distort;
  /// Fastest change of a torque so far [N m/s].
  double fastest_change() const { return fastest_change_; }

 private:
  static constexpr int most_lost = 20;           // packets
  static constexpr double most_change = 1000.0;  // [N m/s]

  void limit(std::array<double, 7>& torques) const {
    constexpr double most = 1e-3 * (most_change - 1e-3);  // [N m] in a period
    for (std::size_t i = 0; i < 7; ++i) {
      torques[i] = std::clamp(torques[i], state_.tau_J_d[i] - most, state_.tau_J_d[i] + most);
    }
  }

  // Torques act on the simulated arm from packet to packet.
  void obey(const Torques& command) {
    for (std::size_t i = 0; i < 7; ++i) {
      const double change = 1000.0 * std::abs(command.tau_J[i] - state_.tau_J_d[i]);
      fastest_change_ = std::fmax(fastest_change_, change);
      if (!(change <= most_change)) reflex("controller_torque_discontinuity");
    }
    state_.tau_J_d = command.tau_J;
    if (lost_ >= most_lost) reflex("communication_constraints_violation");
    for (; lost_ >= 0; --lost_) move();
    lost_ = 0;
    if (distort) distort(state_);
  }

  [[noreturn]] static void refuse() { throw ControlException("the stand-in takes torques alone"); }

  [[noreturn]] void reflex(const char* error) {
    lost_ = 0;
    stand(RobotMode::kReflex);
    throw ControlException("motion aborted by reflex: " + std::string(error));
  }

  void stand(RobotMode mode) {
    state_.robot_mode = mode;
    state_.q = q_true_;
    state_.dq = dq_true_ = {};
  }

  void move();  // 1 ms, in model.h

  RobotState state_;
  std::array<double, 7> q_true_ = {0.0, -M_PI / 4, 0.0, -3 * M_PI / 4, 0.0, M_PI / 2, M_PI / 4};
  std::array<double, 7> dq_true_{};
  int lost_ = 0;
  double fastest_change_ = 0.0;
};

}  // namespace franka
