/// @file
/// What every native input device looks like to the rest, in the words of the collaborative
/// robotics toolkit (CRTK): operating_state, measured_cv, servo_cf.
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
  disabled,  ///< not heard yet
  enabled,   ///< heard, and its motion counts
  paused,    ///< heard, but the clutch is open: rest
  fault,     ///< gone or not to be trusted: rest
};

/// The name CRTK gives the state, in capitals.
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

/// One reading. All numbers are finite; all motion is rest unless the state is enabled.
struct Measured {
  OperatingState operating_state = OperatingState::disabled;
  Twist measured_cv;                       ///< [m/s, rad/s] shaped, in the axes of `Shaping`
  Vec3 lever_direction_W = Vec3::UnitX();  ///< unit: the way a lever drives the tool
  double lever_rate = 0.0;                 ///< [rad/s] of a device with one degree of freedom
  bool clutch = false;                     ///< engaged: the motion counts
  bool silent = false;                     ///< not heard although it should be talking
  const char* why = "no reading yet";      ///< static text, for people; "" when all is well
  std::uint64_t count = 0;                 ///< number of the reading; `DeviceThread` sets it
};

/// What the operator is to feel.
struct Felt {
  double lever_torque = 0.0;  ///< [N m] on the lever; positive towards larger angles
  Wrench tool_force;          ///< [N, N m] on the tool, about its origin, in W
};

/// A device that a thread of its own reads and drives; see `DeviceThread`.
///
/// `read` blocks at most for the time given and returns what is true at its end. `servo_cf` shows a
/// force, or does nothing where the device cannot show one. Neither throws or waits for longer.
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
