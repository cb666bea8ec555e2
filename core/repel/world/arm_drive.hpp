// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The drive of a simulated arm: enabled or stopped, brakes on or off, and a watchdog.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <repel/base/setup_error.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// Whether the torques of an arm act and its brakes are on. It starts enabled, brakes off.
class ArmDrive {
 public:
  /// @param watchdog [s] timeout without torques, in the arm's own time, after which it stops; 0,
  /// inf: never
  /// @throws SetupError when it is negative or NaN
  explicit ArmDrive(double watchdog = 0.0)
      : watchdog_(checked("watchdog", watchdog, 0.0, never, "s")) {
    if (watchdog_ == 0.0) watchdog_ = never;
  }

  /// As after construction.
  void reset() noexcept { enable(); }

  /// Torques act from now on, brakes are off, and the watchdog restarts.
  void enable() noexcept {
    state_ = ArmState::enabled;
    brakes_on_ = false;
    silent_ = 0.0;
  }

  /// No torque acts and brakes are on, until `enable`.
  void stop() noexcept { state_ = ArmState::stopped; }

  /// Brakes on or off while it is enabled; otherwise they stay on.
  void engage_brakes(bool on) noexcept {
    if (state_ == ArmState::enabled) brakes_on_ = on;
  }

  /// Torques were received: restarts the watchdog.
  void heard() noexcept { silent_ = 0.0; }

  /// Starts the next `period` [s] of the arm's time. Returns true when the watchdog expires within
  /// it: the drive stops, and the last torques are to be discarded, so that it restarts without
  /// any.
  [[nodiscard]] bool advance(double period) noexcept {
    silent_ += period;
    if (!(silent_ > watchdog_ * (1.0 + rounding))) return false;
    stop();
    return true;
  }

  /// True when the brakes hold the joints; no motor torque acts then.
  [[nodiscard]] bool braked() const noexcept { return state_ != ArmState::enabled || brakes_on_; }

  [[nodiscard]] ArmState state() const noexcept { return state_; }  ///< whether torques can act

 private:
  static constexpr double never = std::numeric_limits<double>::infinity();
  static constexpr double rounding = 1e-9;  // relative, of the sum of substeps

  double watchdog_;      // [s]
  double silent_ = 0.0;  // [s] since the last torques
  ArmState state_ = ArmState::enabled;
  bool brakes_on_ = false;
};

namespace detail {

/// Greatest distance [m] of the centre of mass of link `i` from the axis of a revolute joint
/// `first`. Infinite where a prismatic joint between them has no stop.
inline double longest_lever(const ArmModel& model, std::size_t first, std::size_t i) {
  double lever = norm(model.links[i].p_LC);
  for (std::size_t k = first + 1; k <= i; ++k) {
    const ArmLink& link = model.links[k];
    lever += norm(origin(link.X_PJ));
    if (link.type == JointType::revolute) continue;
    lever += std::max(std::abs(link.lower), std::abs(link.upper));
  }
  return lever;
}

}  // namespace detail

/// The dry friction [N m] or [N] that the brake of a joint adds: ArmLink::brake_torque, or if that
/// is unknown 1.5 times the effort limit. If neither is known it is enough for the load of the
/// joint at its longest reach: twice its weight, plus what stops it from the speed limit, or from 3
/// rad/s or 1 m/s, within 0.25 s. Infinite where the reach is unbounded.
[[nodiscard]] inline double brake_torque(const ArmModel& model, int joint) {
  const auto first = static_cast<std::size_t>(joint);
  const ArmLink& braked = model.links[first];
  if (braked.brake_torque > 0.0) return braked.brake_torque;
  if (braked.effort_limit > 0.0) return 1.5 * braked.effort_limit;
  const bool turns = braked.type == JointType::revolute;
  double weight = 0.0;                    // [N m] or [N]
  double inertia = braked.rotor_inertia;  // [kg m^2] or [kg]
  for (std::size_t i = first; i < model.links.size(); ++i) {
    const ArmLink& link = model.links[i];
    if (turns) inertia += link.I_C_L.norm();
    if (!(link.mass > 0.0)) continue;  // no weight, whatever the lever
    const double lever = turns ? detail::longest_lever(model, first, i) : 1.0;
    weight += link.mass * lever * norm(model.gravity_W);
    inertia += link.mass * lever * lever;
  }
  const double usual_speed = turns ? 3.0 : 1.0;  // [rad/s] or [m/s]
  const double speed = braked.velocity_limit > 0.0 ? braked.velocity_limit : usual_speed;
  return 2.0 * weight + inertia * speed / 0.25;
}

}  // namespace repel
