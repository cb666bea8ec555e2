// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A six-axis mouse (SpaceMouse, SpaceNavigator, Spaceball) through the socket of spacenavd.
#pragma once

#include <array>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include <repel/devices/clock.hpp>
#include <repel/devices/clutch.hpp>
#include <repel/devices/descriptor.hpp>
#include <repel/devices/master_device.hpp>
#include <repel/devices/shaping.hpp>
#include <repel/devices/spacenav_parser.hpp>

namespace repel::devices {

/// Where the daemon is, and how its counts become rates.
struct SpacenavOptions {
  /// Of the socket; empty: that of SPNAV_SOCKET, else /run/spnav.sock, then /var/run/spnav.sock.
  std::string path;
  ShapingOptions shaping;                      ///< of the counts
  ClutchPolicy clutch = ClutchPolicy::always;  ///< what its button does
  int clutch_button = 0;                       ///< from 0; unused for ClutchPolicy::always
  double stale_after = 0.5;  ///< [s] motion that is not renewed for this long counts as silence
  double retry_after = 1.0;  ///< [s] between attempts to reconnect to the daemon
  Clock now = &steady_now;   ///< any clock that grows
};

/// Reads complete events from the daemon and holds the last motion until the next.
///
/// At rest until the first event. A non-zero motion that is not renewed for `stale_after` is
/// reported as silent and at rest. If the daemon disconnects or sends invalid data, the state is
/// fault, silent and at rest; it then tries to reconnect every `retry_after`, and restarts at rest
/// with a released clutch. Not thread-safe: only the reading thread may call it.
class Spacenav {
 public:
  /// Connects to the daemon.
  /// @throws SetupError if a number is out of range or no daemon answers, saying what to do
  explicit Spacenav(const SpacenavOptions& options = {});

  /// "Spacenav on PATH"
  [[nodiscard]] std::string_view name() const noexcept { return name_; }

  /// Waits for events for at most `wait`, limited to 1 s, and returns the state at its end.
  /// Processes a bounded number of events; does not allocate.
  [[nodiscard]] Measured read(std::chrono::milliseconds wait) noexcept;

  /// Does nothing: the device has no force feedback.
  void servo_cf(double /*lever_torque*/, const Wrench& /*tool_force*/) noexcept {}

 private:
  void connect_anew() noexcept;
  void take_bytes() noexcept;
  void take(const SpacenavEvent& event) noexcept;
  void lose(const char* why) noexcept;
  [[nodiscard]] Measured measured() const noexcept;

  SpacenavOptions options_;
  Shaping shaping_;
  std::vector<std::string> paths_;  // to try, in this order
  std::string name_;
  detail::Descriptor socket_;
  SpacenavParser parser_;
  Clutch clutch_;
  Twist held_;                            // of the last motion
  std::chrono::nanoseconds heard_at_{0};  // time of the last motion event
  std::chrono::nanoseconds tried_at_{0};  // time of the last attempt to connect
  const char* why_lost_ = "";
};

static_assert(MasterDevice<Spacenav>);

}  // namespace repel::devices
