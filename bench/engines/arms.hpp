// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The engines behind a common interface, and the arms they simulate.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <repel/robots/dynamics.hpp>
#include <repel/world/kinematics.hpp>

namespace repel::engines {

constexpr double period = 2.5e-3;  ///< [s] of a step

/// A TorqueDrivenArm of any engine; the virtual call costs next to nothing compared with a step.
class SimulatedArm {
 public:
  virtual ~SimulatedArm() = default;

  /// Positions [rad] and velocities [rad/s]; at rest when `v` is empty.
  virtual void reset(std::span<const double> q, std::span<const double> v) = 0;
  virtual void set_torques(std::span<const double> torques) = 0;     ///< [N m]
  virtual void step(double duration) = 0;                            ///< [s]
  [[nodiscard]] virtual std::vector<double> positions() const = 0;   ///< [rad]
  [[nodiscard]] virtual std::vector<double> velocities() const = 0;  ///< [rad/s]
};

struct Engine {
  std::string name;
  std::unique_ptr<SimulatedArm> (*make)(const ArmModel& model, int substeps);
};

/// Those that are built, in the order of the tables; the reference is last.
[[nodiscard]] const std::vector<Engine>& engines();
[[nodiscard]] const Engine& reference();

/// A rod of 2 kg, hanging down at zero, centre of mass 0.5 m from the axis; no friction.
[[nodiscard]] ArmModel pendulum();
/// [rad/s] angular frequency of the pendulum in the limit of small swings.
[[nodiscard]] double pendulum_frequency();
/// Corke's PUMA 560 without joint stops, which the reference arm lacks, and without dry friction,
/// which makes it creep.
[[nodiscard]] ArmModel puma();
/// Armstrong's PUMA 560, without joint stops and friction, with the gravity of that paper, 9.8
/// m/s^2.
[[nodiscard]] ArmModel armstrong_puma();
/// Its first three links, under 9.81 m/s^2.
[[nodiscard]] ArmModel three_links();

/// Energy [J] of an arm, computed by KDL for every engine.
class Energy {
 public:
  explicit Energy(const ArmModel& arm);
  [[nodiscard]] double kinetic(std::span<const double> q, std::span<const double> v);
  [[nodiscard]] double potential(std::span<const double> q);

 private:
  ArmModel model_;
  Dynamics dynamics_;
  Kinematics kinematics_;
  Eigen::MatrixXd M_;
};

}  // namespace repel::engines
