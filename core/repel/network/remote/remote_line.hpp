// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// REMOTE LINE: one end of a line whose other end is in another program.
#pragma once

#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/signals.hpp>
#include <repel/network/remote/link.hpp>

namespace repel::network {

/// The impedance of a line between two programs.
struct RemoteLineOptions {
  double impedance = 20.0;         ///< Z [N s/m], the same at both ends
  double angular_impedance = 0.5;  ///< [N m s/rad]; of a tool port
};

/// A one-port of resistance Z: what the other end of the line sent comes out of it, as far as it
/// was sent in time, and what enters is sent there (Anderson and Spong 1989; sums of waves after
/// Niemeyer and Slotine 1998). While nothing comes, it is a damper Z. It gives no more energy than
/// the other end has sent, whatever the network does; in the ledger of its own network, that energy
/// is what it is supplied with.
class RemoteLine {
 public:
  /// @param link receives before each tick; must outlive the network. A link has one end here
  /// @throws SetupError for a number out of range
  explicit RemoteLine(RemoteLink& link, const RemoteLineOptions& options = {})
      : link_(&link), options_(options) {
    checked("impedance", options.impedance, 1e-6, 1e6, "N s/m");
    checked("angular impedance", options.angular_impedance, 1e-6, 1e6, "N m s/rad");
  }

  /// Sets the size of its port, and the impedance for that space.
  void fit(Space space, int size) {
    impedance_ = LineImpedance(space, size, options_.impedance, options_.angular_impedance);
    wave_.setZero(size);
  }
  /// Once, for the link as well. @param period [s] of the network.
  void prepare(double period) {
    period_ = detail::checked_period(period);
    link_->prepare(impedance_.size(), period_);
  }

  /// Takes the wave that is due.
  void read(const Signals& signals) noexcept { wave_ = link_->play(signals.at_rest); }
  /// Resistance Z with the wave that is due.
  void equivalent(Equivalent<any_size>& shown) const noexcept {
    shown.form = Form::impedance;
    shown.matrix = impedance_.diagonal().asDiagonal();
    shown.offset = impedance_.offset_of(wave_);
  }
  /// Sends the wave that enters.
  void incident(const PortState<any_size>& state) noexcept {
    link_->send(impedance_.wave_of(state), period_);
  }
  /// [W] That came over the line.
  [[nodiscard]] double supplied() const noexcept { return wave_.squaredNorm(); }

  /// The link that it sends over.
  [[nodiscard]] const RemoteLink& link() const noexcept { return *link_; }

 private:
  RemoteLink* link_;
  RemoteLineOptions options_;
  double period_ = 1.0;  // [s]
  LineImpedance impedance_;
  Vec<any_size> wave_;  // [sqrt(W)] that comes out in this tick
};

}  // namespace repel::network
