// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A simulated arm carrying the parts held by its tool in the world model.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include <repel/cell/cell.hpp>
#include <repel/cell/layout.hpp>
#include <repel/loop/arms/held_weight.hpp>
#include <repel/network/elements/port.hpp>
#include <repel/simulated/wrapped_arm.hpp>
#include <repel/world/kinematics.hpp>

namespace repel::runs {

/// An arm with the weight of held parts at its joints, known to the controller or not. Everything
/// else is that of the arm inside. Allocates at construction only.
class LoadedArm final : public WrappedArm {
 public:
  /// @param cell of the arm @param index of the arm in it
  LoadedArm(std::unique_ptr<TorqueDrivenArm> arm, const Cell& cell, std::size_t index)
      : WrappedArm(std::move(arm)),
        cell_(cell),
        index_(index),
        gravity_W_(cell.description().arms[index].model.gravity_W),
        kinematics_(cell.description().arms[index].model),
        joints_(cell.description().arms[index].model.links.size()),
        jacobian_(Jacobian::Zero(6, static_cast<Eigen::Index>(joints_))) {}

  void set_torques(std::span<const double> torques) noexcept override {
    if (torques.size() != joints_) return inside().set_torques(torques);
    const std::span<double> q = std::span(q_).first(joints_);
    const std::span<double> pulls = std::span(pulls_).first(joints_);
    inside().read_positions(q);
    kinematics_.update(q);
    kinematics_.tool_jacobian(jacobian_);
    std::fill(pulls.begin(), pulls.end(), 0.0);
    add_held_weight(cell_.world(), cell_.layout(index_).tool, jacobian_, -gravity_W_, Masses::all,
                    pulls);
    for (std::size_t i = 0; i < joints_; ++i) pulls[i] += torques[i];
    inside().set_torques(pulls);
  }

 private:
  const Cell& cell_;
  std::size_t index_;
  Vec3 gravity_W_;  // [m/s^2]
  Kinematics kinematics_;
  std::size_t joints_;
  Jacobian jacobian_;
  std::array<double, network::most_joints> q_{};      // [rad] or [m]
  std::array<double, network::most_joints> pulls_{};  // [N m] or [N]
};

}  // namespace repel::runs
