/// @file
/// Passivity observer and controller for an element that is not passive by itself.
#pragma once

#include <algorithm>
#include <cmath>

#include <repel/network/ledger.hpp>
#include <repel/network/port.hpp>

namespace repel::network {

struct PassivityOptions {
  double most_energy = 5.0;  ///< [J] cap on the stored energy of the element; what it dissipated in
                             ///< a long contact beyond this cannot be returned later
  double most_damping = 300.0;  ///< [N s/m] limit of the damping against energy from sampling; the
                                ///< rest is carried over
  double lever = 0.1;           ///< [m] lever arm of the damping of rotations
};

/// Keeps two energy accounts of a nonlinear element whose flow is measured (Hannaford and Ryu
/// 2002).
///
/// The port energy, E += T f.v, never becomes negative: where the effort of a tick would generate
/// energy, it is damped along its flow just enough to leave E at zero. Because E was not negative
/// before, the deficit is at most T |f.v|, and the correction never reverses the effort.
///
/// The sampled energy E_s += T f(k-1).(mean flow) pairs the effort held through a period with the
/// motion of that period, and is known one tick late. Its damping is limited, never resists
/// retreat, and the remaining deficit is carried over. Damping is held for a period as well: if it
/// is too high for the moving mass, or the motion oscillates too fast, it generates energy instead.
/// So its limit is halved when it generated energy over the last ten ticks, and grows again while
/// it dissipates.
template <int N>
class PassivityController {
 public:
  /// @param weight of each direction in the damping: 1, and lever^2 for rotations
  explicit PassivityController(const PassivityOptions& options, const Vec<N>& weight)
      : options_(options),
        weight_(weight),
        held_(Vec<N>::Zero(weight.size())),
        damped_(held_),
        most_damping_(options.most_damping) {}

  /// Clears the stored energy, as for a new element; keeps the energy owed.
  void reset() noexcept {
    energy_ = 0.0;
    sampled_ = std::min(sampled_, 0.0);
    held_.setZero();
    damped_.setZero();
  }

  /// Returns the damping that corrects `effort`: add it times weight times `flow`.
  /// @param effort into the element; `flow` of this tick; `mean_flow` of the period that ended with
  /// it; `period` [s]; `supplied` [W] to the element other than through its port; `elapsed` [s]
  /// since the last step, 0: one period. All finite.
  [[nodiscard]] double step(const Vec<N>& effort, const Vec<N>& flow, const Vec<N>& mean_flow,
                            double period, double supplied = 0.0, double elapsed = 0.0) noexcept {
    sampled_ += (elapsed > 0.0 ? elapsed : period) * (held_.dot(mean_flow) + supplied);
    energy_ = std::max(0.0, energy_ + period * supplied);
    limit_damping(damped_.dot(mean_flow));
    const double square = product(flow, weight_).dot(flow);
    const double power = effort.dot(flow);
    double damping = 0.0;
    if (square > 1e-200) {
      const double missing = -(energy_ / period + power) / square;
      const double sampled = -(sampled_ / period + power) / square;
      // On retreat the damping may cancel the push of the element but not turn it into a pull; nor
      // may it create a pull where the element exerts no effort.
      const double most = power > 0.0 ? most_damping_ : std::min(most_damping_, -power / square);
      damping = std::max({0.0, missing, std::min(sampled, most)});
    }
    report_.dissipated += period * damping * square;
    energy_ = std::clamp(energy_ + period * (power + damping * square), 0.0, options_.most_energy);
    sampled_ = std::min(sampled_, options_.most_energy);
    for (Eigen::Index i = 0; i < flow.size(); ++i) {
      damped_.coeffRef(i) = damping * (weight_.coeff(i) * flow.coeff(i));
      held_.coeffRef(i) = effort.coeff(i) + damped_.coeff(i);
    }
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
  double taken_ = 0.0;    // [W] by damping, leaky sum over about ten ticks
  double energy_ = 0.0;   // [J] port energy, never negative
  double sampled_ = 0.0;  // [J] sampled energy
  PassivityReport report_;
};

}  // namespace repel::network
