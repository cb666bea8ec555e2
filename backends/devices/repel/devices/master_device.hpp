// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The interface of the native input devices, in the terms of the collaborative robotics toolkit
/// (CRTK): operating_state, measured_cv, servo_cf.
#pragma once

#include <chrono>
#include <concepts>
#include <cstdint>
#include <string_view>

#include <repel/base/spatial.hpp>
#include <repel/base/types.hpp>

namespace repel::devices {

/// CRTK's operating state of a device.
enum class OperatingState {
  disabled,  ///< no data yet
  enabled,   ///< sending, and its motion counts
  paused,    ///< sending, but the clutch is released: rest
  fault,     ///< removed or unreliable: rest
};

/// The CRTK name of the state, in capitals.
[[nodiscard]] constexpr std::string_view to_text(OperatingState state) noexcept {
  switch (state) {
    case OperatingState::disabled:
      return "DISABLED";
    case OperatingState::enabled:
      return "ENABLED";
    case OperatingState::paused:
      return "PAUSED";
    case OperatingState::fault:
      break;
  }
  return "FAULT";
}

/// One reading. All numbers are finite; all motion is zero unless the state is enabled.
struct Measured {
  OperatingState operating_state = OperatingState::disabled;  ///< the rest holds only if enabled
  Twist measured_cv;                       ///< [m/s, rad/s] shaped, in the axes of `Shaping`
  Vec3 lever_direction_W = Vec3::UnitX();  ///< unit: direction of the tool driven by a lever
  double lever_rate = 0.0;                 ///< [rad/s] of a device with one degree of freedom
  /// Pose of a handle that measures it, in the axes of W from an origin of its own: measured_cp.
  /// Also while paused. `HandFollower` makes rates of it.
  Vec3 position_W{0, 0, 0};                                  ///< [m]
  Eigen::Quaterniond R_WH = Eigen::Quaterniond::Identity();  ///< orientation of the handle
  bool has_position = false;                                 ///< `p_WH` is measured
  bool has_orientation = false;                              ///< `R_WH` is measured
  bool clutch = false;                                       ///< engaged: the motion counts
  bool silent = false;                                       ///< sends nothing although it should
  const char* why = "no reading yet";  ///< static text, for the user; "" if all is well
  std::uint64_t count = 0;             ///< number of the reading; set by `DeviceThread`

  /// Of a device that is gone or sends nothing. @param why static text
  [[nodiscard]] static Measured of_lost(const char* why) noexcept {
    Measured m;
    m.operating_state = OperatingState::fault;
    m.silent = true;
    m.why = why;
    return m;
  }
  /// At rest, of a device that sends.
  [[nodiscard]] static Measured of_sound(bool clutch) noexcept {
    Measured m;
    m.operating_state = clutch ? OperatingState::enabled : OperatingState::paused;
    m.clutch = clutch;
    m.why = clutch ? "" : "the clutch is released";
    return m;
  }
};

/// Force feedback to the operator.
struct Felt {
  double lever_torque = 0.0;  ///< [N m] on the lever; positive towards larger angles
  Wrench tool_force;          ///< [N, N m] in W: on the hand in a network with SIX AXES, else of
                              ///< the walls on the tool, about its origin
};

/// A device read and driven by its own thread; see `DeviceThread`.
///
/// `read` blocks for at most the given time and returns the state at its end. `servo_cf` applies a
/// force, or does nothing if the device has no force feedback. Neither throws or blocks for longer.
template <class T>
concept MasterDevice = requires(T& device, const T& constant, std::chrono::milliseconds wait,
                                double lever_torque, const Wrench& tool_force) {
  { constant.name() } -> std::convertible_to<std::string_view>;
  { device.read(wait) }
  noexcept->std::same_as<Measured>;
  { device.servo_cf(lever_torque, tool_force) }
  noexcept->std::same_as<void>;
};

}  // namespace repel::devices
