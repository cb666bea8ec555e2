// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/still_joint.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace repel {

bool StillJoint::step(double q, double v, double last_q, double last_v, const JointLoad& load,
                      const JointWatchOptions& options) noexcept {
  const bool is_same = q == last_q;
  if (!is_same) {
    move_on();
    finest_ = std::min(finest_, std::abs(q - last_q));
  }
  // The coarser one of the resolution in the options and of the observed steps.
  const double coarsest = coarse * options.position_noise;
  const bool is_known = finest_ < std::numeric_limits<double>::infinity();
  step_ = std::max(options.resolution, std::min(finest_, coarsest));
  resolution_ = is_known ? step_ : options.resolution;
  same_ = is_same ? same_ + 1 : 0;
  if (load.is_held) {
    probing_ = 0.0;
    return is_frozen_;
  }
  const double clear = 0.1 * options.rate_noise;
  if (same_ == 1) {
    // What friction stops on a way too short to tell may be seen to go none.
    const double told = std::max(5.0 * step_, seen * options.position_noise);
    has_moved_ = std::abs(last_v) > clear && shortest_way(last_v, load, options) > told;
    moved_at_ = last_v;
  }
  if (is_same) push(load, options);
  // By its rate. A joint that starts has not gone a whole step of its encoder in its first tick.
  const bool moves =
      is_same && std::abs(v) * load.elapsed > step_ && (v == last_v || std::abs(v) > 2.0 * clear);
  moving_ = moves ? moving_ + 1 : 0;
  const bool must_move = !options.touches && forced_way_ > enough_;
  if (same_ > options.repeats && (has_moved_ || moving_ > 1 || must_move)) is_frozen_ = true;
  const double doubtful = std::max(unseen * options.position_noise, 10.0 * resolution_);
  const bool is_doubtful = !options.touches && unseen_way_ > doubtful;
  const bool probes = is_same && (is_doubtful || probing_ > 0.0) && !is_frozen_;
  if (probes && probing_ == 0.0) {
    begun_ = direction_;
    turns_ = std::abs(load.surely) < 0.03 * load.effort;
  }
  probing_ = probes ? probing_ + load.elapsed : 0.0;
  return is_frozen_;
}

double StillJoint::probe(const JointLoad& load, const JointWatchOptions& options) const noexcept {
  if (!(probing_ > 0.0)) return 0.0;
  // As much beyond friction as moves it far enough in two ticks, or in 5 ms.
  const double T = std::max(load.elapsed, 0.5 * at_once);
  const double excess = 2.0 * shown(options) * options.mass_uncertainty * load.inertia / (T * T);
  const double most = held_by(load) + std::min(excess, 0.1 * load.effort);
  const double share = std::min(1.0, probing_ / ramp);
  const double now = std::abs(load.surely);
  const double level = now + share * (most - now);
  // The other way where this one led to nothing: a wall may be there. A joint that is hardly
  // pushed is probed the other way first.
  const bool turns = (static_cast<int>(probing_ / (2.0 * ramp)) + (turns_ ? 1 : 0)) % 2 == 1;
  return std::copysign(level, turns ? -begun_ : begun_);
}

double StillJoint::rate() const noexcept {
  return (has_moved_ ? moved_at_ : 0.0) + std::copysign(unseen_rate_, direction_);
}

double StillJoint::way(double elapsed) const noexcept {
  const double before = has_moved_ ? elapsed * (same_ - 1) * moved_at_ : 0.0;
  return before + std::copysign(0.5 * (forced_way_ + unseen_way_), direction_);
}

void StillJoint::forget() noexcept {
  move_on();
  same_ = 0;
}

double StillJoint::shown(const JointWatchOptions& options) const noexcept {
  return std::max(1.5 * step_, seen * options.position_noise);
}

double StillJoint::held_by(const JointLoad& load) const noexcept {
  return std::max(1.5 * load.dry + 0.3 * std::abs(load.weight), 1.1 * withstood_);
}

void StillJoint::push(const JointLoad& load, const JointWatchOptions& options) noexcept {
  const double T = load.elapsed;
  const double slow = T / (options.mass_uncertainty * load.inertia);
  const double fast = T * options.mass_uncertainty / load.inertia;
  if (load.surely != 0.0) {
    if (load.surely * direction_ < 0.0) forced_rate_ = forced_way_ = 0.0;
    direction_ = load.surely;
  }
  const double surely = std::abs(load.surely);
  // What it would have moved by without friction shows that friction holds it.
  free_rate_ += slow * surely;
  free_way_ += T * free_rate_;
  if (!(probing_ > 0.0)) stood_under_ = std::max(stood_under_, surely);
  const double force = surely - held_by(load);
  forced_rate_ = force > 0.0 ? forced_rate_ + slow * force : 0.0;
  forced_way_ = force > 0.0 ? forced_way_ + T * forced_rate_ : 0.0;
  enough_ = options.position_noise;
  if (force > 0.05 * load.effort || probing_ > 0.0) {
    enough_ = shown(options);
  }
  const double excess = load.at_most - std::max(surely_sticks * load.dry, withstood_);
  unseen_rate_ = std::max(0.0, unseen_rate_ + fast * excess);
  unseen_way_ += T * unseen_rate_;
  evident_ = 4.0 * resolution_;
  withstood_ -= std::min(1.0, T / memory) * withstood_;
}

void StillJoint::move_on() noexcept {
  if (free_way_ > evident_ && !is_frozen_) withstood_ = std::max(withstood_, stood_under_);
  stood_under_ = free_rate_ = free_way_ = 0.0;
  forced_rate_ = forced_way_ = unseen_rate_ = unseen_way_ = probing_ = 0.0;
  is_frozen_ = has_moved_ = false;
  moved_at_ = 0.0;
}

double StillJoint::shortest_way(double last_v, const JointLoad& load,
                                const JointWatchOptions& options) noexcept {
  const double force = 1.5 * load.dry + load.at_most;
  const double v = std::abs(last_v);
  const double stopping =
      0.5 * v * v * load.free_inertia / (options.mass_uncertainty * force + 1e-12);
  return std::min(v * load.elapsed, stopping);
}

}  // namespace repel
