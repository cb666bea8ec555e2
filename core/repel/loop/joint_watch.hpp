// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Plausibility check of joint readings, and prediction of the motion while they fail it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/base/status.hpp>
#include <repel/loop/arm_inertia.hpp>
#include <repel/loop/drive_watch.hpp>
#include <repel/loop/motion_account.hpp>
#include <repel/loop/options.hpp>
#include <repel/loop/rate_check.hpp>
#include <repel/loop/sent_torques.hpp>
#include <repel/loop/still_joint.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// Compares every reading with the last one, with the torques sent in between and with the inertia
/// of the arm, joint by joint:
///
/// - positions and rates are finite, rates below twice the speed limit;
/// - positions and rates tell of the same motion (RateCheck);
/// - a rate grows no faster than the full effort of the joint, and the coupling from other joints,
///   can accelerate it: M_ii |dv_i| <= T (|tau_i - g_i| + effort_i) + sum |M_ik dv_k|. Speed may be
///   lost at once, by an impact;
/// - a joint that moves, or is driven by more than its friction can hold, does not report exactly
///   the same position repeatedly (StillJoint).
///
/// A reading that fails is not used; meanwhile the motion is predicted from the last believed one.
/// A joint is believed again where each of its readings followed from the one before, or where it
/// was lost and braked; else the program has to confirm its position (`confirm`). Losses in short
/// succession double the number of sound readings that it takes.
///
/// Allocates at construction only; a tick costs a few operations for each pair of joints.
class JointWatch {
 public:
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  /// @param period [s] from reading to reading @param drive_delay [ticks] of the torques
  /// @throws SetupError for an option out of range
  JointWatch(const ArmModel& model, double period, const JointWatchOptions& options = {},
             double drive_delay = 0.0)
      : model_(model),
        options_(options),
        period_(period),
        sent_(model.links.size(), drive_delay),
        alone_(sent_),
        account_(model),
        drive_(model, drive_delay),
        joints_(model.links.size()),
        change_(model.links.size()),
        read_v_(model.links.size()) {
    checked("JointWatchOptions::position_noise", options.position_noise, 0.0, 1e3, "rad");
    checked("JointWatchOptions::rate_noise", options.rate_noise, 0.0, 1e6, "rad/s");
    checked("JointWatchOptions::resolution", options.resolution, 0.0, 1e3, "rad");
    checked("JointWatchOptions::jitter", options.jitter, 0.0, 1e3, "periods");
    checked("JointWatchOptions::repeats", options.repeats, 0, 1e6, "ticks");
    checked("JointWatchOptions::mass_uncertainty", options.mass_uncertainty, 1.0, 1e3, "");
    checked("JointWatchOptions::regain", options.regain, 1, 1e6, "ticks");
    for (std::size_t i = 0; i < joints_.size(); ++i)
      joints_[i].load.effort = effort_bound(model, i);
  }

  /// Checks a reading `q` [rad], `v` [rad/s]; `position` and `rate` then return it if it is
  /// believed, else the prediction. @param elapsed [s] since the last reading
  /// @return the bits of status::blind that hold; 0 when the reading is believed
  [[nodiscard]] Status step(const std::vector<double>& q, const std::vector<double>& v,
                            double elapsed, const ArmInertia::Matrix& M) noexcept {
    Status found = 0;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      if (is_number(q[i]) && is_number(v[i])) continue;
      found = status::bad_joints;
      joints_[i].is_continuous = false;
    }
    if (found == 0U) {
      if (has_reading_) found = compare(q, v, elapsed, M);
      if (has_reading_ && found == 0U && blind_ == 0U && !held_) {
        account_.step(read_v_, v, M, sent_, elapsed);
        if (!options_.touches) drive_.step(read_v_, v, M, elapsed, options_);
      } else {
        account_.begin_anew();
        drive_.begin_anew(elapsed);
      }
      if (blind_ != 0U && !agrees(q)) found |= status::implausible_joints;
      keep(q, v);
    }
    return believe(found, elapsed);
  }

  /// What the loop sent after the reading: the net torque `net` = tau - g [N m], the part `alone`
  /// of it that moves each joint whatever holds the others, `weight` g, and the `rate` predicted
  /// one period later [rad/s]. `held`: brakes are on.
  void expect(const Vector& net, const Vector& alone, std::span<const double> weight,
              const Vector& rate, bool held) noexcept {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      joints_[i].load.weight = weight[i];
      joints_[i].expected_rate = held ? 0.0 : rate(index(i));
    }
    sent_.add(net, held ? 0.0 : 1.0);
    if (held) {
      drive_.note_held();
    } else {
      drive_.note_sent(net, weight);
    }
    alone_.add(alone, held ? 0.0 : 1.0);
    held_ = held;
  }

  /// Brakes are on, whoever engaged them: the joints need not move.
  void hold() noexcept { held_ = true; }

  /// Accepts the next reading without comparison: the arm moved on while the loop was suspended.
  void begin_anew() noexcept {
    has_reading_ = false;
    for (Joint& joint : joints_) joint.forget();
  }
  /// The positions are those of the arm, by a reference that does not depend on its encoders: the
  /// next readings are believed, whatever was lost before.
  void confirm() noexcept {
    begin_anew();
    losses_ = 0;
    for (Joint& joint : joints_) joint.is_continuous = true;
  }

  /// Read or predicted [rad] or [m].
  [[nodiscard]] double position(std::size_t joint) const noexcept { return joints_[joint].q; }
  /// Read or predicted [rad/s] or [m/s].
  [[nodiscard]] double rate(std::size_t joint) const noexcept { return joints_[joint].v; }
  /// [rad/s] By which the positions move faster than `rate` says, signed; 0 while a reading is
  /// predicted, and where the difference is within the noise.
  [[nodiscard]] double untold_rate(std::size_t joint) const noexcept {
    return blind_ == 0U ? joints_[joint].rates.untold() : 0.0;
  }
  /// [N m] The net torque, signed, that shows whether a joint stands still or its encoder is
  /// frozen; 0: there is no doubt.
  [[nodiscard]] double probe(std::size_t joint) const noexcept {
    return blind_ == 0U ? joints_[joint].still.probe(joints_[joint].load, options_) : 0.0;
  }
  /// The energy that no torque gave.
  [[nodiscard]] const MotionAccount& account() const noexcept { return account_; }
  /// What the drive does with its torques.
  [[nodiscard]] const DriveWatch& drive() const noexcept { return drive_; }
  /// No reading has been believed yet.
  [[nodiscard]] bool knows_nothing() const noexcept { return !has_believed_; }

 private:
  struct Joint {
    double q = 0.0, v = 0.0;            // believed or predicted
    double read_q = 0.0, read_v = 0.0;  // the last finite reading
    double expected_rate = 0.0;         // [rad/s]
    double lost_q = 0.0;                // [rad] where the readings failed
    double path = 0.0;                  // [rad] predicted since then
    bool is_continuous = true;          // since then, each reading follows from the one before
    bool is_stuck = false;
    JointLoad load;
    RateCheck rates;
    StillJoint still;

    void forget() noexcept {
      rates.forget();
      still.forget();
      is_stuck = false;
    }
  };

  static constexpr double braking = 0.04;  // [s] an arm moves on at the speed at which it was lost
  static constexpr double succession = 5.0;  // [s] between losses
  static constexpr int most_losses = 8;      // that count

  static bool is_number(double x) noexcept { return x - x == 0.0; }

  [[nodiscard]] Status compare(const std::vector<double>& q, const std::vector<double>& v,
                               double elapsed, const ArmInertia::Matrix& M) noexcept {
    Status found = 0;
    for (std::size_t i = 0; i < joints_.size(); ++i) change_[i] = v[i] - read_v_[i];
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      Joint& joint = joints_[i];
      joint.load.surely = alone_.surely(i);
      joint.load.at_most = sent_.at_most(i);
      joint.load.dry = model_.links[i].coulomb_friction;
      joint.load.inertia = M(index(i), index(i));
      joint.load.elapsed = elapsed;
      joint.load.is_held = held_;
      if (!can_be_true(i, v, M)) found |= status::implausible_joints;
      if (!joint.rates.step(q[i] - joint.read_q, joint.read_v, v[i], elapsed,
                            elapsed > 1.5 * period_, options_, period_)) {
        found |= status::implausible_joints;
        joint.is_continuous = false;
      }
      joint.is_stuck =
          joint.still.step(q[i], v[i], joint.read_q, joint.read_v, joint.load, options_);
      if (joint.is_stuck) found |= status::frozen_joints;
    }
    return found;
  }

  // By the speed limit and by what can accelerate the joint.
  [[nodiscard]] bool can_be_true(std::size_t i, const std::vector<double>& v,
                                 const ArmInertia::Matrix& M) const noexcept {
    const Joint& joint = joints_[i];
    const double limit = model_.links[i].velocity_limit;
    if (limit > 0.0 && !(std::abs(v[i]) <= 2.0 * limit + options_.rate_noise)) return false;
    const double* row = M.data() + i * joints_.size();  // M is symmetric
    double passed_on = 0.0;                             // momentum from the other joints [N m s]
    for (std::size_t k = 0; k < joints_.size(); ++k) {
      if (k != i) passed_on += std::abs(row[k] * change_[k]);
    }
    const double push = joint.load.elapsed * (joint.load.at_most + joint.load.effort) + passed_on;
    const double gain = options_.rate_noise + options_.mass_uncertainty * push / row[i];
    return std::abs(v[i]) <= std::abs(joint.read_v) + gain;
  }

  // Whether the readings are those of an arm that went on from where it was lost.
  [[nodiscard]] bool agrees(const std::vector<double>& q) const noexcept {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const Joint& joint = joints_[i];
      const double way =
          std::min(joint.path, braking * lost_speed_) + 3.0 * options_.position_noise;
      if (!joint.is_continuous && !(std::abs(q[i] - joint.lost_q) <= way)) return false;
    }
    return true;
  }

  void keep(const std::vector<double>& q, const std::vector<double>& v) noexcept {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      joints_[i].read_q = q[i];
      joints_[i].read_v = v[i];
    }
    std::copy(v.begin(), v.end(), read_v_.begin());
    has_reading_ = true;
  }

  [[nodiscard]] Status believe(Status found, double elapsed) noexcept {
    if (found != 0U) {
      if (blind_ == 0U) lose(elapsed);
      blind_ |= found;
      sound_ = 0;
    } else if (blind_ != 0U) {
      ++sound_;
    }
    if (blind_ == 0U || sound_ >= std::int64_t{options_.regain} << losses_) {
      for (Joint& joint : joints_) {
        joint.q = joint.read_q;
        joint.v = joint.read_v;
        joint.is_continuous = true;
      }
      believed_for_ = blind_ == 0U ? believed_for_ + elapsed : 0.0;
      blind_ = 0U;
      has_believed_ = true;
      return 0U;
    }
    for (Joint& joint : joints_) {
      joint.v = joint.expected_rate;
      joint.q += elapsed * joint.v;
      joint.path += std::abs(elapsed * joint.v);
    }
    return blind_;
  }

  // Starts the prediction. The motion of a joint with frozen readings was lost some ticks ago.
  void lose(double elapsed) noexcept {
    losses_ = !has_believed_ || believed_for_ > succession ? 0 : std::min(losses_ + 1, most_losses);
    if (!has_been_lost_) losses_ = 0;
    has_been_lost_ = true;
    lost_speed_ = 0.0;
    for (Joint& joint : joints_) {
      joint.path = 0.0;
      joint.expected_rate += joint.rates.untold_before();
      if (joint.is_stuck) {
        joint.expected_rate = joint.still.rate();
        joint.q += joint.still.way(elapsed);
      }
      joint.lost_q = joint.q;
      lost_speed_ = std::max(lost_speed_, std::abs(joint.expected_rate));
      joint.rates.forget();
    }
  }

  static Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

  const ArmModel& model_;
  JointWatchOptions options_;
  double period_;  // [s]
  SentTorques sent_, alone_;
  MotionAccount account_;
  DriveWatch drive_;
  std::vector<Joint> joints_;
  std::vector<double> change_;  // [rad/s] of the rates since the last reading
  std::vector<double> read_v_;  // [rad/s] the last finite reading
  Status blind_ = 0U;           // why the readings are not believed
  std::int64_t sound_ = 0;      // consecutive sound readings since
  double lost_speed_ = 0.0;     // [rad/s] greatest joint speed when the readings failed
  double believed_for_ = 0.0;   // [s]
  int losses_ = 0;              // in short succession
  bool has_reading_ = false, has_believed_ = false, has_been_lost_ = false, held_ = false;
};

}  // namespace repel
