// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Plausibility check of joint readings, and prediction of the motion while they fail it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/base/status.hpp>
#include <repel/loop/arm_inertia.hpp>
#include <repel/loop/options.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// Compares every reading with the last one, with the torques sent in between and with the inertia
/// of the arm, joint by joint:
///
/// - positions and rates are finite, rates below twice the speed limit;
/// - a position follows from the last one and the mean of the rates, within the noise; errors of
///   several ticks accumulate;
/// - a rate grows no faster than the full effort of the joint, and the coupling from other joints,
///   can accelerate it: M_ii |dv_i| <= T (|tau_i - g_i| + effort_i) + sum |M_ik dv_k|. Speed may be
///   lost at once, by an impact;
/// - a joint that moves, or is driven by more than its friction can hold, does not report exactly
///   the same position repeatedly.
///
/// A reading that fails is not used; meanwhile the motion is predicted from the last believed one.
/// Allocates at construction only; a tick costs a few operations for each pair of joints.
class JointWatch {
 public:
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  /// @param period [s] from reading to reading
  /// @throws SetupError for an option out of range
  JointWatch(const ArmModel& model, double period, const JointWatchOptions& options = {})
      : model_(model),
        options_(options),
        period_(period),
        joints_(model.links.size()),
        change_(model.links.size()) {
    checked("JointWatchOptions::position_noise", options.position_noise, 0.0, 1e3, "rad");
    checked("JointWatchOptions::rate_noise", options.rate_noise, 0.0, 1e6, "rad/s");
    checked("JointWatchOptions::resolution", options.resolution, 0.0, 1e3, "rad");
    checked("JointWatchOptions::jitter", options.jitter, 0.0, 1e3, "periods");
    checked("JointWatchOptions::repeats", options.repeats, 0, 1e6, "ticks");
    checked("JointWatchOptions::mass_uncertainty", options.mass_uncertainty, 1.0, 1e3, "");
    checked("JointWatchOptions::regain", options.regain, 1, 1e6, "ticks");
    for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i].effort = effort_bound(model, i);
  }

  /// Checks a reading `q` [rad], `v` [rad/s]; `position` and `rate` then return it if it is
  /// believed, else the prediction. @param elapsed [s] since the last reading
  /// @return the bits of status::blind that hold; 0 when the reading is believed
  [[nodiscard]] Status step(const std::vector<double>& q, const std::vector<double>& v,
                            double elapsed, const ArmInertia::Matrix& M) noexcept {
    Status found = 0;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      if (!is_number(q[i]) || !is_number(v[i])) found = status::bad_joints;
    }
    if (found == 0U) {
      if (has_reading_) found = compare(q, v, elapsed, M);
      if (blind_ != 0U && !agrees(q)) found |= status::implausible_joints;
      keep(q, v);
    }
    return believe(found, elapsed);
  }

  /// What the loop sent after the reading: the net torque `net` = tau - g [N m], `weight` g, and
  /// the `rate` predicted one period later [rad/s]. `held`: brakes are on.
  void expect(const Vector& net, std::span<const double> weight, const Vector& rate,
              bool held) noexcept {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      joints_[i].net = held ? 0.0 : net(index(i));
      joints_[i].weight = weight[i];
      joints_[i].expected_rate = held ? 0.0 : rate(index(i));
    }
    held_ = held;
  }

  /// Brakes are on, whoever engaged them: the joints need not move.
  void hold() noexcept { held_ = true; }

  /// Accepts the next reading without comparison: the arm moved on while the loop was suspended.
  void begin_anew() noexcept {
    has_reading_ = false;
    for (Joint& joint : joints_) joint.forget();
  }

  /// Read or predicted [rad] or [m].
  [[nodiscard]] double position(std::size_t joint) const noexcept { return joints_[joint].q; }
  /// Read or predicted [rad/s] or [m/s].
  [[nodiscard]] double rate(std::size_t joint) const noexcept { return joints_[joint].v; }
  /// No reading has been believed yet.
  [[nodiscard]] bool knows_nothing() const noexcept { return !has_believed_; }

 private:
  struct Joint {
    double q = 0.0, v = 0.0;            // believed or predicted
    double read_q = 0.0, read_v = 0.0;  // the last finite reading
    double net = 0.0;                   // [N m] sent, without the gravity torque
    double expected_rate = 0.0;         // [rad/s]
    double effort = 0.0;                // [N m]
    double drift = 0.0;                 // [rad] position minus integrated rate, leaky sum
    double change = 0.0;                // [rad/s] of the rate, leaky sum
    double weight = 0.0;                // [N m] gravity torque
    double forced_rate = 0.0;           // [rad/s] due to the torques sent, if reported still
    double forced_way = 0.0;            // [rad] integral of forced_rate
    int same = 0;                       // consecutive readings of the same position
    double moved_at = 0.0;              // [rad/s] before the position repeated
    bool moved = false;                 // before the position repeated
    bool stuck = false;                 // until another position is reported

    void forget() noexcept {
      drift = change = forced_rate = forced_way = 0.0;
      same = 0;
      moved = false;
    }
  };

  static constexpr double memory = 0.9;  // decay per tick of the leaky sums

  static bool is_number(double x) noexcept { return x - x == 0.0; }

  [[nodiscard]] Status compare(const std::vector<double>& q, const std::vector<double>& v,
                               double elapsed, const ArmInertia::Matrix& M) noexcept {
    Status found = 0;
    for (std::size_t i = 0; i < joints_.size(); ++i) change_[i] = v[i] - joints_[i].read_v;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      if (!can_be_true(i, q, v, elapsed, M)) found |= status::implausible_joints;
      if (stands_still(joints_[i], model_.links[i], q[i], v[i], elapsed, M(index(i), index(i)))) {
        found |= status::frozen_joints;
      }
    }
    return found;
  }

  [[nodiscard]] bool can_be_true(std::size_t i, const std::vector<double>& q,
                                 const std::vector<double>& v, double elapsed,
                                 const ArmInertia::Matrix& M) noexcept {
    Joint& joint = joints_[i];
    const double limit = model_.links[i].velocity_limit;
    if (limit > 0.0 && !(std::abs(v[i]) <= 2.0 * limit + options_.rate_noise)) return false;
    const double* row = M.data() + i * joints_.size();  // M is symmetric
    double passed_on = 0.0;                             // momentum from the other joints [N m s]
    for (std::size_t k = 0; k < joints_.size(); ++k) {
      if (k != i) passed_on += std::abs(row[k] * change_[k]);
    }
    const double push = elapsed * (std::abs(joint.net) + joint.effort) + passed_on;
    const double gain = options_.rate_noise + options_.mass_uncertainty * push / row[i];
    if (!(std::abs(v[i]) <= std::abs(joint.read_v) + gain)) return false;
    // Between two readings the rate is assumed to lie between theirs; with readings missing, it may
    // have been higher for a while.
    const double step = std::abs(v[i] - joint.read_v);
    const double missing = q[i] - joint.read_q - 0.5 * elapsed * (v[i] + joint.read_v);
    const double speed = std::max(std::abs(v[i]), std::abs(joint.read_v));
    double most = options_.position_noise + 0.5 * elapsed * step;
    if (elapsed > 1.5 * period_) most += elapsed * (speed + options_.rate_noise);
    const double off = options_.jitter * period_ * speed;
    joint.drift = memory * joint.drift + missing;
    joint.change = memory * joint.change + step;
    const bool follows =
        std::abs(missing) <= most + off &&
        std::abs(joint.drift) <= 3.0 * most + 2.0 * off + 0.6 * elapsed * joint.change;
    if (!follows) joint.drift = joint.change = 0.0;  // discards implausible data
    return follows;
  }

  // Detects the same position, bit for bit, of a joint that moved, moves, or must move. Dry
  // friction and a wrong gravity model may hold it while the expected motion is within the noise;
  // above a twentieth of its effort, within twice the resolution.
  [[nodiscard]] bool stands_still(Joint& joint, const ArmLink& link, double q, double v,
                                  double elapsed, double inertia) noexcept {
    const bool is_same = q == joint.read_q;
    joint.same = is_same ? joint.same + 1 : 0;
    joint.stuck = joint.stuck && is_same;
    if (held_) return joint.stuck;
    const double clear = 0.1 * options_.rate_noise;
    if (joint.same == 1) {
      joint.moved = std::abs(joint.read_v) > clear &&
                    shortest_way(joint, link, inertia, elapsed) > 5.0 * options_.resolution;
      joint.moved_at = joint.read_v;
    }
    const bool moves = std::abs(v) * elapsed > options_.resolution &&
                       (v == joint.read_v || std::abs(v) > 2.0 * clear);
    const double force =
        std::abs(joint.net) - 1.5 * link.coulomb_friction - 0.3 * std::abs(joint.weight);
    if (is_same && force > 0.0) {
      joint.forced_rate += elapsed * force / (options_.mass_uncertainty * inertia);
      joint.forced_way += elapsed * joint.forced_rate;
    } else {
      joint.forced_rate = joint.forced_way = 0.0;
    }
    const double most =
        force > 0.05 * joint.effort ? 2.0 * options_.resolution : options_.position_noise;
    const bool must_move = !options_.touches && joint.forced_way > most;
    if (joint.same > options_.repeats && (joint.moved || moves || must_move)) joint.stuck = true;
    return joint.stuck;
  }

  // Shortest distance [rad] beyond the last reading, if friction and all torque sent brake the
  // joint.
  [[nodiscard]] double shortest_way(const Joint& joint, const ArmLink& link, double inertia,
                                    double elapsed) const noexcept {
    const double force = 1.5 * link.coulomb_friction + std::abs(joint.net);
    const double v = std::abs(joint.read_v);
    const double stopping = 0.5 * v * v * inertia / (options_.mass_uncertainty * force + 1e-12);
    return std::min(v * elapsed, stopping);
  }

  // Whether positions after a gap are within reach of the prediction, for an arm that braked
  // meanwhile.
  [[nodiscard]] bool agrees(const std::vector<double>& q) const noexcept {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const double way = lost_speed_ * std::min(blind_for_, 0.2) +
                         (held_ ? 0.0 : 0.25 * blind_for_) + 3.0 * options_.position_noise;
      if (!(std::abs(q[i] - joints_[i].q) <= way)) return false;
    }
    return true;
  }

  void keep(const std::vector<double>& q, const std::vector<double>& v) noexcept {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      joints_[i].read_q = q[i];
      joints_[i].read_v = v[i];
    }
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
    if (blind_ == 0U || sound_ >= options_.regain) {
      for (Joint& joint : joints_) joint.q = joint.read_q, joint.v = joint.read_v;
      blind_ = 0U;
      blind_for_ = 0.0;
      has_believed_ = true;
      return 0U;
    }
    blind_for_ += elapsed;
    for (Joint& joint : joints_) {
      joint.v = joint.expected_rate;
      joint.q += elapsed * joint.v;
    }
    return blind_;
  }

  // Starts the prediction. The motion of a joint with frozen readings was lost some ticks ago.
  void lose(double elapsed) noexcept {
    lost_speed_ = 0.0;
    for (Joint& joint : joints_) {
      if (joint.stuck) {
        const double driven = options_.mass_uncertainty * joint.forced_rate;
        joint.expected_rate = joint.moved_at + std::copysign(driven, joint.net);
        joint.q += elapsed * (joint.same - 1) * joint.expected_rate;
      }
      lost_speed_ = std::max(lost_speed_, std::abs(joint.expected_rate));
      joint.forget();
    }
  }

  static Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

  const ArmModel& model_;
  JointWatchOptions options_;
  double period_;  // [s]
  std::vector<Joint> joints_;
  std::vector<double> change_;  // [rad/s] of the rates since the last reading
  Status blind_ = 0U;           // why the readings are not believed
  int sound_ = 0;               // consecutive sound readings since
  double blind_for_ = 0.0;      // [s] since the last believed reading
  double lost_speed_ = 0.0;     // [rad/s] greatest joint speed when the readings failed
  bool has_reading_ = false, has_believed_ = false, held_ = false;
};

}  // namespace repel
