/// @file
/// A six-axis mouse through the socket of spacenavd: SpaceMouse, SpaceNavigator, Spaceball.
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

struct SpacenavOptions {
  /// Of the socket; empty: what SPNAV_SOCKET says, or /run/spnav.sock, then /var/run/spnav.sock.
  std::string path;
  ShapingOptions shaping;
  ClutchPolicy clutch = ClutchPolicy::always;
  int clutch_button = 0;     ///< from 0; without meaning for ClutchPolicy::always
  double stale_after = 0.5;  ///< [s] motion that is not renewed for so long is silence
  double retry_after = 1.0;  ///< [s] between attempts to find a daemon that went away
  Clock now = &steady_now;
};

/// Reads the daemon's events, whole ones only, and holds the last motion until the next.
///
/// Rest until the first event. A motion that is not rest and not renewed for `stale_after` is
/// silence, and rest. When the daemon goes away or talks nonsense, the state is fault, silent, and
/// rest; from then on it looks for the daemon every `retry_after`, and begins again at rest and
/// with a released clutch when it is back. The only thread that may call it is the one that reads.
class Spacenav {
 public:
  /// Connects.
  /// @throws SetupError for a number out of range, and where no daemon answers, with what to do
  explicit Spacenav(const SpacenavOptions& options = {});

  /// "Spacenav on PATH"
  [[nodiscard]] std::string_view name() const noexcept { return name_; }

  /// Waits for events for at most `wait`, and a second, and says what holds then. Takes a bounded
  /// number of events; does not allocate.
  [[nodiscard]] Measured read(std::chrono::milliseconds wait) noexcept;

  /// Nothing: the device cannot show force.
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
  std::chrono::nanoseconds heard_at_{0};  // the last motion
  std::chrono::nanoseconds tried_at_{0};  // the last attempt to connect
  const char* why_lost_ = "";
};

static_assert(MasterDevice<Spacenav>);

}  // namespace repel::devices
