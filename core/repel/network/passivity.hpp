/// @file
/// Passivity observer and controller for an element that is not passive by itself.
#pragma once

#include <algorithm>
#include <cmath>

#include <repel/network/ledger.hpp>
#include <repel/network/port.hpp>

namespace repel::network {

struct PassivityOptions {
  double most_energy = 5.0;  ///< [J] the element may be owed at once; what it dissipated in a long
                             ///< contact beyond that cannot be given back later
  double most_damping = 300.0;  ///< [N s/m] injected against energy from sampling; the rest is
                                ///< carried over
  double lever = 0.1;           ///< [m] at which damping acts on a rotation
};

/// Keeps two accounts of a nonlinear element whose flow is measured (Hannaford and Ryu 2002).
///
/// The account of the port, E += T f.v, never falls below zero: where the effort of a tick would
/// give more than there is, it is damped along its flow just so far that the rest is spent. Because
/// E was not negative before, what is missing is at most T |f.v|, and the correction never turns
/// the effort round.
///
/// The account of the sampled motion pairs the effort held through a period with the motion of that
/// period, E_s += T f(k-1).(mean flow), and knows of it a tick too late. There damping is limited,
/// never resists the way out, and what it leaves is carried over. Damping is held for a period as
/// well: where it is too much for what moves, or that swings too fast, it drives instead. So where
/// it gave more than it took in the last ten ticks its limit is halved, and where it took some the
/// limit grows again.
template <int N>
class PassivityController {
 public:
  /// @param weight of each direction in the damping: ones, and lever^2 for rotations
  explicit PassivityController(const PassivityOptions& options, const Vec<N>& weight)
      : options_(options),
        weight_(weight),
        held_(Vec<N>::Zero(weight.size())),
        damped_(held_),
        most_damping_(options.most_damping) {}

  /// Forgets what is stored, as for an element that begins anew; never what is owed.
  void reset() noexcept {
    energy_ = 0.0;
    sampled_ = std::min(sampled_, 0.0);
    held_.setZero();
    damped_.setZero();
  }

  /// The damping by which `effort` has to be corrected: add it times weight times `flow`.
  /// @param effort into the element; `flow` of this tick; `mean_flow` of the period that ended with
  ///        it; `period` [s]; `supplied` [W] to the element otherwise than over its port;
  ///        `elapsed` [s] since the step before, 0: one period. All finite.
  [[nodiscard]] double step(const Vec<N>& effort, const Vec<N>& flow, const Vec<N>& mean_flow,
                            double period, double supplied = 0.0, double elapsed = 0.0) noexcept {
    sampled_ += (elapsed > 0.0 ? elapsed : period) * (held_.dot(mean_flow) + supplied);
    energy_ = std::max(0.0, energy_ + period * supplied);
    limit_damping(damped_.dot(mean_flow));
    const double square = flow.cwiseProduct(weight_).dot(flow);
    const double power = effort.dot(flow);
    double damping = 0.0;
    if (square > 1e-200) {
      const double missing = -(energy_ / period + power) / square;
      const double sampled = -(sampled_ / period + power) / square;
      // On the way out the element may be kept from pushing and must not begin to pull; nor may it
      // where it has let go.
      const double most = power > 0.0 ? most_damping_ : std::min(most_damping_, -power / square);
      damping = std::max({0.0, missing, std::min(sampled, most)});
    }
    report_.dissipated += period * damping * square;
    energy_ = std::clamp(energy_ + period * (power + damping * square), 0.0, options_.most_energy);
    sampled_ = std::min(sampled_, options_.most_energy);
    damped_ = damping * weight_.cwiseProduct(flow);
    held_ = effort + damped_;
    if (held_.isZero(0.0)) reset();
    report_.owed = std::max(0.0, -sampled_);
    return damping;
  }

  [[nodiscard]] const Vec<N>& weight() const noexcept { return weight_; }
  [[nodiscard]] const PassivityReport& report() const noexcept { return report_; }

 private:
  void limit_damping(double taken) noexcept {
    taken_ = 0.9 * taken_ + taken;
    if (taken > 0.0) most_damping_ = std::min(options_.most_damping, 1.05 * most_damping_);
    if (taken_ >= 0.0) return;
    most_damping_ = std::max(1e-3 * options_.most_damping, 0.5 * most_damping_);
    taken_ = 0.0;
  }

  PassivityOptions options_;
  Vec<N> weight_;
  Vec<N> held_;    // effort of the last tick
  Vec<N> damped_;  // part of it that is damping
  double most_damping_;
  double taken_ = 0.0;    // [W] by damping, of the last ten ticks
  double energy_ = 0.0;   // [J] of the port, never negative
  double sampled_ = 0.0;  // [J] of the sampled motion
  PassivityReport report_;
};

}  // namespace repel::network
