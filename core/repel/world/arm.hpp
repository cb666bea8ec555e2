/// @file
/// A serial arm as plain numbers, and what the loop asks of a simulated or real one.
///
/// Robot descriptions produce an ArmModel and physics back ends consume it, so that neither knows
/// the other.
#pragma once

#include <concepts>
#include <span>
#include <string>
#include <vector>

#include <repel/base/types.hpp>

namespace repel {

enum class JointType { revolute, prismatic };

/// One moving link and the joint that carries it. Angles [rad] for a revolute joint, [m] for a
/// prismatic one; torques [N m] or forces [N] likewise.
struct ArmLink {
  std::string name;                      ///< of the link
  std::string joint_name;                ///< of the joint that moves it
  JointType type = JointType::revolute;  ///< how it moves
  Pose X_PJ = Pose::Identity();          ///< [m] frame of the link at zero, in its parent link
  Vec3 axis_J = Vec3::UnitZ();           ///< unit, in the frame of the link
  double mass = 0.0;                     ///< [kg]
  Vec3 p_LC = Vec3::Zero();              ///< [m] centre of mass in the link
  Mat3 I_C_L = Mat3::Zero();             ///< [kg m^2] about the centre of mass, axes of the link
  double lower = 0.0;                    ///< [rad] or [m]
  double upper = 0.0;                    ///< [rad] or [m]
  double velocity_limit = 0.0;           ///< [rad/s] or [m/s]; 0: none is known
  double effort_limit = 0.0;             ///< [N m] or [N]; 0: none is known, and none is kept
  double viscous_friction = 0.0;         ///< [N m s/rad] or [N s/m], at the joint
  double coulomb_friction = 0.0;         ///< [N m] or [N], at the joint
  double rotor_inertia = 0.0;            ///< [kg m^2] or [kg], motor and gears seen at the joint
  double brake_torque = 0.0;             ///< [N m] or [N] its brake holds; 0: none is known
};

/// A serial chain from a fixed base. Fixed joints of the source are merged into their parents.
struct ArmModel {
  std::string name;
  Pose X_WB = Pose::Identity();     ///< [m] base in the world
  std::vector<ArmLink> links;       ///< from the base outward; one degree of freedom each
  Pose X_LT = Pose::Identity();     ///< [m] tool frame in the last link
  Vec3 gravity_W{0.0, 0.0, -9.81};  ///< [m/s^2]
};

/// A simulated or real arm behind torque input. All spans have one entry per link, base outward.
/// None of these functions throws; `step` may allocate only if the engine behind it does.
template <class T>
concept TorqueDrivenArm = requires(T arm, const T& const_arm, std::span<const double> torques,
                                   std::span<double> out, double period) {
  { arm.set_torques(torques) } -> std::same_as<void>;        // [N m]
  { arm.step(period) } -> std::same_as<void>;                // [s]
  { const_arm.read_positions(out) } -> std::same_as<void>;   // [rad]
  { const_arm.read_velocities(out) } -> std::same_as<void>;  // [rad/s]
};

/// What a drive does with the torques it is sent.
enum class ArmState {
  disabled,  ///< not enabled yet: no torque acts, the brakes are on
  enabled,   ///< they act
  stopped,   ///< by `stop`, or by its watchdog: no torque acts, the brakes are on until `enable`
};

/// An arm whose drive can be enabled and stopped and whose joints have brakes. Its drive may have a
/// watchdog, which stops an arm that no torques are sent to. None of these functions throws.
template <class T>
concept BrakedArm = TorqueDrivenArm<T> && requires(T arm, const T& const_arm, bool on) {
  { arm.enable() }
  noexcept->std::same_as<void>;  // torques act, brakes off
  { arm.stop() }
  noexcept->std::same_as<void>;  // no torque, brakes on until `enable`
  { arm.engage_brakes(on) }
  noexcept->std::same_as<void>;  // while enabled; no torque while on
  { const_arm.state() }
  noexcept->std::same_as<ArmState>;
};

/// Kinematics of an arm. After `update` everything answers for those joints; nothing throws or
/// allocates. Jacobians have six rows, linear then angular, world axes, and a column per link.
template <class T>
concept ArmKinematics = requires(T kinematics, const T& const_kinematics,
                                 std::span<const double> joints, std::span<double> out, int link,
                                 const Vec3& p_WQ,
                                 Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian) {
  { kinematics.update(joints) } -> std::same_as<void>;                 // [rad]
  { const_kinematics.X_WT() } -> std::convertible_to<Pose>;            // tool frame
  { const_kinematics.tool_jacobian(jacobian) } -> std::same_as<void>;  // of the tool's origin
  { const_kinematics.X_WL(link) } -> std::convertible_to<Pose>;        // a link
  { const_kinematics.jacobian(link, p_WQ, jacobian) } -> std::same_as<void>;  // of a point on it
  { kinematics.gravity_torques(out) } -> std::same_as<void>;  // [N m] that hold it still
};

}  // namespace repel
