// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Stand-in for <franka/robot.h> of libfranka, with the published signatures of what adapters
/// use, and a simulated arm in place of the robot. Time is simulated: `control` runs as fast as
/// it can.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>

#include <franka/control_types.h>
#include <franka/duration.h>
#include <franka/exception.h>
#include <franka/lowpass_filter.h>
#include <franka/robot_state.h>

namespace franka {

class Model;

/// What `Robot::control` calls back.
template <class Command>
using Callback = std::function<Command(const RobotState&, Duration)>;

class Robot {
 public:
  using ServerVersion = uint16_t;

  explicit Robot(const std::string& /*franka_address*/,
                 RealtimeConfig /*realtime_config*/ = RealtimeConfig::kEnforce,
                 size_t /*log_size*/ = 50) {
    state_.robot_mode = RobotMode::kIdle;
    state_.time = Duration(1000);
    stand(RobotMode::kIdle);
  }
  Robot(Robot&&) noexcept = default;
  Robot& operator=(Robot&&) noexcept = default;
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;
  virtual ~Robot() noexcept = default;

  Model loadModel();
  /// The URDF of the simulated arm, up to its flange; from release 0.14 on.
  std::string getRobotModel();
  virtual RobotState readOnce() { return state_; }
  void read(std::function<bool(const RobotState&)> read_callback) {
    while (read_callback(state_)) state_.time += Duration(1);
  }
  ServerVersion serverVersion() const noexcept { return 0; }
  void automaticErrorRecovery() { state_.robot_mode = RobotMode::kIdle; }
  void stop() { stand(RobotMode::kIdle); }
  void setEE(const std::array<double, 16>& NE_T_EE) { state_.F_T_EE = NE_T_EE; }
  void setLoad(double load_mass, const std::array<double, 3>& F_x_Cload,
               const std::array<double, 9>& load_inertia) {
    state_.m_load = state_.m_total = load_mass;
    state_.F_x_Cload = state_.F_x_Ctotal = F_x_Cload;
    state_.I_load = state_.I_total = load_inertia;
  }
  // The simulated arm meets nothing: thresholds of torques and forces are without effect.
  void setCollisionBehavior(const std::array<double, 7>&, const std::array<double, 7>&,
                            const std::array<double, 7>&, const std::array<double, 7>&,
                            const std::array<double, 6>&, const std::array<double, 6>&,
                            const std::array<double, 6>&, const std::array<double, 6>&) {}
  void setCollisionBehavior(const std::array<double, 7>&, const std::array<double, 7>&,
                            const std::array<double, 6>&, const std::array<double, 6>&) {}

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
