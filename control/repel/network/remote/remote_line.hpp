// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// REMOTE LINE: one end of a line between two programs.
#pragma once

#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/signals.hpp>
#include <repel/network/remote/line_bounds.hpp>
#include <repel/network/remote/link.hpp>

namespace repel::network {

/// The impedance of a line between two programs.
struct RemoteLineOptions {
  double impedance = 20.0;         ///< Z [N s/m], the same at both ends
  double angular_impedance = 0.5;  ///< [N m s/rad]; of a tool port
  LineBounds bounds{};             ///< of what passes; the same at both ends
  bool is_station = false;         ///< the robot is at the other end
};

/// A one-port of resistance Z: it outputs the waves of the other end, received in time, and sends
/// its incident ones there (Anderson and Spong 1989; sums of waves after Niemeyer and Slotine
/// 1998). Without packets it is a damper Z. Its output never exceeds the energy sent by the other
/// end, on any network; its ledger counts that energy as supplied. At the robot, speed and force
/// stay within its bounds for any waves received: see WaveLimiter.
class RemoteLine {
 public:
  /// @param link receives before each tick; must outlive the network. A link has one end here
  /// @throws SetupError for a number out of range
  explicit RemoteLine(RemoteLink& link, const RemoteLineOptions& options = {});

  /// Sets the size of its port, and the impedance for that space.
  void fit(Space space, int size);
  /// Once, for the link as well. @param period [s] of the network.
  void prepare(double period);

  /// Takes the wave due now, cut to the bounds.
  void read(const Signals& signals) noexcept;
  /// Resistance Z with the wave that is due.
  void equivalent(Equivalent<any_size>& shown) const noexcept;
  /// Sends the wave that enters.
  void incident(const PortState<any_size>& state) noexcept;
  /// [W] Received over the line.
  [[nodiscard]] double supplied() const noexcept { return wave_.squaredNorm(); }

  /// The wave received was beyond the bounds in this tick.
  [[nodiscard]] bool saturated() const noexcept { return is_cut_; }

  /// The link that it sends over.
  [[nodiscard]] const RemoteLink& link() const noexcept { return *link_; }

 private:
  RemoteLink* link_;
  RemoteLineOptions options_;
  double period_ = 1.0;  // [s]
  LineImpedance impedance_;
  WaveLimiter limiter_;
  bool is_cut_ = false;
  Vec<any_size> wave_;  // [sqrt(W)] that comes out in this tick
};

}  // namespace repel::network
