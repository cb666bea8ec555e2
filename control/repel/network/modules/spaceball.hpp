// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// SPACEBALL: a six-degree-of-freedom rate source without force feedback.
#pragma once

#include <repel/base/field.hpp>
#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/signals.hpp>

namespace repel::network {

/// How rates are shaped.
struct SpaceballOptions {
  double dead_band = 0.002;         ///< [m/s] smaller rates count as zero
  double saturation = 0.25;         ///< [m/s]
  double angular_dead_band = 0.01;  ///< [rad/s]
  double angular_saturation = 1.0;  ///< [rad/s]
  double time_constant = 0.05;      ///< [s] of the low pass; 0 for none

  /// Calls visit(Field, x) for each number.
  template <class Visit, class Options>
  static constexpr void for_each_field(const Visit& visit, Options& o) {
    visit(Field{"dead_band", "m/s", 0.0, 10.0}, o.dead_band);
    visit(Field{"saturation", "m/s", 0.0, 10.0}, o.saturation);
    visit(Field{"angular_dead_band", "rad/s", 0.0, 100.0}, o.angular_dead_band);
    visit(Field{"angular_saturation", "rad/s", 0.0, 100.0}, o.angular_saturation);
    visit(Field{"time_constant", "s", 0.0, 100.0}, o.time_constant);
  }
};

/// Adds the rates of the ball to the flow from the left: v_right = v_left + v_ball at the same
/// effort. Dead band and saturation act on the length of the vector and keep its direction; a
/// first-order low pass follows.
///
/// It reflects no effort to the operator: it is an energy source, with unbounded energy out of its
/// ports. Its traits say `passive` all the same: that is a claim about the ledger, with the
/// supplied power F.v_ball counted. It returns no more than it absorbed and was supplied.
class Spaceball {
 public:
  /// A tool on both sides.
  static constexpr Traits traits{.left = Space::tool, .right = Space::tool};

  /// @throws SetupError for a number out of range
  explicit Spaceball(const SpaceballOptions& options = {});

  /// @param period [s] of the network.
  void prepare(double period) { period_ = detail::checked_period(period); }
  /// On which side the robot is.
  void face(Side root) noexcept { sign_ = root == Side::right ? 1.0 : -1.0; }

  /// Takes the rates of the hand, shaped.
  void read(const Signals& signals) noexcept;

  /// What is behind, and the rates in addition. Always true.
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept;
  /// The same effort; the flow without the rates.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) noexcept;

  [[nodiscard]] const Twist& twist() const noexcept { return twist_; }  ///< [m/s, rad/s]
  [[nodiscard]] double supplied() const noexcept { return supplied_; }  ///< [W] by the operator
  /// A rate was clamped in this tick.
  [[nodiscard]] bool saturated() const noexcept { return saturated_; }

 private:
  [[nodiscard]] Vec3 shaped(const Vec3& v, double dead_band, double most) noexcept;

  SpaceballOptions options_;
  double period_ = 1.0;  // [s]
  double sign_ = 1.0;
  Twist twist_;
  double supplied_ = 0.0;
  bool saturated_ = false;
};

}  // namespace repel::network
