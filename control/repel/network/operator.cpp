// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/operator.hpp>

#include <algorithm>
#include <cstdint>

namespace repel::network {

Twist Screw::per_motion(const Vec3& direction) const noexcept {
  const Vec3 linear = pitch * direction - direction.cross(axis);
  const double most = std::max(arm, linear.norm());
  return {linear / most, direction / most};
}

bool Command::is_silent(double patience) const noexcept {
  return !(silent_for >= 0.0 && silent_for <= patience);
}

const Command& ScriptedOperator::step(const Mat3& R_WT, double period) noexcept {
  while (phase_ < script_.size() && in_phase_ > script_[phase_].duration - 0.5 * period) {
    ++phase_;
    in_phase_ = 0.0;
  }
  in_phase_ += period;
  command_.phase = static_cast<std::int32_t>(phase_);
  if (!over() && script_[phase_].silent) {
    command_.silent_for += period;
    return command_;
  }
  command_.hand.rest();
  command_.second.rest();
  if (!over()) switch_over(script_[phase_]);
  command_.silent_for = 0.0;
  command_.sound = over() || read(script_[phase_], R_WT, period);
  return command_;
}

void ScriptedOperator::switch_over(const Phase& phase) noexcept {
  if (phase.scale > 0.0) command_.hand.scale = command_.second.scale = phase.scale;
  if (phase.guides != as_before) command_.hand.guides = phase.guides;
  if (phase.compliant != as_before) command_.hand.compliant = phase.compliant;
  if (phase.guide_strength >= 0.0) command_.hand.guide_strength = phase.guide_strength;
}

bool ScriptedOperator::read(const Phase& phase, const Mat3& R_WT, double period) noexcept {
  const bool in_tool = phase.frame == PhaseFrame::tool;
  if (!is_finite(phase.second)) return false;
  command_.second.ball = in_tool ? rotated(R_WT, phase.second) : phase.second;
  if (phase.second_lever) {
    const LeverMotion& lever = *phase.second_lever;
    if (!is_finite(lever.direction) || lever.rate - lever.rate != 0.0) return false;
    if (in_phase_ <= period) {
      command_.second.direction_W = in_tool ? R_WT * lever.direction : lever.direction;
    }
    command_.second.lever_rate = lever.rate;
  }
  if (phase.master != Master::torque_arm) {
    if (!is_finite(phase.rates)) return false;
    command_.hand.ball = in_tool ? rotated(R_WT, phase.rates) : phase.rates;
    return true;
  }
  const bool finite = is_finite(phase.direction) && phase.lever_rate - phase.lever_rate == 0.0;
  if (!finite) return false;
  if (phase.screw) {
    follow_screw(phase, R_WT, in_phase_ <= period);
  } else if (in_phase_ <= period) {
    // The direction is fixed at the start of the phase: a lever coupled to a rotating axis would
    // move the tool without any motion of the hand.
    command_.hand.direction_W = in_tool ? R_WT * phase.direction : phase.direction;
    command_.hand.turning_W = Vec3::Zero();
  }
  command_.hand.lever_rate = phase.lever_rate;
  return true;
}

void ScriptedOperator::follow_screw(const Phase& phase, const Mat3& R_WT, bool begins) noexcept {
  if (begins) {
    screw_T_ = phase.screw->per_motion(phase.direction);
    if (phase.frame == PhaseFrame::world) screw_T_ = rotated(R_WT.transpose(), screw_T_);
  }
  const Twist screw_W = rotated(R_WT, screw_T_);
  command_.hand.direction_W = screw_W.linear;
  command_.hand.turning_W = screw_W.angular;
}

}  // namespace repel::network
