// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// repel in front of an arm that takes joint positions: servoJ of ur_rtde, to copy.
/// docs/own_controller/position_servo.md explains it.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include <ur_rtde/rtde_control_interface.h>
#include <ur_rtde/rtde_receive_interface.h>

#include <repel/base/mailbox.hpp>
#include <repel/cell/admittance.hpp>
#include <repel/cell/cell.hpp>

namespace adapters {

/// Thrown when the arm is to stand still, or does by itself.
struct ArmStopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// From joint readings to the positions that the arm is sent.
class PositionServo {
 public:
  /// @param cell with one arm, whose start is where the arm is @param options of its admittance
  /// @throws repel::SetupError
  PositionServo(repel::CellDescription cell, const repel::AdmittanceOptions& options)
      : cell_(admitted(std::move(cell), options)),
        end_(cell_.description().arms[0].model, options.response,
             1.0 / cell_.description().rate_hz),
        positions_(cell_.description().arms[0].start) {}

  /// One period. @param q [rad] @param v [rad/s] @param follows the arm obeys commands now
  /// @param now a clock that grows @return positions to send [rad]
  /// @throws ArmStopped when the brakes are requested
  const std::vector<double>& step(const std::vector<double>& q, const std::vector<double>& v,
                                  bool follows, std::chrono::nanoseconds now) {
    if (master_.take()) {
      command_ = {.hand = master_.newest()};
    } else {
      command_.silent_for += 1.0 / cell_.description().rate_hz;
    }
    command_.sound = !finish_;  // to finish, the operator is let go and the arm brakes
    const auto drive = follows ? repel::ArmState::enabled : repel::ArmState::stopped;
    const repel::ArmReadings readings{q, v, drive};
    record_ = &cell_.step(readings, command_, now);
    end_.step(readings, record_->torques, record_->brakes);
    if (record_->brakes)
      throw ArmStopped("repel stops the arm: " + repel::to_text(record_->status));
    std::copy(end_.positions().begin(), end_.positions().end(), positions_.begin());
    return positions_;
  }
  /// Whether it was told to finish and sends the arm nowhere any more.
  [[nodiscard]] bool stands() const noexcept {
    const auto slow = [](double v) { return std::abs(v) < 0.01; };  // [rad/s]
    return finish_ && std::all_of(end_.rates().begin(), end_.rates().end(), slow);
  }

  /// For one other thread: what the master reports, at least every 20 ms.
  void lead(const repel::network::HandInput& hand) noexcept {
    master_.draft() = hand;
    master_.post();
  }
  /// For any thread: ends the motion as soon as the arm stands.
  void finish() noexcept { finish_ = true; }
  /// Of the last period, for the thread of `step`; none before the first.
  [[nodiscard]] const repel::TickRecord* record() const noexcept { return record_; }

 private:
  static repel::CellDescription admitted(repel::CellDescription cell,
                                         const repel::AdmittanceOptions& options) {
    repel::ArmDescription& arm = cell.arms.at(0);
    arm.options.has_brakes = true;  // servoStop, then those of the arm
    arm = repel::admitted(std::move(arm), options, 1.0 / cell.rate_hz);
    return cell;
  }

  repel::Cell cell_;
  repel::JointAdmittance end_;
  std::vector<double> positions_;
  repel::Mailbox<repel::network::HandInput> master_{{}};
  repel::network::Command command_{.silent_for = 1.0};  // [s] until the master reports
  std::atomic<bool> finish_ = false;
  const repel::TickRecord* record_ = nullptr;
};

/// How closely the arm follows: the arguments of servoJ.
struct ServoGains {
  double lookahead_time = 0.03;  ///< [s] 0.03 to 0.2: later, and smoother
  double gain = 300.0;           ///< 100 to 2000
};

/// Servos the arm until `servo` has finished. Calls each(servo) after every period.
/// @param period [s] of both interfaces and of the cell
/// @throws ArmStopped when repel requests the brakes, or the arm does not follow
template <class Each>
void run(ur_rtde::RTDEControlInterface& control, ur_rtde::RTDEReceiveInterface& receive,
         PositionServo& servo, double period, const ServoGains& gains, const Each& each) {
  try {
    while (!servo.stands()) {
      const auto start = control.initPeriod();
      const bool follows = !receive.isProtectiveStopped() && !receive.isEmergencyStopped();
      const std::chrono::nanoseconds now(std::llround(1e9 * receive.getTimestamp()));
      const std::vector<double>& q =
          servo.step(receive.getActualQ(), receive.getActualQd(), follows, now);
      if (!follows) throw ArmStopped("the arm stopped by itself");
      if (!control.servoJ(q, 0.0, 0.0, period, gains.lookahead_time, gains.gain)) {
        throw ArmStopped("the arm does not take positions");
      }
      each(servo);
      control.waitPeriod(start);
    }
  } catch (...) {
    control.servoStop();
    throw;
  }
  control.servoStop();
}

}  // namespace adapters
