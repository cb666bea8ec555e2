// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A simulated arm whose controller takes joint positions, as those of industrial arms do.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <repel/cell/admittance.hpp>
#include <repel/loop/arms/arm_inertia.hpp>
#include <repel/network/plan.hpp>
#include <repel/simulated/wrapped_arm.hpp>
#include <repel/world/kinematics.hpp>

namespace repel::runs {

/// Torques of the network become positions through the admittance of the arm. They reach the
/// controller of the arm after a dead time, 0.4 of the response; that drives the arm by torques,
///
///     tau = M (w^2 (q_d - q) - 2 w v) + g + F tanh(v_d / 0.01)
///
/// critically damped and as slow as the rest of the response, w = 2 / (0.6 response), with F the
/// dry friction. Between two commands it goes on at the commanded rate v_d. Everything else is that
/// of the arm inside. Allocates at construction only.
class ServoedArm final : public WrappedArm {
 public:
  /// @param model of the arm, which its controller knows
  /// @param shown the model as its admittance shows it: see `admitted`
  /// @param response [s] at least 0.01 @param period [s] of the tick
  ServoedArm(std::unique_ptr<TorqueDrivenArm> arm, ArmModel model, const ArmModel& shown,
             double response, double period)
      : WrappedArm(std::move(arm)),
        model_(std::move(model)),
        kinematics_(model_),
        inertia_(model_),
        end_(shown, response, period),
        dead_time_(0.4 * response),
        stiffness_rate_(2.0 / (0.6 * response)),
        period_(period),
        joints_(model_.links.size()) {
    for (std::size_t i = 0; i < joints_; ++i) {
      efforts_[i] = effort_bound(model_, i);
      friction_[i] = model_.links[i].coulomb_friction;
    }
    read();
    commands_.fill({q_, {}, 0.0});
  }

  void set_torques(std::span<const double> torques) noexcept override {
    read();
    end_.step({std::span(q_).first(joints_), std::span(v_).first(joints_), inside().state()},
              torques, brakes_on_);
    newest_ = (newest_ + 1) % commands_.size();
    Command& command = commands_[newest_];
    std::copy(end_.positions().begin(), end_.positions().end(), command.q.begin());
    std::copy(end_.rates().begin(), end_.rates().end(), command.v.begin());
    command.issued = time_;
  }
  void step(double period) noexcept override {
    const int steps = std::max(1, static_cast<int>(std::ceil(period * stiffness_rate_ / 0.25)));
    for (int i = 0; i < steps; ++i) {
      const double part = period / steps;
      drive();
      inside().step(part);
      time_ += part;
    }
  }
  void engage_brakes(bool on) noexcept override {
    brakes_on_ = on;
    inside().engage_brakes(on);
  }

 private:
  static constexpr double creeping = 0.01;  // [rad/s] or [m/s]
  using Joints = std::array<double, network::most_joints>;
  struct Command {
    Joints q{}, v{};
    double issued = 0.0;  // [s]
  };

  void read() noexcept {
    inside().read_positions(std::span(q_).first(joints_));
    inside().read_velocities(std::span(v_).first(joints_));
  }

  /// The last command that has arrived.
  [[nodiscard]] const Command& arrived() const noexcept {
    const std::size_t all = commands_.size();
    for (std::size_t age = 0; age < all; ++age) {
      const Command& command = commands_[(newest_ + all - age) % all];
      if (command.issued <= time_ - dead_time_) return command;
    }
    return commands_[(newest_ + 1) % all];
  }

  void drive() noexcept {
    read();
    const Command& command = arrived();
    const double since = std::clamp(time_ - dead_time_ - command.issued, 0.0, 2.0 * period_);
    std::array<double, network::most_joints> acceleration{};
    const double w = stiffness_rate_;
    for (std::size_t i = 0; i < joints_; ++i) {
      const double wanted = command.q[i] + since * command.v[i];
      acceleration[i] = w * w * (wanted - q_[i]) - 2.0 * w * v_[i];
    }
    const std::span<double> torques = std::span(torques_).first(joints_);
    kinematics_.update(std::span(q_).first(joints_));
    kinematics_.gravity_torques(torques);
    (void)inertia_.update(kinematics_);
    for (std::size_t i = 0; i < joints_; ++i) {
      for (std::size_t k = 0; k < joints_; ++k) {
        torques[i] +=
            inertia_.matrix().coeff(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) *
            acceleration[k];
      }
      torques[i] += friction_[i] * std::tanh(command.v[i] / creeping);
      torques[i] = std::clamp(torques[i], -efforts_[i], efforts_[i]);
    }
    inside().set_torques(torques);
  }

  ArmModel model_;
  Kinematics kinematics_;
  ArmInertia inertia_;
  JointAdmittance end_;
  double dead_time_;       // [s]
  double stiffness_rate_;  // w [1/s]
  double period_;          // [s]
  std::size_t joints_;
  Joints q_{}, v_{}, torques_{}, efforts_{}, friction_{};
  std::array<Command, 128> commands_{};  // a ring
  std::size_t newest_ = 0;
  double time_ = 0.0;  // [s]
  bool brakes_on_ = false;
};

}  // namespace repel::runs
