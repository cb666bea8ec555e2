// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Stand-in for a controller manager with its hardware: three rails along x, y and z, 4 kg on each,
/// with brakes that are off while a controller is active. Time is simulated.
#pragma once

#include <array>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include <controller_interface/controller_interface.hpp>

namespace stand_in {

class Gantry {
 public:
  using Callback = controller_interface::CallbackReturn;

  explicit Gantry(controller_interface::ControllerInterface& controller, unsigned int rate = 1000)
      : controller_(controller), period_(1'000'000'000 / rate) {
    controller_.set_update_rate(rate);
  }

  bool configure() {
    return controller_.on_init() == Callback::SUCCESS &&
           controller_.on_configure({}) == Callback::SUCCESS;
  }
  bool cleanup() { return controller_.on_cleanup({}) == Callback::SUCCESS; }

  bool activate() {
    std::vector<hardware_interface::LoanedCommandInterface> commands;
    std::vector<hardware_interface::LoanedStateInterface> states;
    for (const auto& name : controller_.command_interface_configuration().names) {
      commands.emplace_back(handle(name));
    }
    for (const auto& name : controller_.state_interface_configuration().names) {
      states.emplace_back(handle(name));
    }
    controller_.assign_interfaces(std::move(commands), std::move(states));
    is_active_ = controller_.on_activate({}) == Callback::SUCCESS;
    if (!is_active_) controller_.release_interfaces();
    return is_active_;
  }

  void deactivate() {
    controller_.on_deactivate({});
    controller_.release_interfaces();
    is_active_ = false;
  }

  /// One cycle of the loop: read, update, write. A controller in ERROR is deactivated.
  /// @param late periods by which the cycle comes late; meanwhile the last efforts act
  void cycle(int late = 0) {
    for (int i = 0; i <= late; ++i) move();
    reported_ = is_true_ ? q : reported_;
    if (!is_active_) return;
    const auto result =
        controller_.update(rclcpp::Time(now_.count()), rclcpp::Duration((1 + late) * period_));
    if (result != controller_interface::return_type::OK) deactivate();
  }
  void cycles(int number) {
    for (int i = 0; i < number; ++i) cycle();
  }

  bool is_active() const { return is_active_; }
  /// From now on the hardware reports `positions` whatever it does; or the truth again.
  void report(std::array<double, 3> positions) { reported_ = positions, is_true_ = false; }
  void report_truth() { is_true_ = true; }

  std::array<double, 3> q{}, v{}, effort{};  // [m], [m/s], [N]
  bool is_locked = false;                    // interfaces can be neither read nor set

 private:
  hardware_interface::Handle handle(const std::string& name) {
    const auto joint = static_cast<std::size_t>(name.at(0) - 'x');  // "x/effort"
    const std::string kind = name.substr(2);
    double* value = kind == "effort"     ? &effort.at(joint)
                    : kind == "velocity" ? &v.at(joint)
                                         : &reported_.at(joint);
    return {name, value, &is_locked};
  }

  void move() {
    now_ += period_;
    const double dt = 1e-9 * static_cast<double>(period_.count());
    for (std::size_t i = 0; i < 3; ++i) {
      const double weight = i == 2 ? 4.0 * 9.81 : 0.0;
      v[i] += dt / 4.0 * (effort[i] - 300.0 * v[i] - weight);
      if (!is_active_) v[i] = 0.0;
      q[i] += dt * v[i];
    }
  }

  controller_interface::ControllerInterface& controller_;
  std::chrono::nanoseconds period_;
  std::chrono::nanoseconds now_{0};
  std::array<double, 3> reported_{};
  bool is_true_ = true;
  bool is_active_ = false;
};

}  // namespace stand_in
