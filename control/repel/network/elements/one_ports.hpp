// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The linear one-ports: damper, spring, mass, sources; bilinear (trapezoidal) rule.
///
/// Each has a constant port resistance, so that its reflected wave depends on the past only, and an
/// exact energy balance: sum T f.v = E - E0 + dissipated energy, in every tick and for any input.
#pragma once

#include <repel/base/setup_error.hpp>
#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/signals.hpp>

namespace repel::network {

namespace detail {
/// Throws SetupError unless `gain` is square, symmetric and positive definite.
template <int N>
const Mat<N>& checked_gain(const char* name, const Mat<N>& gain) {
  const bool square = gain.rows() == gain.cols() && gain.rows() > 0;
  if (!square || !gain.allFinite() || !gain.isApprox(gain.transpose(), 1e-12) ||
      Eigen::LLT<Mat<N>>(gain).info() != Eigen::Success) {
    throw SetupError(std::string(name) + " must be symmetric and positive definite");
  }
  return gain;
}
}  // namespace detail

/// f = D v. It reflects nothing.
template <int N>
class Damper {
 public:
  /// @param D [N s/m], [N m s/rad] symmetric positive definite; else SetupError
  explicit Damper(const Mat<N>& D) : R_(detail::checked_gain<N>("damping", D)) {}
  [[nodiscard]] int size() const noexcept {
    return static_cast<int>(R_.rows());
  }  ///< number of entries of its port
  /// Port resistance R = D.
  [[nodiscard]] const Mat<N>& resistance() const noexcept { return R_; }
  [[nodiscard]] Vec<N> reflected() const noexcept { return Vec<N>::Zero(R_.rows()); }  ///< nothing
  /// Absorbs the wave.
  void incident(const Vec<N>& /*a*/) noexcept {}
  [[nodiscard]] double stored() const noexcept { return 0.0; }  ///< [J]

 private:
  Mat<N> R_;
};

/// f = K integral of v. R = K T / 2; it reflects the last incident wave.
template <int N>
class Spring {
 public:
  /// @param K [N/m], [N m/rad] symmetric positive definite; else SetupError
  explicit Spring(const Mat<N>& K)
      : K_(detail::checked_gain<N>("stiffness", K)), R_(K), last_(Vec<N>::Zero(K.rows())) {}
  /// Sets R = K T / 2. @param period T [s].
  void prepare(double period) { R_ = 0.5 * detail::checked_period(period) * K_; }
  /// Discharges the spring when the operator's force has been removed (`at_rest`).
  void read(const Signals& signals) noexcept {
    if (signals.at_rest) last_.setZero();
  }
  [[nodiscard]] int size() const noexcept {
    return static_cast<int>(R_.rows());
  }  ///< number of entries of its port
  /// Port resistance R = K T / 2.
  [[nodiscard]] const Mat<N>& resistance() const noexcept { return R_; }
  /// The last incident wave.
  [[nodiscard]] const Vec<N>& reflected() const noexcept { return last_; }
  /// Takes the wave that arrives.
  void incident(const Vec<N>& a) noexcept { last_ = a; }
  /// Stored energy a' K^-1 a / 2 [J]: the wave a is the force at the end of the tick.
  [[nodiscard]] double stored() const noexcept {
    return 0.5 * last_.dot(Eigen::LLT<Mat<N>>(K_).solve(last_));
  }

 private:
  Mat<N> K_;
  Mat<N> R_;
  Vec<N> last_;
};

/// f = M dv/dt. R = 2 M / T; it reflects minus the last incident wave.
template <int N>
class Mass {
 public:
  /// @param M [kg], [kg m^2] symmetric positive definite; else SetupError
  explicit Mass(const Mat<N>& M)
      : M_(detail::checked_gain<N>("mass", M)), R_(M), last_(Vec<N>::Zero(M.rows())) {}
  /// Sets R = 2 M / T. @param period T [s].
  void prepare(double period) {
    period_ = detail::checked_period(period);
    R_ = 2.0 / period * M_;
  }
  /// Stops the mass when the operator's force has been removed (`at_rest`).
  void read(const Signals& signals) noexcept {
    if (signals.at_rest) last_.setZero();
  }
  [[nodiscard]] int size() const noexcept {
    return static_cast<int>(R_.rows());
  }  ///< number of entries of its port
  /// Port resistance R = 2 M / T.
  [[nodiscard]] const Mat<N>& resistance() const noexcept { return R_; }
  /// Minus the last incident wave.
  [[nodiscard]] Vec<N> reflected() const noexcept { return -last_; }
  /// Takes the wave that arrives.
  void incident(const Vec<N>& a) noexcept { last_ = a; }
  /// Stored energy [J]: the wave is 2 M v / T at the end of the tick.
  [[nodiscard]] double stored() const noexcept {
    return 0.125 * period_ * period_ * last_.dot(Eigen::LLT<Mat<N>>(M_).solve(last_));
  }

 private:
  Mat<N> M_;
  Mat<N> R_;
  Vec<N> last_;
  double period_ = 1.0;  // [s]
};

/// An ideal effort source: f = -e, whatever the flow; e acts on the rest of the network. Not
/// passive.
template <int N>
class EffortSource {
 public:
  static constexpr Traits traits{.passive = false};  ///< its energy is not from the network

  /// @param effort [N], [N m] until `set` gives another.
  explicit EffortSource(const Vec<N>& effort) : effort_(effort) {}
  /// Number of entries of its port.
  [[nodiscard]] int size() const noexcept { return static_cast<int>(effort_.size()); }
  void set(const Vec<N>& effort) noexcept { effort_ = effort; }  ///< [N], [N m] of this tick
  /// The effort, whatever the flow.
  void equivalent(Equivalent<N>& shown) const noexcept {
    shown.form = Form::impedance;
    shown.matrix.setZero(effort_.size(), effort_.size());
    shown.offset = -effort_;
  }

 private:
  Vec<N> effort_;
};

/// An ideal flow source, whatever the effort. Also feeds a measured motion into a network. Not
/// passive.
template <int N>
class FlowSource {
 public:
  static constexpr Traits traits{.passive = false};  ///< its energy is not from the network

  /// @param flow [m/s], [rad/s] until `set` gives another.
  explicit FlowSource(const Vec<N>& flow) : flow_(flow) {}
  /// Number of entries of its port.
  [[nodiscard]] int size() const noexcept { return static_cast<int>(flow_.size()); }
  void set(const Vec<N>& flow) noexcept { flow_ = flow; }  ///< [m/s], [rad/s] of this tick
  /// The flow, whatever the effort.
  void equivalent(Equivalent<N>& shown) const noexcept {
    shown.form = Form::admittance;
    shown.matrix.setZero(flow_.size(), flow_.size());
    shown.offset = flow_;
  }

 private:
  Vec<N> flow_;
};

/// The fixed frame: v = 0, whatever the effort. No power passes.
class Ground {
 public:
  /// @param size number of entries of its port, 1 to `most_joints`; 6 at the tool @throws
  /// SetupError
  explicit Ground(int size = 6)
      : size_(static_cast<int>(checked("size", size, 1, most_joints, ""))) {}
  [[nodiscard]] int size() const noexcept { return size_; }  ///< number of entries of its port
  /// No flow, whatever the effort.
  void equivalent(Equivalent<any_size>& shown) const noexcept;

 private:
  int size_;
};

}  // namespace repel::network
