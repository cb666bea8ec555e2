// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/joint_watch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel {

JointWatch::JointWatch(const ArmModel& model, double period, const JointWatchOptions& options,
                       double drive_delay)
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
  for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i].load.effort = effort_bound(model, i);
}

Status JointWatch::step(const std::vector<double>& q, const std::vector<double>& v, double elapsed,
                        const ArmInertia::Matrix& M) noexcept {
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

void JointWatch::expect(const Vector& net, const Vector& alone, std::span<const double> weight,
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

void JointWatch::begin_anew() noexcept {
  has_reading_ = false;
  for (Joint& joint : joints_) joint.forget();
}

void JointWatch::confirm() noexcept {
  begin_anew();
  losses_ = 0;
  for (Joint& joint : joints_) joint.is_continuous = true;
}

double JointWatch::untold_rate(std::size_t joint) const noexcept {
  return blind_ == 0U ? joints_[joint].rates.untold() : 0.0;
}

double JointWatch::probe(std::size_t joint) const noexcept {
  return blind_ == 0U ? joints_[joint].still.probe(joints_[joint].load, options_) : 0.0;
}

void JointWatch::Joint::forget() noexcept {
  rates.forget();
  still.forget();
  is_stuck = false;
}

Status JointWatch::compare(const std::vector<double>& q, const std::vector<double>& v,
                           double elapsed, const ArmInertia::Matrix& M) noexcept {
  Status found = 0;
  for (std::size_t i = 0; i < joints_.size(); ++i) change_[i] = v[i] - read_v_[i];
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    Joint& joint = joints_[i];
    joint.load.surely = alone_.surely(i);
    joint.load.at_most = sent_.at_most(i);
    joint.load.dry = model_.links[i].coulomb_friction;
    joint.load.inertia = M(index(i), index(i));
    joint.load.free_inertia = q[i] == joint.read_q ? free_inertia(i, M) : joint.load.inertia;
    joint.load.elapsed = elapsed;
    joint.load.is_held = held_;
    if (!can_be_true(i, v, M)) found |= status::implausible_joints;
    if (!joint.rates.step(q[i] - joint.read_q, joint.read_v, v[i], elapsed, elapsed > 1.5 * period_,
                          options_, period_)) {
      found |= status::implausible_joints;
      joint.is_continuous = false;
    }
    joint.is_stuck = joint.still.step(q[i], v[i], joint.read_q, joint.read_v, joint.load, options_);
    if (joint.is_stuck) found |= status::frozen_joints;
  }
  return found;
}

double JointWatch::free_inertia(std::size_t i, const ArmInertia::Matrix& M) noexcept {
  const Eigen::Index n = index(joints_.size());
  // A joint at rest is not asked how far it goes.
  if (std::abs(joints_[i].read_v) <= 0.1 * options_.rate_noise) return M(index(i), index(i));
  const bool is_sound = factored_.factor(
      n, [&](Eigen::Index k) { return M.data()[k] * (k % (n + 1) == 0 ? 1.0 + 1e-6 : 1.0); });
  if (!is_sound) return 0.0;
  response_.setZero(n);
  response_(index(i)) = 1.0;
  factored_.solve(response_);
  return 1.0 / response_(index(i));
}

bool JointWatch::can_be_true(std::size_t i, const std::vector<double>& v,
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

bool JointWatch::agrees(const std::vector<double>& q) const noexcept {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = joints_[i];
    const double way = std::min(joint.path, braking * lost_speed_) + 3.0 * options_.position_noise;
    if (!joint.is_continuous && !(std::abs(q[i] - joint.lost_q) <= way)) return false;
  }
  return true;
}

void JointWatch::keep(const std::vector<double>& q, const std::vector<double>& v) noexcept {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    joints_[i].read_q = q[i];
    joints_[i].read_v = v[i];
  }
  std::copy(v.begin(), v.end(), read_v_.begin());
  has_reading_ = true;
}

Status JointWatch::believe(Status found, double elapsed) noexcept {
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

void JointWatch::lose(double elapsed) noexcept {
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

}  // namespace repel
