// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Finds a drive that is dead, turned round or later than was told.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <repel/loop/arm_inertia.hpp>
#include <repel/loop/options.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// Asks of each joint by which torques its motion is explained best. Its momentum without the
/// drive,
///
///     p' = M dv/dt + B v + F sgn(v) + g - e
///
/// is what the torques have added, w' = tau, at their delay and with a gain within the uncertainty
/// of masses. e is the steady disturbance of a moving joint. The residual may be beyond the noise,
/// and one of these may have a residual several times smaller. Then the drive does not follow its
/// command, or readings are late:
///
/// - torques that are later by two ticks or more, over 20 ms;
/// - no torque, or the opposite one, from the moment at which the difference began.
///
/// A force that nobody sent, as of a person who pushes, is explained by none of them. After the
/// momentum observer of De Luca and Mattone (2003). Allocates at construction only. Cost: a few
/// operations for each delay and joint.
class DriveWatch {
 public:
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  /// @param delay [ticks] of the drive
  DriveWatch(const ArmModel& model, double delay)
      : model_(model),
        delay_(delay),
        ring_(static_cast<std::size_t>(std::ceil(delay)) + late[lates - 1] + 2),
        joints_(model.links.size()) {
    for (Vector& w : ring_) w.setZero(static_cast<Eigen::Index>(joints_.size()));
    sent_ = weight_ = ring_.front();
  }

  /// What was sent after the last reading: `net` and `weight` [N m], their sum is the torque.
  void note_sent(const Vector& net, std::span<const double> weight) noexcept {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      weight_.coeffRef(index(i)) = weight[i];
      sent_.coeffRef(index(i)) = net.coeff(index(i)) + weight[i];
    }
  }

  /// Brakes are on: no torque acts.
  void note_held() noexcept { sent_.setZero(index(joints_.size())); }

  /// Advances by a reading. @param last, v [rad/s] rates of the last reading and of this one
  /// @param M the inertia between both @param elapsed [s]
  void step(const std::vector<double>& last, const std::vector<double>& v,
            const ArmInertia::Matrix& M, double elapsed,
            const JointWatchOptions& options) noexcept {
    const double kept = 1.0 - std::min(1.0, elapsed / memory);
    advance(kept, elapsed);
    const double* row = M.data();  // M is symmetric
    strays_ = false;
    for (std::size_t i = 0; i < joints_.size(); ++i, row += v.size()) {
      Joint& joint = joints_[i];
      const ArmLink& link = model_.links[i];
      double change = 0.0;
      for (std::size_t k = 0; k < v.size(); ++k) change += row[k] * (v[k] - last[k]);
      const double mean = 0.5 * (v[i] + last[i]);
      const double clear = 0.1 * options.rate_noise;
      const double sign = std::clamp(mean / clear, -1.0, 1.0);
      const double friction = link.viscous_friction * mean + link.coulomb_friction * sign;
      const double others = change / elapsed + friction + weight_.coeff(index(i));
      if (std::abs(mean) > clear) {
        const double sent = (w(0.0, i) - kept * w(1.0, i)) / elapsed;
        joint.steady += std::min(1.0, elapsed / steadily) * (others - sent - joint.steady);
        const double added = elapsed * (others - joint.steady);
        joint.p = kept * joint.p + added;
        const double rubbed = link.coulomb_friction + 0.5 * link.viscous_friction * std::abs(mean);
        joint.noise = 0.1 * row[i] * options.rate_noise + memory * rubbed;
        compare(i, std::min(1.0, elapsed / window), options);
        follow(joint, added, elapsed * sent, w(0.0, i), elapsed, options);
      } else {
        rest(i);  // friction may hold it
      }
      strays_ = strays_ || joint.ticks >= enough;
    }
  }
  /// The next reading does not follow from the last one, or a brake held the arm.
  void begin_anew(double elapsed) noexcept {
    advance(1.0 - std::min(1.0, elapsed / memory), elapsed);
    for (std::size_t i = 0; i < joints_.size(); ++i) rest(i);
    strays_ = false;
  }

  /// Some joint does not do what its drive was told.
  [[nodiscard]] bool strays() const noexcept { return strays_; }

 private:
  static constexpr double memory = 0.02;                    // [s] of momenta
  static constexpr double window = 0.008;                   // [s] of their comparison
  static constexpr double steadily = 1.0;                   // [s]
  static constexpr double at_first = 0.06;                  // [s] in which a dead drive shows
  static constexpr double clearly = 1.0 / 12.0;             // of the energy that is left
  static constexpr double beside = 0.15;                    // of the momentum that is left
  static constexpr double friction_error = 1.25;            // of the gain
  static constexpr double opposites[3] = {0.65, 1.0, 1.5};  // gains
  static constexpr double evident = 3.0;                    // times the noise
  static constexpr std::size_t lead = 4;                    // ticks that a difference takes to show
  static constexpr int enough = 2;                          // ticks
  static constexpr std::size_t lates = 7;
  static constexpr std::size_t late[lates] = {2, 3, 4, 5, 6, 8, 12};  // [ticks]

  // [N m s] What is left of p beside any gain.
  static double left_of(double p, double w, double u) noexcept {
    return std::abs(p - std::clamp(p, std::min(w / u, w * u), std::max(w / u, w * u)));
  }

  /// Sums for the gain of torques.
  struct Fit {
    double pw = 0.0, ww = 0.0;
  };
  /// What was added since a difference began [N m s], and how far at most each assumption was off.
  struct Since {
    double time = 0.0;  // [s] 0: there is no difference
    double p = 0.0, w = 0.0;
    double told = 0.0, none = 0.0;
    double opposite[3] = {};

    void add(double added, double sent, double u) noexcept {
      p += added;
      w += sent;
      told = std::max(told, left_of(p, w, u));
      none = std::max(none, std::abs(p));
      for (std::size_t k = 0; k < 3; ++k) {
        opposite[k] = std::max(opposite[k], std::abs(p + opposites[k] * w));
      }
    }
  };
  struct Joint {
    double p = 0.0;       // [N m s]
    double steady = 0.0;  // e [N m]
    double noise = 0.0;   // [N m s]
    double pp = 0.0;
    Fit told;
    Fit later[lates];
    Since since;
    double added[lead] = {}, sent[lead] = {};  // [N m s] of the last ticks
    std::size_t oldest = 0;
    int ticks = 0;
  };

  static Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

  void advance(double kept, double elapsed) noexcept {
    const Vector& before = ring_[newest_];
    newest_ = (newest_ + 1) % ring_.size();
    ring_[newest_] = kept * before + elapsed * sent_;
  }
  [[nodiscard]] double at(std::size_t ticks, std::size_t joint) const noexcept {
    return ring_[(newest_ + ring_.size() - ticks) % ring_.size()].coeff(index(joint));
  }
  // [N m s] of torques that are later than told.
  [[nodiscard]] double w(double later, std::size_t joint) const noexcept {
    const double ticks = delay_ + later;
    const auto whole = static_cast<std::size_t>(ticks);
    const double rest = ticks - static_cast<double>(whole);
    const double a = at(whole, joint);
    return rest > 0.0 ? a + rest * (at(whole + 1, joint) - a) : a;
  }
  void rest(std::size_t i) noexcept {
    const double steady = joints_[i].steady;
    joints_[i] = {};
    joints_[i].steady = steady;
    joints_[i].p = w(0.0, i);
  }

  static double unexplained(double pp, const Fit& fit, double u) noexcept {
    const double best = fit.ww > 0.0 ? fit.pw / fit.ww : 1.0;
    const double gain = std::clamp(best, 1.0 / u, u);
    return std::max(0.0, pp - 2.0 * gain * fit.pw + gain * gain * fit.ww);
  }
  // By torques that are late.
  void compare(std::size_t i, double share, const JointWatchOptions& options) noexcept {
    Joint& joint = joints_[i];
    const auto add = [&](double& sum, double x) { sum += share * (x - sum); };
    const auto fit = [&](Fit& f, double x) {
      add(f.pw, joint.p * x);
      add(f.ww, x * x);
    };
    add(joint.pp, joint.p * joint.p);
    fit(joint.told, w(0.0, i));
    for (std::size_t k = 0; k < lates; ++k) {
      fit(joint.later[k], w(static_cast<double>(late[k]), i));
    }
    const double u = friction_error * options.mass_uncertainty;
    const double left = unexplained(joint.pp, joint.told, u);
    const double noise = joint.noise * joint.noise;
    bool is_late = false;
    for (const Fit& f : joint.later) {
      is_late = is_late || unexplained(joint.pp, f, options.mass_uncertainty) < clearly * left;
    }
    // There is a motion, and it is not explained otherwise.
    is_late = is_late && joint.pp > 4.0 * noise && left > noise;
    joint.ticks = is_late ? joint.ticks + 1 : 0;
  }

  // By no torque, or the opposite one. @param added, sent [N m s] in this tick @param w of the
  // torques as told
  static void follow(Joint& joint, double added, double sent, double w, double elapsed,
                     const JointWatchOptions& options) noexcept {
    const double u = friction_error * options.mass_uncertainty;
    const double left = left_of(joint.p, w, u);
    Since& since = joint.since;
    if (left < (since.time > 0.0 ? 0.5 : 1.0) * joint.noise) since = {};
    if (left >= joint.noise && since.time == 0.0) {
      for (std::size_t k = 0; k < lead; ++k) {
        const std::size_t at = (joint.oldest + k) % lead;
        since.add(joint.added[at], joint.sent[at], u);
      }
    }
    joint.added[joint.oldest] = added;
    joint.sent[joint.oldest] = sent;
    joint.oldest = (joint.oldest + 1) % lead;
    if (left < joint.noise && since.time == 0.0) return;
    since.time += elapsed;
    since.add(added, sent, u);
    if (since.time > at_first || since.told < evident * joint.noise) return;
    const double least =
        std::min({since.none, since.opposite[0], since.opposite[1], since.opposite[2]});
    if (least < beside * since.told) joint.ticks = std::max(joint.ticks, enough);
  }

  const ArmModel& model_;
  double delay_;              // [ticks]
  std::vector<Vector> ring_;  // w [N m s]
  std::size_t newest_ = 0;
  Vector sent_, weight_;
  std::vector<Joint> joints_;
  bool strays_ = false;
};

}  // namespace repel
