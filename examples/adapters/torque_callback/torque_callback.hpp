// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// repel as the torque callback of libfranka: to copy, with franka_arm.hpp.
/// docs/own_controller/torque_callback.md explains it.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include <franka/model.h>
#include <franka/robot.h>

#include <repel/base/mailbox.hpp>
#include <repel/cell/cell.hpp>

#include "franka_arm.hpp"

namespace adapters {

/// Thrown out of the callback when the arm is to stand still; libfranka then cancels the motion.
struct Stopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One run of Robot::control. Make a new one for each: it begins at rest, without torque.
class TorqueCallback {
 public:
  /// @param model must outlive this @param state of Robot::readOnce, at rest
  /// @param cell parts of the arm and obstacles, in O; an arm without links gets the limits of the
  ///   first arm (FER)
  /// @throws repel::SetupError
  TorqueCallback(const franka::Model& model, const franka::RobotState& state,
                 repel::CellDescription cell)
      : TorqueCallback(state, computed_by(model, state, std::move(cell))) {}

  /// @param cell whose arm has links and kinematics, as `arm_of` returns it @throws as above
  TorqueCallback(const franka::RobotState& state, repel::CellDescription cell)
      : cell_(completed(std::move(cell), state)) {}

  /// For Robot::control. @throws Stopped when the brakes are requested
  franka::Torques operator()(const franka::RobotState& state, franka::Duration period) {
    if (master_.take()) {
      command_ = {.hand = master_.newest()};
    } else {
      command_.silent_for += period.toSec();
    }
    command_.sound = !finish_;  // to finish, the operator is let go and the arm brakes
    const bool moves = state.robot_mode == franka::RobotMode::kMove;
    const auto drive = moves ? repel::ArmState::enabled : repel::ArmState::stopped;
    const std::chrono::milliseconds now(state.time.toMSec());
    record_ = &cell_.step({state.q, state.dq, drive}, command_, now);
    if (record_->brakes) throw Stopped("repel stops the arm: " + repel::to_text(record_->status));
    std::array<double, 7> torques{};
    std::copy_n(record_->torques.begin(), 7, torques.begin());
    const auto stands = [](double v) { return std::abs(v) < 0.01; };  // [rad/s]
    if (finish_ && std::all_of(state.dq.begin(), state.dq.end(), stands)) {
      return franka::MotionFinished(franka::Torques(torques));
    }
    return torques;
  }

  /// For one other thread: what the master reports, at least every 20 ms.
  void lead(const repel::network::HandInput& hand) noexcept {
    master_.draft() = hand;
    master_.post();
  }
  /// For any thread: ends the motion as soon as the arm stands.
  void finish() noexcept { finish_ = true; }
  /// Of the last call, for the thread of the callback; none before the first.
  [[nodiscard]] const repel::TickRecord* record() const noexcept { return record_; }

 private:
  static repel::CellDescription computed_by(const franka::Model& model,
                                            const franka::RobotState& state,
                                            repel::CellDescription cell) {
    repel::ArmDescription& arm = cell.arms.at(0);
    if (arm.model.links.empty()) arm.model = franka_model(fer);
    arm.kinematics = std::make_unique<FrankaKinematics>(model, state);
    return cell;
  }

  static repel::CellDescription completed(repel::CellDescription cell,
                                          const franka::RobotState& state) {
    cell.rate_hz = 1000.0;
    repel::ArmDescription& arm = cell.arms.at(0);
    arm.start.assign(state.q.begin(), state.q.end());
    arm.options.has_brakes = true;
    arm.options.torques.slew_time = 1.001 * fer.torque[0] / fer.torque_rate;  // [s] FR3 likewise
    return cell;
  }

  repel::Cell cell_;
  repel::Mailbox<repel::network::HandInput> master_{{}};
  repel::network::Command command_{.silent_for = 1.0};  // [s] until the master reports
  std::atomic<bool> finish_ = false;
  const repel::TickRecord* record_ = nullptr;
};

}  // namespace adapters
