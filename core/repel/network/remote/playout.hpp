// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// When to output what another machine sent: a buffer against jitter and loss, by two clocks that
/// drift.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <repel/base/setup_error.hpp>

namespace repel::network {

/// How long what arrives is kept back.
struct PlayoutOptions {
  /// [s] of what was sent kept back beyond the least delay seen; negative: 1.25 times the longest
  /// time that the newest packet had to last in the last seconds, from one period to `most`
  double buffer = -1.0;
  double most = 0.2;  ///< [s]
};

/// The moment, by the clock of the sender, whose waves are output now: now, less the least delay
/// seen in the last seconds, less a buffer. Only differences of delays are used: the clocks need
/// not agree. The moment never goes back; where delays change, or the clocks drift apart, it goes
/// faster or slower for a while instead of jumping, so that jitter that is no multiple of a period
/// is spread evenly.
class Playout {
 public:
  static constexpr double window = 2.0;    ///< [s] delays are remembered for one to two of these
  static constexpr double change = 0.05;   ///< greatest change of the rate,
  static constexpr double starving = 0.5;  ///< and where the next packet has not come in time
  static constexpr double most_off = 1.0;  ///< [s] farther off, the moment jumps

  /// @param period [s] of the receiver. @throws SetupError for a number out of range
  explicit Playout(double period = 0.0025, const PlayoutOptions& options = {})
      : options_(options), period_(period) {
    checked("buffer", options.buffer, -1.0, 10.0, "s");
    checked("largest buffer", options.most, 0.0, 10.0, "s");
  }

  /// Forgets all delays.
  void begin() noexcept {
    older_ = recent_ = {};
    has_begun_ = false;
  }

  /// A packet arrived that is newer than all others.
  /// @param sent [s] by the clock of the sender @param before [s] when the newest one before was
  /// sent; `sent` for the first @param now [s] by the clock of the receiver
  void arrive(double sent, double before, double now) noexcept {
    newest_ = sent;
    recent_.least = std::min(recent_.least, now - sent);
    recent_.longest = std::max(recent_.longest, now - before);
  }

  /// The moment to be output at `now` [s], which must not decrease; before the first packet 0.
  double advance(double now) noexcept {
    const double least = std::min(older_.least, recent_.least);
    const double longest = std::max(older_.longest, recent_.longest);
    if (!(least < unknown)) return moment_;
    buffer_ = options_.buffer;
    if (buffer_ < 0.0) {
      const double wanted = 1.25 * (longest - least);
      buffer_ = std::max(period_, std::min(wanted, options_.most));
    }
    const double aim = now - least - buffer_;
    const double elapsed = now - last_;
    const double off = aim - (moment_ + elapsed);
    // What is off by less than a period is left alone: when a packet arrives is known no better.
    const double by = off - std::clamp(off, -period_, period_);
    if (has_begun_ && std::abs(off) < most_off) {
      moment_ += elapsed + std::clamp(by, -(moment_ > newest_ ? starving : change) * elapsed,
                                      change * elapsed);
    } else {
      moment_ = aim;
      since_ = now;
    }
    has_begun_ = true;
    last_ = now;
    // What is known is kept for as long as nothing arrives.
    if (now - since_ > window && recent_.least < unknown) {
      since_ = now;
      older_ = recent_;
      recent_ = {};
    }
    return moment_;
  }

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
