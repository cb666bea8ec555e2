// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The model of a serial arm, and the interface of a torque-controlled arm.
///
/// Robot descriptions produce an ArmModel and physics back ends consume it, so that neither depends
/// on the other.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <repel/base/spatial.hpp>
#include <repel/base/types.hpp>

namespace repel {

/// How a link moves against the one before it: about or along its axis.
enum class JointType { revolute, prismatic };

/// One moving link and the joint that carries it. Angles [rad] for a revolute joint, [m] for a
/// prismatic one; torques [N m] or forces [N] likewise.
struct ArmLink {
  std::string name{};                    ///< of the link
  std::string joint_name{};              ///< of the joint that moves it
  JointType type = JointType::revolute;  ///< how it moves
  Pose X_PJ = Pose::Identity();          ///< [m] frame of the link at zero, in its parent link
  Vec3 axis_J{0, 0, 1};                  ///< unit, in the frame of the link
  double mass = 0.0;                     ///< [kg]
  Vec3 p_LC{0, 0, 0};                    ///< [m] centre of mass in the link
  Mat3 I_C_L = Mat3::Zero();             ///< [kg m^2] about the centre of mass, axes of the link
  double lower = 0.0;                    ///< [rad] or [m]
  double upper = 0.0;                    ///< [rad] or [m]
  double velocity_limit = 0.0;           ///< [rad/s] or [m/s]; 0: unknown
  double effort_limit = 0.0;             ///< [N m] or [N]; 0: unknown
  double viscous_friction = 0.0;         ///< [N m s/rad] or [N s/m], at the joint
  double coulomb_friction = 0.0;         ///< [N m] or [N], at the joint
  double rotor_inertia = 0.0;            ///< [kg m^2] or [kg], motor and gears seen at the joint
  double brake_torque = 0.0;             ///< [N m] or [N] its brake holds; 0: unknown
};

/// A serial chain from a fixed base. Fixed joints of the robot description are merged into the
/// parents.
struct ArmModel {
  std::string name;                 ///< in reports and messages
  Pose X_WB = Pose::Identity();     ///< [m] base in the world
  std::vector<ArmLink> links;       ///< from the base outward; one degree of freedom each
  Pose X_LT = Pose::Identity();     ///< [m] tool frame in the last link
  Vec3 gravity_W{0.0, 0.0, -9.81};  ///< [m/s^2]
};

/// State of a drive.
enum class ArmState {
  disabled,  ///< not enabled yet: no torque acts, the brakes are on
  enabled,   ///< torques act
  stopped,   ///< by `stop`, or by a watchdog timeout: no torque acts, the brakes are on until
             ///< `enable`
};

/// Contacts of a simulated arm since its reset.
struct ContactReport {
  std::int64_t steps = 0;  ///< calls of `step` in which a link penetrated an obstacle
  double deepest = 0.0;    ///< [m] greatest penetration depth, by the physics engine
};

/// A torque-controlled arm that is stepped by its owner: a simulation, a recording. All spans have
/// one entry per link, base outward. `step` may allocate if its physics engine does.
class TorqueDrivenArm {
 public:
  virtual ~TorqueDrivenArm() = default;

  /// [N m] or [N], held until the next call.
  virtual void set_torques(std::span<const double> torques) noexcept = 0;
  /// Moves the arm by `period` [s].
  virtual void step(double period) noexcept = 0;
  /// Joint positions [rad] or [m].
  virtual void read_positions(std::span<double> out) const noexcept = 0;
  /// Joint rates [rad/s] or [m/s].
  virtual void read_velocities(std::span<double> out) const noexcept = 0;

  /// From now on torques act and the brakes are off.
  virtual void enable() noexcept {}
  /// No torque acts and the brakes are on, until `enable`.
  virtual void stop() noexcept {}
  /// Brakes on or off while the arm is enabled; no torque acts while they are on.
  virtual void engage_brakes(bool /*on*/) noexcept {}
  /// Whether torques act; an arm that cannot tell is enabled.
  [[nodiscard]] virtual ArmState state() const noexcept { return ArmState::enabled; }
  /// Contacts, for an arm that simulates physical contact.
  [[nodiscard]] virtual ContactReport contact() const noexcept { return {}; }
  /// What a force sensor reads that carries the tool [N, N m]: see ArmReadings::wrench. The mean of
  /// the last `step`; empty without a sensor.
  [[nodiscard]] virtual std::optional<Wrench> read_wrench() const noexcept { return {}; }

 protected:
  TorqueDrivenArm() = default;
  TorqueDrivenArm(const TorqueDrivenArm&) = default;             ///< for the arms derived from it
  TorqueDrivenArm(TorqueDrivenArm&&) = default;                  ///< for the arms derived from it
  TorqueDrivenArm& operator=(const TorqueDrivenArm&) = default;  ///< for the arms derived from it
  TorqueDrivenArm& operator=(TorqueDrivenArm&&) = default;       ///< for the arms derived from it
};

/// What an arm reports at the start of a tick. One entry per link, base outward; a missing entry
/// counts as unreadable.
struct ArmReadings {
  std::span<const double> q;           ///< [rad] or [m]
  std::span<const double> v;           ///< [rad/s] or [m/s]
  ArmState state = ArmState::enabled;  ///< of its drive
  /// [N, N m] read by a force sensor that carries the tool: of all that pushes and pulls beyond it,
  /// on the tool, about its origin, in axes of the tool, bias and weight included. Empty without a
  /// sensor or a reading; used by the module FORCE SENSOR (network/modules/force_sensor.hpp).
  std::optional<Wrench> wrench{};
  /// The positions are those of the arm, by a reference that does not depend on its encoders: homed
  /// again, or compared with marks. A joint that was lost and came back elsewhere is believed then.
  bool homed = false;
};

}  // namespace repel
