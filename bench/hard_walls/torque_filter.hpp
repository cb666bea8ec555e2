// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What others do to hold a whole arm off: its torques are changed before they are sent.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include <repel/cell/cell.hpp>
#include <repel/loop/arms/arm_bodies.hpp>
#include <repel/loop/barrier/barrier_rows.hpp>
#include <repel/loop/barrier/hard_contacts.hpp>
#include <repel/loop/barrier/least_constraint.hpp>
#include <repel/robots/dynamics.hpp>
#include <repel/world/kinematics.hpp>

#include "setting.hpp"

namespace repel::hard_walls {

/// Adds what a gap demands to a problem with a step of step_of(way).
///
/// Way::damper_of_arm: its rate after a period is at least -xi (d - d_s) / (d_i - d_s), from
/// d_i = 50 mm on, with d_s = 2 mm and xi = 0.5 m/s (B. Faverjon, P. Tournassoud, "A local based
/// approach for path planning of manipulators with a high number of degrees of freedom", 1987;
/// O. Kanoun, "Real-time prioritized kinematic control under inequality constraints for redundant
/// manipulators", 2011).
///
/// Way::barrier_of_arm: d'' + (a1 + a2) d' + a1 a2 (d - d_s) >= 0 with a1 = a2 = 10 / s
/// (D. Morton, M. Pavone, "Safe, task-consistent manipulation with operational space control
/// barrier functions", 2025).
void add_bound(Way way, const BarrierRow& row, LeastConstraint& problem);

/// [s] In which the torques of `way` keep what add_bound demands; of a second, a bound of a rate is
/// one of an acceleration. @param period [s]
[[nodiscard]] double step_of(Way way, double period);

/// Sends the torques within their limits that change the acceleration of an arm least and keep all
/// bounds of its gaps and joint ranges, by the masses and the friction of its model.
class TorqueFilter {
 public:
  /// @param cell at the poses of the arm, which must live as long
  TorqueFilter(Way way, Cell& cell, std::size_t arm);
  /// Changes `torques` [N m]. @param gaps of all arms at these readings
  void filter(std::span<const HardContact> gaps, const ArmReadings& readings,
              std::span<double> torques);

 private:
  Way way_;
  Cell& cell_;
  BodyId tool_;
  const ArmModel& model_;
  Kinematics kinematics_;
  Dynamics dynamics_;
  ArmBodies links_;
  BarrierRows rows_;
  LeastConstraint problem_;
  Jacobian jacobian_;
  Eigen::MatrixXd mass_;
  std::vector<double> lower_, upper_, bias_, untold_;
};

}  // namespace repel::hard_walls
