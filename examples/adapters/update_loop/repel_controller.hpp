// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// repel as a controller of ros2_control: a header to copy. docs/own_controller/update_loop.md
/// explains it.
#pragma once

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <controller_interface/controller_interface.hpp>
#include <hardware_interface/types/hardware_interface_type_values.hpp>
#include <rclcpp/logging.hpp>

#include <repel/base/mailbox.hpp>
#include <repel/cell/cell.hpp>

namespace adapters {

/// The value of a loaned interface, in older and newer releases.
/// @param last what is returned if it cannot be read now: once, that is within the noise of a joint
template <class Interface>
double value_of(const Interface& interface, double last) {
  if constexpr (requires { interface.get_optional(); }) {
    return interface.get_optional().value_or(last);
  } else {
    return interface.get_value();
  }
}

/// A cell of one arm whose joints take efforts. Derive from it and say what is in the cell.
class RepelController : public controller_interface::ControllerInterface {
 public:
  using Result = controller_interface::CallbackReturn;
  using State = rclcpp_lifecycle::State;

  Result on_init() override { return Result::SUCCESS; }

  /// Builds the cell, here because activation takes place in the loop of the controller manager.
  Result on_configure(const State& /*previous*/) override try {
    repel::CellDescription cell = describe();
    cell.rate_hz = get_update_rate();
    joints_.clear();
    for (const repel::ArmLink& link : cell.arms.at(0).model.links) {
      joints_.push_back(link.joint_name);
    }
    q_.resize(joints_.size());
    v_.resize(joints_.size());
    cell_ = std::make_unique<repel::Cell>(std::move(cell));
    record_ = nullptr;
    return Result::SUCCESS;
  } catch (const std::exception& e) {  // repel::SetupError says what is wrong and what is allowed
    RCLCPP_ERROR(get_node()->get_logger(), "%s", e.what());
    return Result::FAILURE;
  }

  controller_interface::InterfaceConfiguration command_interface_configuration() const override {
    return interfaces({hardware_interface::HW_IF_EFFORT});
  }
  controller_interface::InterfaceConfiguration state_interface_configuration() const override {
    return interfaces({hardware_interface::HW_IF_POSITION, hardware_interface::HW_IF_VELOCITY});
  }

  Result on_activate(const State& /*previous*/) override {
    // What requested the brakes may have left the arm anywhere: that takes a new cell.
    if (record_ != nullptr && record_->brakes) return Result::FAILURE;
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    std::fill(q_.begin(), q_.end(), unknown);
    std::fill(v_.begin(), v_.end(), unknown);
    cell_->rehearse();
    return Result::SUCCESS;
  }

  controller_interface::return_type update(const rclcpp::Time& time,
                                           const rclcpp::Duration& period) override {
    const std::size_t n = joints_.size();
    for (std::size_t i = 0; i < n; ++i) {
      q_[i] = value_of(state_interfaces_[i], q_[i]);
      v_[i] = value_of(state_interfaces_[n + i], v_[i]);
    }
    if (master_.take()) {
      command_ = {.hand = master_.newest()};
    } else {
      command_.silent_for += period.seconds();
    }
    const std::chrono::nanoseconds now(time.nanoseconds());
    record_ = &cell_->step({q_, v_}, command_, now);
    for (std::size_t i = 0; i < n; ++i) {  // one that cannot be set now keeps the last effort
      static_cast<void>(command_interfaces_[i].set_value(record_->torques[i]));
    }
    return record_->brakes ? controller_interface::return_type::ERROR
                           : controller_interface::return_type::OK;
  }

  /// The brakes take over from here.
  Result on_deactivate(const State& /*previous*/) override {
    for (auto& command : command_interfaces_) static_cast<void>(command.set_value(0.0));
    return Result::SUCCESS;
  }
  Result on_cleanup(const State& /*previous*/) override {
    record_ = nullptr;
    cell_.reset();
    return Result::SUCCESS;
  }

  /// For one other thread, a subscription or a device: what the master reports, at least every
  /// 20 ms.
  void lead(const repel::network::HandInput& hand) noexcept {
    master_.draft() = hand;
    master_.post();
  }
  /// Of the last update, for its thread; none before the first.
  [[nodiscard]] const repel::TickRecord* record() const noexcept { return record_; }

 protected:
  /// One arm, whose links have the `joint_name` of their interfaces, and the obstacles.
  [[nodiscard]] virtual repel::CellDescription describe() const = 0;

 private:
  // "joint/kind", kind by kind.
  [[nodiscard]] controller_interface::InterfaceConfiguration interfaces(
      const std::vector<std::string>& kinds) const {
    controller_interface::InterfaceConfiguration all{
        controller_interface::interface_configuration_type::INDIVIDUAL};
    for (const std::string& kind : kinds) {
      for (const std::string& joint : joints_) all.names.push_back(joint + "/" + kind);
    }
    return all;
  }

  std::vector<std::string> joints_;  // their names
  std::vector<double> q_, v_;        // [rad] or [m]
  std::unique_ptr<repel::Cell> cell_;
  repel::Mailbox<repel::network::HandInput> master_{{}};
  repel::network::Command command_{.silent_for = 1.0};  // [s] until the master reports
  const repel::TickRecord* record_ = nullptr;
};

}  // namespace adapters
