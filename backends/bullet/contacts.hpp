// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Contact forces of an arm, solved together with its joints.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include <repel/base/spatial.hpp>
#include <repel/simulated/simulated_arm.hpp>

#include "contact_search.hpp"

namespace repel::bullet::detail {

/// A contact point is a spring K and a damper C along the outward normal of the obstacle,
/// integrated implicitly. With x the penetration depth, J the row that maps v to the separation
/// speed, and v' = v + h a after a sub-step of h seconds:
///
///     f = K (x - h J v') - C J v' >= 0,   that is   J v' + f / (C + h K) = K x / (C + h K)
///
/// and a damper C along two tangential directions, with a force bounded by friction coefficient
/// times f. Both terms are linear in a, so no stiffness makes a sub-step unstable.
class Contacts {
 public:
  /// @param tally gets depths and forces; it must outlive this object
  /// @throws SetupError as ContactSearch
  Contacts(const ArmModel& model, const SimulationOptions& options,
           std::span<const ContactPart> parts, ContactTally& tally);

  /// Finds the contact points at `q` [rad] or [m].
  void find(const Eigen::VectorXd& q) noexcept;

  /// Starts a sub-step of `h` [s] from velocity `v` with zero contact forces.
  /// @param W response of the joints to a torque, (M + D)^-1
  void begin(const Eigen::MatrixXd& W, const Eigen::VectorXd& v, double h) noexcept;

  /// One Gauss-Seidel sweep over all forces, which also updates `a`. Returns the largest change of
  /// a speed [m/s].
  double sweep(Eigen::VectorXd& a) noexcept;

  /// Adds up the forces on the last link, once they are solved in a sub-step.
  void note_forces() noexcept;

  /// Ends all contacts.
  void forget() noexcept;

 private:
  /// One direction of one contact point.
  struct Row {
    Vec3 direction_W{0, 0, 0};  // unit, of the force on the link
    double speed = 0.0;         // [m/s] J v
    double target = 0.0;        // [m/s] K x / (C + h K); 0 for tangential rows
    double softness = 0.0;      // [m/(N s)] 1 / (C + h K); 1 / C for tangential rows
    double gain = 0.0;          // [m/(N s)] h J W J^T
    double force = 0.0;         // [N]
  };

  void place_links(const Eigen::VectorXd& q) noexcept;
  void set_row(int row, int link, const Vec3& p_W, const Vec3& direction_W) noexcept;
  double correct(int row, double least, double most, Eigen::VectorXd& a) noexcept;

  ArmModel model_;
  SimulationOptions options_;
  ContactSearch search_;
  std::vector<Pose> X_WL_;
  std::vector<Vec3> axis_W_;
  std::span<const Touch> touches_;
  std::vector<Row> rows_;         // three for each contact point: normal, and two tangential
  Eigen::MatrixXd J_, response_;  // a column for each row: J^T and W J^T
  double h_ = 0.0;
  ContactTally& tally_;
};

}  // namespace repel::bullet::detail
