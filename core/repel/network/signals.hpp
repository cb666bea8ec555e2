/// @file
/// What a network reads from outside in one tick.
#pragma once

#include <repel/network/port.hpp>

namespace repel::network {

/// Six rows, linear then angular, world axes; a column for each joint. In storage of fixed size.
using Jacobian = Eigen::Matrix<double, 6, any_size, Eigen::ColMajor, 6, most_joints>;

/// What the operator's hands do in one tick.
struct HandInput {
  Twist ball;                        ///< [m/s, rad/s] raw rates of the force ball, world axes
  double lever_rate = 0.0;           ///< [rad/s] at which the hand leads the lever
  Vec3 direction_W = Vec3::UnitX();  ///< unit, world axes: the way the lever drives the tool
};

/// The state of arm, world and hands at the beginning of a tick. All numbers are finite: the loop
/// keeps the last sound ones where an input fails.
struct Signals {
  Vec<any_size> joints;          ///< q [rad], [m]
  Vec<any_size> rates;           ///< [rad/s], [m/s] the measured flow
  Vec<any_size> mean_rates;      ///< [rad/s], [m/s] (q - last q) / elapsed
  Jacobian jacobian;             ///< of the tool
  Pose X_WT = Pose::Identity();  ///< [m]
  Wrench walls;               ///< [N, N m] of the world model on the tool, about its origin, in W
  Vec<any_size> arm_torques;  ///< [N m], [N] of the world model on the links, sum of J^T F
  double walls_power = 0.0;   ///< [W] given to the tool by what moves in the world model
  double arm_power = 0.0;     ///< [W] and to the links
  HandInput hand;
  double period = 0.0025;  ///< [s]
  double elapsed = 0.0;    ///< [s] since the tick before, more where ticks are missing; 0: a period
  bool at_rest = false;    ///< the operator is let go: memories of his side begin anew
  bool released = false;   ///< nothing can be trusted: those of the walls begin anew, too

  /// [s] since the tick before.
  [[nodiscard]] double since_last() const noexcept { return elapsed > 0.0 ? elapsed : period; }
  /// Twist of the tool, J rates, and that of the last period, J mean_rates.
  [[nodiscard]] Vec<any_size> tool_flow() const noexcept { return jacobian.lazyProduct(rates); }
  [[nodiscard]] Vec<any_size> mean_tool_flow() const noexcept {
    return jacobian.lazyProduct(mean_rates);
  }
};

}  // namespace repel::network
