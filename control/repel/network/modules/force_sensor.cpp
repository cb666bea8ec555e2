// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/force_sensor.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <repel/base/setup_error.hpp>

namespace repel::network {

ForceSensor::ForceSensor(const ForceSensorOptions& options) : options_(checked_fields(options)) {
  checked("distance of the centre of mass", options.p_TC.norm(), 0.0, 10.0, "m");
  checked("gravity", options.gravity_W.norm(), 0.0, 100.0, "m/s^2");
}

Traits ForceSensor::traits() const noexcept {
  return {.left = Space::joints,
          .right = Space::joints,
          .needs_flow = true,
          .keeps_flow = true,
          .at_robot = true,
          .lightens = options_.gain};
}

void ForceSensor::prepare(double period) {
  const double turned = 2.0 * std::numbers::pi * options_.cutoff * detail::checked_period(period);
  follows_ = options_.cutoff > 0.0 ? 1.0 - std::exp(-turned) : 1.0;
}

void ForceSensor::read(const Signals& signals) noexcept {
  const bool is_sound = take(signals);
  lost_ticks_ += is_sound ? 0 : 1;
  is_lost_ = !is_sound;
  if (signals.released) {
    forget();
  } else {
    if (is_sound) weigh(signals);
    const bool may_act = is_sound && !signals.at_rest && is_tared();
    fade(may_act, signals.since_last());
    // While the share falls the last force is held; at share zero any may be taken.
    if (is_sound && share_ == 0.0) force_ = reading_;
    if (is_sound && !has_tripped_) follow();
  }
  if (share_ > 0.0) peak_ = std::max(peak_, force_.force.norm());
  force_W_ = rotated(signals.X_WT.linear(), force_);
  dense::transposed_product(signals.jacobian, to_vec(force_W_), torque_);
  torque_ *= gain();
}

bool ForceSensor::reflected(const Equivalent<any_size>& behind,
                            Equivalent<any_size>& shown) const noexcept {
  shown = behind;
  const double scale = 1.0 + gain();
  if (shown.form == Form::impedance) {
    shown.matrix *= scale;
    shown.offset *= scale;
  } else {
    shown.matrix *= 1.0 / scale;
  }
  shown.add_effort(-torque_);
  return true;
}

void ForceSensor::incident(const PortState<any_size>& at_root,
                           const Equivalent<any_size>& /*behind*/,
                           PortState<any_size>& at_leaf) noexcept {
  const double share = 1.0 / (1.0 + gain());
  at_leaf.flow = at_root.flow;
  at_leaf.effort = share * (at_root.effort + torque_);
  supplied_ = (at_leaf.effort - at_root.effort).dot(at_root.flow);
}

bool ForceSensor::take(const Signals& signals) noexcept {
  is_saturated_ = false;
  if (!signals.is_measured || !is_finite(signals.measured)) return false;
  const Wrench& raw = signals.measured;
  const double force = largest_entry(raw.force) / options_.force_range;
  const double torque = largest_entry(raw.torque) / options_.torque_range;
  if (!(std::max(force, torque) <= beyond)) return false;
  is_saturated_ = std::max(force, torque) >= 1.0;
  saturated_ticks_ += is_saturated_ ? 1 : 0;
  reading_ = {clipped(raw.force, options_.force_range), clipped(raw.torque, options_.torque_range)};
  return true;
}

Vec3 ForceSensor::clipped(const Vec3& all, double most) noexcept {
  return {std::clamp(all.x(), -most, most), std::clamp(all.y(), -most, most),
          std::clamp(all.z(), -most, most)};
}

void ForceSensor::weigh(const Signals& signals) noexcept {
  const Vec3 weight_T =
      signals.X_WT.linear().transpose() * Vec3(options_.mass * options_.gravity_W);
  reading_ += -1.0 * wrench_of_force(weight_T, options_.p_TC);
  if (!is_tared()) tare(signals);
  reading_ += -1.0 * bias_;
}

void ForceSensor::tare(const Signals& signals) noexcept {
  const Vec<any_size> flow = signals.mean_tool_flow();
  if (three(flow, 0).norm() > still || three(flow, 3).norm() > angular_still) {
    tared_for_ = 0.0;
    count_ = 0;
    sum_ = {};
    return;
  }
  sum_ += reading_;
  tared_for_ += signals.since_last();
  bias_ = (1.0 / static_cast<double>(++count_)) * sum_;
}

void ForceSensor::fade(bool may_act, double elapsed) noexcept {
  sound_for_ = may_act ? sound_for_ + elapsed : 0.0;
  has_tripped_ = has_tripped_ || !may_act;
  if (has_tripped_ && (share_ > 0.0 || sound_for_ < hold)) {
    share_ = std::max(0.0, share_ - elapsed / fall);
  } else {
    has_tripped_ = false;
    share_ = std::min(1.0, share_ + elapsed / rise);
  }
}

void ForceSensor::follow() noexcept {
  force_.force += follows_ * (reading_.force - force_.force);
  force_.torque += follows_ * (reading_.torque - force_.torque);
}

void ForceSensor::forget() noexcept {
  share_ = sound_for_ = 0.0;
  has_tripped_ = true;
  force_ = {};
  if (is_tared()) return;
  tared_for_ = 0.0;
  count_ = 0;
  sum_ = {};
}

}  // namespace repel::network
