// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A force-reflecting handle of three axes, the Haply Inverse3, with the orientation of a
/// VerseGrip, through the Haply Inverse Service. Tested only against a stand-in, never on a device.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <repel/devices/clock.hpp>
#include <repel/devices/clutch.hpp>
#include <repel/devices/haply_messages.hpp>
#include <repel/devices/master_device.hpp>
#include <repel/network/elements/passivity.hpp>

namespace repel::devices {

class HaplyLink;

/// The address of the service, and limits of the device.
struct HaplyInverseOptions {
  std::string url = "ws://localhost:10001";  ///< of the service
  /// From the axes of the device (x right, y away from the operator, z up) to those of W. The
  /// default is x forward, y left, z up as seen by the operator, as for the other devices.
  Mat3 R_WD{{0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
  double force_limit = 3.0;   ///< [N] in length
  double force_slew = 600.0;  ///< [N/s] at which the force follows, in length
  /// The account of the energy at the handle; its damping is shown beside the force, within the
  /// limit.
  network::PassivityOptions guard{.most_energy = 0.1, .most_damping = 15.0};
  ClutchPolicy clutch = ClutchPolicy::always;  ///< use of its button
  int clutch_button = 0;      ///< of the grip: 0, 1, 2 for a, b, c; unused for ClutchPolicy::always
  double period = 0.001;      ///< [s] between two commands, at least
  double silent_after = 0.1;  ///< [s] a command unanswered for this long ends it
  double retry_after = 0.5;   ///< [s] before the first attempt to connect anew
  double retry_at_most = 8.0;  ///< [s] each failed attempt doubles the time to the next, to this
  double most_speed = 3.0;  ///< [m/s] a position farther from the last, or a velocity beyond it, is
                            ///< no motion of a hand
  Clock now = &steady_now;  ///< any clock that grows
};

/// Sends a force and receives a state, in turn: the service answers every command once. The reading
/// has the pose and the velocity of the handle. The force is limited, follows its target at a
/// limited rate, and is kept passive. An account of the energy exchanged between handle and network
/// adds damping, so that the network never gives more than it took.
///
/// The force is zero while the clutch is released, on a fault and at the end. These faults close
/// the connection: a malformed message; a silent, lost or flooding service; a jump or exchange of
/// the handle; a velocity that contradicts the positions. It is opened again later, with the clutch
/// released. A service without a calibrated device is a fault as well. It is asked ten times a
/// second. Not thread-safe: only the reading thread may call it.
class HaplyInverse {
 public:
  static constexpr double jump = 0.02;            ///< [m] a change of position that needs no time
  static constexpr double compared_over = 0.02;   ///< [s] of velocities and positions
  static constexpr double most_difference = 0.5;  ///< [m/s] of both
  /// of that motion, allowed difference besides: a filter lags behind a hand by some ms
  static constexpr double most_share = 0.5;

  /// Connects to the service and waits up to a second for a device.
  /// @throws SetupError if a number is out of range, no service answers or it has no device, saying
  ///   what to do; or if the driver is not built in, naming the packages
  explicit HaplyInverse(const HaplyInverseOptions& options = {});
  HaplyInverse(const HaplyInverse&) = delete;
  HaplyInverse& operator=(const HaplyInverse&) = delete;
  HaplyInverse(HaplyInverse&&) = delete;
  HaplyInverse& operator=(HaplyInverse&&) = delete;
  ~HaplyInverse();

  /// "Inverse3 ID on URL"
  [[nodiscard]] std::string_view name() const noexcept { return name_; }

  /// Sends a command when due, and waits for its answer, both for at most `wait`, limited to 1 s.
  /// Allocates.
  [[nodiscard]] Measured read(std::chrono::milliseconds wait) noexcept;

  /// Sets the force on the hand [N], in W; zero if not finite. It is part of the next command. The
  /// torques are ignored: the device has no motors for them.
  void servo_cf(double lever_torque, const Wrench& tool_force) noexcept;

  /// [N] of the last command, in W
  [[nodiscard]] Vec3 force() const noexcept { return options_.R_WD * sent_; }
  /// Of the account of the energy at the handle.
  [[nodiscard]] const network::PassivityReport& guard() const noexcept { return guard_.report(); }

 private:
  using SteadyTime = std::chrono::steady_clock::time_point;

  void connect();
  void run_until(SteadyTime end);
  void connect_anew();
  void open();
  void ask();
  [[nodiscard]] SteadyTime due() const noexcept;
  void take_until(SteadyTime end);
  void take(const std::string& message);
  [[nodiscard]] bool is_overdue() const noexcept;
  [[nodiscard]] const char* complaint(double passed) noexcept;
  [[nodiscard]] bool contradicts(double passed) noexcept;
  void press() noexcept;
  void update_force(const HaplyState& before, double passed) noexcept;
  void let_go() noexcept;
  void take_back() noexcept;
  void lose(const char* why) noexcept;
  [[nodiscard]] Measured measured() const noexcept;

  HaplyInverseOptions options_;
  std::unique_ptr<HaplyLink> link_;
  std::string name_;
  std::string id_;  // of the device getting commands; empty: none
  Clutch clutch_;
  HaplyState state_{};
  HaplyState read_{};         // the message being read
  Vec3 moved_{0, 0, 0};       // [m/s] mean of late, by the positions
  Vec3 told_{0, 0, 0};        // [m/s] likewise, by the velocities
  bool has_state_ = false;    // since the connection was opened
  bool is_known_ = false;     // the service has the name of the program
  bool is_answered_ = false;  // the last command; before any: the service has greeted
  bool is_greeted_ = false;
  bool was_up_ = false;  // the button of the clutch, since the connection was opened
  SteadyTime asked_{};   // real time of the last command, for the pace
  std::chrono::nanoseconds asked_at_{0};  // the same by the clock of the options
  std::chrono::nanoseconds heard_at_{0};  // of the last state with a device
  std::chrono::nanoseconds lost_at_{0};
  double retry_after_ = 0.0;               // [s]
  Vec3 target_{0, 0, 0};                   // [N] of the force, in axes of the device
  Vec3 slewed_{0, 0, 0};                   // [N] following it
  Vec3 damped_{0, 0, 0};                   // [N] with damping
  Vec3 force_{0, 0, 0};                    // [N] and limited: for the next command
  Vec3 sent_{0, 0, 0};                     // [N] in the last command
  Vec3 acted_{0, 0, 0};                    // [N] in the one before it: between the last two states
  network::PassivityController<6> guard_;  // the handle does not turn
  const char* why_lost_ = "";
};

static_assert(MasterDevice<HaplyInverse>);

}  // namespace repel::devices
