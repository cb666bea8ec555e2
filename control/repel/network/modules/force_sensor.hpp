// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// FORCE SENSOR: a measured force, in a loop at the joints to make an arm lighter.
#pragma once

#include <cstdint>

#include <repel/base/field.hpp>
#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/signals.hpp>

namespace repel::network {

/// Gain, filter and ranges of a ForceSensor.
struct ForceSensorOptions {
  static constexpr double most_gain = 0.7;  ///< greatest g
  double gain = 0.5;                        ///< g, 0 to `most_gain`
  double cutoff = 5.0;                      ///< [Hz] of the low pass, first order; 0: none
  double force_range = 200.0;   ///< [N] a reading is clipped to it along each axis of the tool
  double torque_range = 20.0;   ///< [N m] likewise
  double tare = 0.0;            ///< [s] standing still, at the start, of which the mean reading is
                                ///< the bias; 0: no bias
  double mass = 0.0;            ///< [kg] of the tool beyond the sensor
  Vec3 p_TC{0, 0, 0};           ///< [m] its centre of mass in the tool frame
  Vec3 gravity_W{0, 0, -9.81};  ///< [m/s^2]

  /// Calls visit(Field, x) for each number along one axis.
  template <class Visit, class Options>
  static constexpr void for_each_field(const Visit& visit, Options& o) {
    visit(Field{"gain", "", 0.0, most_gain}, o.gain);
    visit(Field{"cutoff", "Hz", 0.0, 1e5}, o.cutoff);
    visit(Field{"force_range", "N", 1e-3, 1e6}, o.force_range);
    visit(Field{"torque_range", "N m", 1e-3, 1e6}, o.torque_range);
    visit(Field{"tare", "s", 0.0, 100.0}, o.tare);
    visit(Field{"mass", "kg", 0.0, 1e3}, o.mass);
  }
};

/// A two-port of the joints that measures the contact force on the tool:
///
///     tau_right = tau_left + g (tau_left + J^T F)
///
/// with F the wrench of the environment on the tool: the reading without bias and weight, after a
/// low pass. A contact acts on the arm by itself, so that
///
///     M a = tau_right + J^T F - friction,   M / (1 + g) a = tau_left + J^T F - friction / (1 + g)
///
/// The network moves an arm of 1 / (1 + g) times the inertia and friction, and is pushed by a
/// contact just once, as by a virtual wall. Nothing is added to the force at the operator. It must
/// be the last module before the robot.
///
/// Unsound readings (missing, not finite, or more than `beyond` times the range) are not used: g
/// falls to zero in `fall` with the last force, stays there until readings were sound for `hold`,
/// and returns in `rise`. Likewise while the operator's force is removed.
///
/// It is an amplifier. Its traits say `passive` as those of SPACEBALL do: its ledger counts the
/// supplied power g (tau_left + J^T F) . v.
class ForceSensor {
 public:
  static constexpr double most_gain = ForceSensorOptions::most_gain;  ///< greatest g
  static constexpr double fall = 0.05;          ///< [s] in which g falls to zero
  static constexpr double hold = 0.25;          ///< [s] of sound readings before it returns
  static constexpr double rise = 0.5;           ///< [s] in which it returns
  static constexpr double beyond = 10.0;        ///< [ranges] a greater reading is not believed
  static constexpr double still = 0.01;         ///< [m/s] below which the tool stands still
  static constexpr double angular_still = 0.1;  ///< [rad/s] likewise

  /// @throws SetupError for a number out of range
  explicit ForceSensor(const ForceSensorOptions& options = {});

  /// For the planner; they tell by how much the arm gets lighter.
  [[nodiscard]] Traits traits() const noexcept;

  /// For an arm of `size` joints.
  void fit(Space /*space*/, int size) { torque_.setZero(size); }
  /// @param period [s] of the network.
  void prepare(double period);

  /// Takes a reading, and updates the wrench of this tick.
  void read(const Signals& signals) noexcept;

  /// What is behind, 1 + g times, and the torques of the contact. Always true.
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept;
  /// The same rates; the effort before it was amplified.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) noexcept;

  /// g in this tick, 0 where there is no sound reading.
  [[nodiscard]] double gain() const noexcept { return share_ * options_.gain; }
  /// Of the environment on the tool, about its origin, world axes [N, N m].
  [[nodiscard]] const Wrench& force() const noexcept { return force_W_; }
  [[nodiscard]] const Wrench& bias() const noexcept { return bias_; }  ///< [N, N m] in tool axes
  /// The bias is known, or there is none.
  [[nodiscard]] bool is_tared() const noexcept { return tared_for_ >= options_.tare; }
  [[nodiscard]] bool is_lost() const noexcept { return is_lost_; }  ///< no sound reading
  /// The reading was clipped in this tick.
  [[nodiscard]] bool saturated() const noexcept { return is_saturated_; }
  /// With a clipped reading, since set-up.
  [[nodiscard]] std::int64_t saturated_ticks() const noexcept { return saturated_ticks_; }
  /// Without a sound reading, since set-up.
  [[nodiscard]] std::int64_t lost_ticks() const noexcept { return lost_ticks_; }
  [[nodiscard]] double peak_force() const noexcept { return peak_; }    ///< [N] since set-up
  [[nodiscard]] double supplied() const noexcept { return supplied_; }  ///< [W]

 private:
  // Clips the reading. False when it cannot be used.
  [[nodiscard]] bool take(const Signals& signals) noexcept;
  [[nodiscard]] static Vec3 clipped(const Vec3& all, double most) noexcept;

  // Takes weight and bias off the reading; until the bias is known, adds to it.
  void weigh(const Signals& signals) noexcept;
  void tare(const Signals& signals) noexcept;

  void fade(bool may_act, double elapsed) noexcept;

  void follow() noexcept;

  // A known bias stays: the present contact is not part of it.
  void forget() noexcept;

  ForceSensorOptions options_;
  double follows_ = 1.0;  // share of a reading taken over by the low pass in a tick
  double share_ = 0.0;    // of the gain
  double sound_for_ = 0.0;
  bool has_tripped_ = false;
  Wrench reading_;          // clipped, without weight and bias; tool axes, as the next four
  Wrench force_;            // after the low pass
  Wrench bias_;             // [N, N m]
  Wrench sum_;              // of readings while taring
  Wrench force_W_;          // `force_` in world axes
  int count_ = 0;           // of those
  double tared_for_ = 0.0;  // [s]
  Vec<any_size> torque_;    // g J^T F [N m]
  double supplied_ = 0.0;   // [W]
  double peak_ = 0.0;       // [N]
  bool is_lost_ = false, is_saturated_ = false;
  std::int64_t saturated_ticks_ = 0, lost_ticks_ = 0;
};

}  // namespace repel::network
