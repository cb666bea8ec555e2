// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// PREDICTION: the motion of the arm in the next ticks, between the operator's side of a network
/// and its walls.
#pragma once

#include <repel/network/elements/two_port.hpp>

namespace repel::network {

/// What is known of the drive of the arm.
struct PredictionOptions {
  double drive_delay = 0.0;  ///< [ticks] between a torque and its effect, beyond its being held for
                             ///< one tick; 0 to 10
};

/// A series element at the same effort: the operator's side is solved for the flow that the arm
/// will have after a `horizon` h, and not for the one measured at the start of the tick. Torques
/// are held for a tick, so springs and dampers that are solved for the measured flow drive an arm
/// into oscillation where they are stiff for its mass: for one joint of inertia m unless
/// k T^2 / m / 2 < b T / m < 2. With the torques of the walls w and their damping C,
///
///     u = J G (J' f + w + e),   G = (M / h + C)^-1,   v_left = v_right + u
///
/// G is formed in the joints, where J is the identity. So the operator's side is connected to the
/// mass of the arm, discretized by an implicit rule. The walls themselves depend on the measured
/// pose and stay at the measured flow; what they will give less as the arm moves is in `given_up`.
///
/// e is what else acts on the arm: dry friction, contact that is not modelled, an effort at its
/// limit. It is the low-passed difference of M dv / T and the torques sent, so that nothing is
/// predicted for an arm that is held. Without errors the sum of T u is h v. What the sum is beyond
/// that is taken back by `leak` per tick, so that springs on the left do not drift away from the
/// arm.
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
  /// Share of the error of the summed flow that is taken back in a tick. What is taken back is seen
  /// a drive's delay later: taken back faster, it oscillates.
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
  void fit(Space space, int size) {
    in_joints_ = space == Space::joints;
    offset_.setZero(size);
    sum_.setZero(size);
  }
  /// Sets the horizon. @param period [s] of the network.
  void prepare(double period) { horizon_ = horizon(delay_) * detail::checked_period(period); }

  /// Second call of a tick, after all modules have read their signals. Cost: one factorization of
  /// the size of the joints, and its solution for the six rows of J. While M is not positive
  /// definite, nothing is predicted.
  /// @param walls [N m] torques of walls and limits on the joints @param damping [N m s/rad] theirs
  void predict(const Signals& signals, const Vec<any_size>& walls,
               const Mat<any_size>& damping) noexcept {
    const Eigen::Index n = signals.inertia.rows();
    is_known_ = n > 0 && n == walls.size();
    if (!is_known_) return;
    observe(signals);
    walls_ = walls;
    has_damping_ = false;
    for (Eigen::Index i = 0; i < n; ++i) has_damping_ = has_damping_ || damping.coeff(i, i) > 0.0;
    if (has_damping_) damping_ = damping;
    const double rate = 1.0 / horizon_;
    is_known_ = held_.factor(n, [&](Eigen::Index i) {  // M / h + C
      return rate * signals.inertia.data()[i] + damping.data()[i];
    });
    if (is_known_) move_to_port(signals);
  }

  /// What is on the right measures its flow, so that only the effort at this flow is shown. In the
  /// joints an impedance may be singular: what the tool does not feel, of seven joints or in a
  /// singular pose, is answered by no torque.
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept {
    shown = behind;
    if (!is_known_) return true;
    const bool is_impedance = shown.form == Form::impedance;
    if (is_impedance && (in_joints_ || !shown.take_form(Form::admittance))) {
      shown.add_admittance(conductance_, -(flow_ + offset_));
      shown.matrix.setZero();
      return true;
    }
    const Eigen::Index n = conductance_.rows();
    const double *own = conductance_.data(), *added = shown.matrix.data();
    dense::Factored both;
    if (!both.factor(n, [=](Eigen::Index i) { return own[i] + added[i]; })) return false;
    shown.form = Form::impedance;
    shown.matrix.setZero(n, n);
    shown.offset = flow_ + offset_ - shown.offset;
    both.solve(shown.offset);
    return true;
  }
  /// The same effort; the flow at the operator's side is that which the arm will have.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) noexcept {
    at_leaf = at_root;
    if (!is_known_) return;
    const Vec<any_size> on_arm = -at_root.effort;
    Vec<any_size> change = offset_;
    dense::add_product(conductance_, on_arm, change);
    for (Eigen::Index i = 0; i < change.size(); ++i) {
      sum_.coeffRef(i) += period_ * change.coeff(i);
      at_leaf.flow.coeffRef(i) += change.coeff(i);
    }
    if (in_joints_) {
      sent_ = on_arm;
    } else {
      dense::transposed_product(jacobian_, on_arm, sent_);
    }
    sent_ += walls_;
    if (has_damping_) sent_ -= given_up(sent_);
  }

  /// What is taken off the torques `total` on the joints, those of the walls included, because they
  /// move the arm within the horizon and its walls and limits then give less: C G total [N m].
  [[nodiscard]] Vec<any_size> given_up(const Vec<any_size>& total) const noexcept {
    if (!is_known_ || !has_damping_) return Vec<any_size>::Zero(total.size());
    Vec<any_size> moved = total;
    held_.solve(moved);
    return dense::product<Vec<any_size>>(damping_, moved);
  }

  /// Torques on the joints besides those of network and gravity, as estimated [N m].
  [[nodiscard]] const Vec<any_size>& others() const noexcept { return others_; }

 private:
  void observe(const Signals& signals) noexcept {
    if (sent_.size() != signals.rates.size() || signals.at_rest) {
      others_.setZero(signals.rates.size());
    } else {
      const Vec<any_size> change = signals.rates - last_rates_;
      const Vec<any_size> momentum = dense::product<Vec<any_size>>(signals.inertia, change);
      const double inverse = 1.0 / signals.since_last();
      for (Eigen::Index i = 0; i < others_.size(); ++i) {
        const double seen = inverse * momentum.coeff(i) - sent_.coeff(i);
        others_.coeffRef(i) += adaptation(delay_) * (seen - others_.coeff(i));
      }
    }
    last_rates_ = signals.rates;
  }

  void move_to_port(const Signals& signals) noexcept {
    flow_ = in_joints_ ? signals.rates : signals.tool_flow();
    offset_ = walls_ + others_;
    if (in_joints_) {
      held_.solve(offset_);
      invert();
    } else {
      jacobian_ = signals.jacobian;
      through_jacobian();
    }
    if (signals.at_rest) sum_ = horizon_ * flow_;
    period_ = signals.period;
    const double share = leak(delay_) / period_;
    for (Eigen::Index i = 0; i < offset_.size(); ++i) {
      offset_.coeffRef(i) += share * (horizon_ * flow_.coeff(i) - sum_.coeff(i));
    }
  }

  void invert() noexcept {
    const Eigen::Index n = held_.size();
    conductance_.resize(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      Vec<any_size> column = Vec<any_size>::Zero(n);
      column.coeffRef(k) = 1.0;
      held_.solve(column);
      for (Eigen::Index i = 0; i < n; ++i) conductance_.coeffRef(i, k) = column.coeff(i);
    }
  }

  // With W = L^-1 J' by rows of six, J G J' = W' D^-1 W, and J G w = W' D^-1 L^-1 w.
  void through_jacobian() noexcept {
    using dense::Six;
    constexpr std::ptrdiff_t six = 6;
    const int n = held_.size();
    held_.descend(offset_);
    double W[6 * most_joints];
    Six flow, columns[6];
    for (int k = 0; k < n; ++k) {
      Six row(jacobian_.data() + six * k);
      for (int j = 0; j < k; ++j) row.add(-held_.lower(k, j), Six(W + six * j));
      row.store(W + six * k);
      const Six scaled = row.times(held_.inverse(k));
      for (int j = 0; j < 6; ++j) columns[j].add(W[6 * k + j], scaled);
      flow.add(offset_.coeff(k), scaled);
    }
    conductance_.resize(6, 6);
    for (int j = 0; j < 6; ++j) columns[j].store(conductance_.data() + six * j);
    offset_.resize(6);
    flow.store(offset_.data());
  }

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
