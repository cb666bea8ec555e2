// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// PREDICTION: the motion of the arm in the next ticks, between the operator's side of a network
/// and its walls.
#pragma once

#include <repel/base/setup_error.hpp>
#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/signals.hpp>

namespace repel::network {

/// The drive of the arm.
struct PredictionOptions {
  double drive_delay = 0.0;  ///< [ticks] between a torque and its effect, beyond its being held for
                             ///< one tick; 0 to 10
};

/// A series element at the same effort: the operator's side is solved for the predicted flow after
/// a `horizon` h, not for the one measured at the start of the tick. Torques are held for a tick,
/// so springs and dampers solved for the measured flow oscillate if they are stiff for the mass:
/// for one joint of inertia m unless k T^2 / m / 2 < b T / m < 2. With the torques of the walls w
/// and their damping C,
///
///     u = J G (J' f + w + e),   G = (M / h + C)^-1,   v_left = v_right + u
///
/// G is formed in the joints, where J is the identity. So the operator's side is connected to the
/// mass of the arm, discretized by an implicit rule. The walls themselves depend on the measured
/// pose and stay at the measured flow; their predicted loss by the motion is in `given_up`.
///
/// e is the disturbance: dry friction, unmodelled contact, an effort at its limit. It is the
/// low-passed difference of M dv / T and the torques sent, so a held arm has no predicted motion.
/// Without errors the sum of T u is h v. Its excess is taken back by `leak` per tick, so that
/// springs on the left do not drift away from the arm.
///
/// Stability for one joint, by the eigenvalues of the closed loop: with h = 1.5 T no spring and
/// damper on the left can make it oscillate while M is 0.3 to 2.5 times the true mass; with a drive
/// delayed by d = 1 or 2 ticks and h = (1.5 + 2.5 d) T the same holds for 0.3 to 1.7. So it does
/// with walls of stiffness K whose damping is at least (0.5 + 2 d) K T
/// (tests/network/machinery/prediction_test.cpp).
class Prediction {
 public:
  /// A mass: it takes energy and gives it back, to the walls as well.
  static constexpr Traits traits{.passive = false};
  /// Longest delay of a drive [ticks].
  static constexpr double longest_delay = 100.0;
  /// Share of the error of the summed flow taken back in a tick. The effect shows a drive delay
  /// later: a faster return oscillates.
  [[nodiscard]] static constexpr double leak(double drive_delay) noexcept {
    return drive_delay > 2.0 ? 0.2 / drive_delay : 0.1;
  }
  /// Share by which e follows in a tick.
  [[nodiscard]] static constexpr double adaptation(double drive_delay) noexcept {
    return drive_delay > 2.0 ? 0.02 / drive_delay : 0.01;
  }

  /// @throws SetupError for a delay out of range
  explicit Prediction(const PredictionOptions& options = {})
      : delay_(checked("drive delay", options.drive_delay, 0.0, longest_delay, "ticks")) {}

  /// h / T for a drive with a delay of so many ticks.
  [[nodiscard]] static constexpr double horizon(double drive_delay) noexcept {
    return 1.5 + 2.5 * drive_delay;
  }

  /// For an arm of `size` joints, or the tool.
  void fit(Space space, int size);
  /// Sets the horizon. @param period [s] of the network.
  void prepare(double period) { horizon_ = horizon(delay_) * detail::checked_period(period); }

  /// Second call of a tick, after all modules have read their signals. Cost: one factorization of
  /// the size of the joints, and its solution for the six rows of J. While M is not positive
  /// definite, nothing is predicted.
  /// @param walls [N m] torques of walls and limits on the joints @param damping [N m s/rad] theirs
  void predict(const Signals& signals, const Vec<any_size>& walls,
               const Mat<any_size>& damping) noexcept;

  /// The right side measures its flow, so only the effort at this flow is shown. In the joints an
  /// impedance may be singular: null-space motion, of seven joints or in a singular pose, meets no
  /// torque.
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept;
  /// The same effort; the flow at the operator's side is the predicted one.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) noexcept;

  /// [rad/s] By how much the torques `total` [N m] on the joints, those of the walls included,
  /// change the rates within the horizon: G total.
  [[nodiscard]] Vec<any_size> foreseen(const Vec<any_size>& total) const noexcept;
  /// [N m] Loss of the torques of walls and limits by a change of the rates `change` [rad/s]: C
  /// change.
  [[nodiscard]] Vec<any_size> given_up(const Vec<any_size>& change) const noexcept;

  /// Torques on the joints besides those of network and gravity, as estimated [N m].
  [[nodiscard]] const Vec<any_size>& others() const noexcept { return others_; }

 private:
  void observe(const Signals& signals) noexcept;

  void move_to_port(const Signals& signals) noexcept;

  void invert() noexcept;

  // With W = L^-1 J' by rows of six, J G J' = W' D^-1 W, and J G w = W' D^-1 L^-1 w.
  void through_jacobian() noexcept;

  double delay_;          // [ticks]
  double horizon_ = 0.0;  // h [s]
  double period_ = 1.0;   // [s]
  bool in_joints_ = false;
  bool is_known_ = false;
  bool has_damping_ = false;  // some wall or limit pushes
  Jacobian jacobian_;
  Vec<any_size> walls_;        // w
  Mat<any_size> damping_;      // C
  dense::Factored held_;       // G^-1, in the joints
  Mat<any_size> conductance_;  // J G J'
  Vec<any_size> offset_;       // J G (w + e), and the correction
  Vec<any_size> flow_;         // measured
  Vec<any_size> sum_;          // of T u
  Vec<any_size> others_;       // e
  Vec<any_size> last_rates_, sent_;
};

}  // namespace repel::network
