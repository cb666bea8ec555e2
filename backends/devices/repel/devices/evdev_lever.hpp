/// @file
/// A motorised lever or steering wheel under /dev/input as TORQUE ARM: one angle in, one torque
/// out. Tested against a stand-in for the kernel only, never on a device.
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

struct EvdevLeverOptions {
  int axis = ABS_X;                   ///< of linux/input-event-codes.h
  double full_range = 4.7;            ///< [rad] between the two ends the kernel states
  Vec3 direction_W = Vec3::UnitX();   ///< the way a larger angle drives the tool; made unit
  double rate_time_constant = 0.02;   ///< [s] of the low pass on the rate
  double max_rate = 20.0;             ///< [rad/s]
  double torque_at_full_level = 2.0;  ///< [N m] of the motor at the largest level
  double gain = 1.0;                  ///< share of its strength the device may use, FF_GAIN
  bool reverse_torque = false;        ///< for a device that pushes the other way
  ClutchPolicy clutch = ClutchPolicy::always;
  int clutch_button = BTN_TRIGGER;  ///< key code; without meaning for ClutchPolicy::always
  Clock now = &steady_now;          ///< the one the kernel stamps by, CLOCK_MONOTONIC
};

/// Reads the angle of an axis and its rate, and holds one constant-force effect whose level follows
/// the torque. The level is zero at first, while the clutch is released, on a fault and at the end,
/// when the effect is erased; the kernel erases it when the program dies.
///
/// A lever at rest says nothing, so that silence cannot be told from rest: only a device that is
/// gone is silent. It stays so: what is plugged in next may be another device.
class EvdevLever {
 public:
  /// @param path /dev/input/eventN
  /// @throws SetupError when it cannot be opened or has no such axis or no constant force, and for
  ///   a number out of range
  explicit EvdevLever(const std::string& path, const EvdevLeverOptions& options = {});
  /// The same for a port that is open; `name` is for people.
  EvdevLever(std::unique_ptr<EvdevPort> port, const std::string& name,
             const EvdevLeverOptions& options = {});
  EvdevLever(const EvdevLever&) = delete;
  EvdevLever& operator=(const EvdevLever&) = delete;
  EvdevLever(EvdevLever&&) = delete;
  EvdevLever& operator=(EvdevLever&&) = delete;
  ~EvdevLever();

  /// "Lever on PATH"
  [[nodiscard]] std::string_view name() const noexcept { return name_; }

  /// Waits for events for at most `wait`, and a second, and says what holds then. Takes a bounded
  /// number of events; does not allocate.
  [[nodiscard]] Measured read(std::chrono::milliseconds wait) noexcept;

  /// Sets the torque of the motor [N m], positive towards larger angles, cut to what the level can
  /// say; zero when it is not finite. One system call when the level changes, none when not.
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
  std::int32_t counts_ = 0;   // of the axis, when the report that is coming in is whole
  bool clutch_down_ = false;  // as counts_
  bool dropped_ = false;      // events are missing: nothing counts until the report is over
  bool lost_ = false;
  const char* why_lost_ = "";
};

static_assert(MasterDevice<EvdevLever>);

}  // namespace repel::devices
