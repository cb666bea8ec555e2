// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A motorised lever or steering wheel under /dev/input as TORQUE ARM: one angle in, one torque
/// out. Tested only against a simulated kernel interface, never on a device.
#pragma once

#include <linux/input.h>

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include <repel/devices/clock.hpp>
#include <repel/devices/clutch.hpp>
#include <repel/devices/evdev_parser.hpp>
#include <repel/devices/evdev_port.hpp>
#include <repel/devices/lever_motion.hpp>
#include <repel/devices/master_device.hpp>

namespace repel::devices {

/// Which axis is the lever, and its scales.
struct EvdevLeverOptions {
  int axis = ABS_X;         ///< as in linux/input-event-codes.h
  double full_range = 4.7;  ///< [rad] between the two ends of the axis that the kernel reports
  Vec3 direction_W = Vec3::UnitX();   ///< in which a larger angle drives the tool; normalised
  double rate_time_constant = 0.02;   ///< [s] of the low-pass filter on the rate
  double max_rate = 20.0;             ///< [rad/s]
  double torque_at_full_level = 2.0;  ///< [N m] of the motor at the largest effect level
  double gain = 1.0;                  ///< fraction of its strength that the device may use, FF_GAIN
  bool reverse_torque = false;        ///< for a device with inverted torque
  ClutchPolicy clutch = ClutchPolicy::always;  ///< what its button does
  int clutch_button = BTN_TRIGGER;             ///< key code; unused for ClutchPolicy::always
  Clock now = &steady_now;  ///< the clock of the kernel's time stamps, CLOCK_MONOTONIC
};

/// Reads the angle of an axis and its rate, and plays one constant-force effect whose level follows
/// the torque. The level is zero at first, while the clutch is released, on a fault and at the end,
/// when the effect is erased; the kernel erases it if the process dies.
///
/// A lever at rest sends no events, so silence cannot be told from rest: only a device that has
/// been removed is reported silent. It stays so, since another device may be plugged in next.
class EvdevLever {
 public:
  /// @param path /dev/input/eventN
  /// @throws SetupError if it cannot be opened, has no such axis or no constant force, or a number
  ///   is out of range
  explicit EvdevLever(const std::string& path, const EvdevLeverOptions& options = {});
  /// The same for an open port; `name` is the display name.
  EvdevLever(std::unique_ptr<EvdevPort> port, const std::string& name,
             const EvdevLeverOptions& options = {});
  EvdevLever(const EvdevLever&) = delete;
  EvdevLever& operator=(const EvdevLever&) = delete;
  EvdevLever(EvdevLever&&) = delete;
  EvdevLever& operator=(EvdevLever&&) = delete;
  ~EvdevLever();

  /// "Lever on PATH"
  [[nodiscard]] std::string_view name() const noexcept { return name_; }

  /// Waits for events for at most `wait`, limited to 1 s, and returns the state at its end.
  /// Processes a bounded number of events; does not allocate.
  [[nodiscard]] Measured read(std::chrono::milliseconds wait) noexcept;

  /// Sets the torque of the motor [N m], positive towards larger angles, saturated at the largest
  /// level; zero if not finite. One system call if the level changes, else none.
  void servo_cf(double lever_torque, const Wrench& tool_force) noexcept;

  /// [rad] 0 in the middle of the range
  [[nodiscard]] double angle() const noexcept { return motion_.angle(); }

 private:
  void take_bytes() noexcept;
  void take(const EvdevEvent& event) noexcept;
  void read_state() noexcept;
  void set_level(int level) noexcept;
  void tell(int code, int value) noexcept;
  void lose(const char* why) noexcept;

  EvdevLeverOptions options_;
  std::unique_ptr<EvdevPort> port_;
  std::string name_;
  LeverMotion motion_;
  EvdevParser parser_;
  Clutch clutch_;
  ff_effect effect_{};
  std::int32_t counts_ = 0;   // of the axis, in the report being received
  bool clutch_down_ = false;  // likewise
  bool dropped_ = false;      // events were lost: ignore all until the end of the report
  bool lost_ = false;
  const char* why_lost_ = "";
};

static_assert(MasterDevice<EvdevLever>);

}  // namespace repel::devices
