/// @file
/// Contacts of an arm as forces that are solved together with its joints.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include <repel/world/simulated_arm.hpp>

#include "contact_search.hpp"

namespace repel::bullet::detail {

/// A point of contact is a spring K and a damper C along the way out of the obstacle, taken
/// implicitly. With x the depth, J the row that makes the speed at which the bodies part of v, and
/// v' = v + h a after a sub-step of h seconds:
///
///     f = K (x - h J v') - C J v' >= 0,   that is   J v' + f / (C + h K) = K x / (C + h K)
///
/// and C along two directions across it, with a force of at most the friction's share of f. Both
/// terms are linear in a, so no stiffness makes a sub-step unstable.
class Contacts {
 public:
  /// @throws SetupError as ContactSearch
  Contacts(const ArmModel& model, const SimulationOptions& options,
           std::span<const ContactPart> parts);

  /// Finds the points of contact at `q` [rad] or [m].
  void find(const Eigen::VectorXd& q) noexcept;

  /// Begins a sub-step of `h` [s] from `v` without forces, where the joints answer a torque by
  /// `W` = (M + D)^-1.
  void begin(const Eigen::MatrixXd& W, const Eigen::VectorXd& v, double h) noexcept;

  /// Corrects every force once, one after the other, and `a` with them. Returns the largest change
  /// of a speed [m/s].
  double sweep(Eigen::VectorXd& a) noexcept;

  /// Ends a step: counts it if one of its sub-steps had a contact.
  void end_step() noexcept;

  /// Nothing was touched yet.
  void forget() noexcept;

  [[nodiscard]] ContactReport report() const noexcept { return report_; }

 private:
  /// One direction of one point.
  struct Row {
    double speed = 0.0;     // [m/s] J v
    double target = 0.0;    // [m/s] K x / (C + h K); 0 across
    double softness = 0.0;  // [m/(N s)] 1 / (C + h K); 1 / C across
    double gain = 0.0;      // [m/(N s)] h J W J^T
    double force = 0.0;     // [N]
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
  std::vector<Row> rows_;         // three for each touch: out, and two across
  Eigen::MatrixXd J_, response_;  // a column for each row: J^T and W J^T
  double h_ = 0.0;
  ContactReport report_;
  bool touching_ = false;  // in this step
};

}  // namespace repel::bullet::detail
