// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The moment of output of received waves: a buffer against jitter and loss, with two drifting
/// clocks.
#pragma once

#include <limits>

namespace repel::network {

/// The buffer time.
struct PlayoutOptions {
  /// [s] of buffer beyond the least delay seen; negative: 1.25 times the longest wait for the next
  /// packet in the last seconds, from one period to `most`
  double buffer = -1.0;
  double most = 0.2;  ///< [s]
};

/// The moment of output, by the clock of the sender: now, less the least delay seen in the last
/// seconds, less a buffer. Only differences of delays are used: the clocks need not agree. The
/// moment never goes back. If delays change, or the clocks drift apart, it runs faster or slower
/// for a while instead of jumping. So jitter of fractions of a period is spread evenly.
class Playout {
 public:
  static constexpr double window = 2.0;    ///< [s] delays are remembered for one to two of these
  static constexpr double change = 0.05;   ///< greatest change of the rate,
  static constexpr double starving = 0.5;  ///< and where the next packet has not come in time
  static constexpr double most_off = 1.0;  ///< [s] farther off, the moment jumps

  /// @param period [s] of the receiver. @throws SetupError for a number out of range
  explicit Playout(double period = 0.0025, const PlayoutOptions& options = {});

  /// Forgets all delays.
  void begin() noexcept;

  /// A new packet arrived, newer than all others.
  /// @param sent [s] by the clock of the sender @param before [s] when the newest one before was
  /// sent; `sent` for the first @param now [s] by the clock of the receiver
  void arrive(double sent, double before, double now) noexcept;

  /// The moment to be output at `now` [s], which must not decrease; before the first packet 0.
  double advance(double now) noexcept;

  [[nodiscard]] double buffer() const noexcept { return buffer_; }  ///< [s]

 private:
  static constexpr double unknown = std::numeric_limits<double>::infinity();
  struct Delays {
    double least = unknown;     ///< [s] of a packet
    double longest = -unknown;  ///< [s] until the next one arrived
  };

  PlayoutOptions options_;
  double period_;  // [s]
  Delays older_, recent_;
  bool has_begun_ = false;
  double since_ = 0.0;   // [s] when the recent delays began
  double last_ = 0.0;    // [s]
  double moment_ = 0.0;  // [s] by the clock of the sender
  double newest_ = 0.0;  // [s] likewise
  double buffer_ = 0.0;  // [s]
};

}  // namespace repel::network
