// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A scripted operator: a repeatable substitute for a person at the master.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <repel/network/elements/signals.hpp>

namespace repel::network {

/// The device in the operator's hand.
enum class Master {
  spaceball,   ///< six rates, no force feedback
  torque_arm,  ///< one lever with force feedback
  six_axes,    ///< six rates of a hand, with force feedback
};

/// Frame in which a phase states its directions.
enum class PhaseFrame { world, tool };

/// A screw about an axis of known direction.
struct Screw {
  double pitch = 0.0;  ///< [m/rad] motion along the axis per turning about it
  Vec3 axis{0, 0, 0};  ///< [m] from the origin of the tool to a point of the axis

  /// [m] What the lever moves by its scale is the faster of two points: the origin of the tool, and
  /// one so far off an axis without pitch. With the scale of 0.1 m/rad the tool turns by as much as
  /// the lever.
  static constexpr double arm = 0.1;

  /// The motion of the tool per motion that the lever's scale states: the linear part without unit,
  /// of length one or less, the angular one [rad/m]. @param direction unit
  [[nodiscard]] Twist per_motion(const Vec3& direction) const noexcept {
    const Vec3 linear = pitch * direction - direction.cross(axis);
    const double most = std::max(arm, linear.norm());
    return {linear / most, direction / most};
  }
};

/// A lever and what it does to the tool.
struct LeverMotion {
  Vec3 direction{1, 0, 0};  ///< unit, in the frame of the phase: in which the tool is driven
  double rate = 0.0;        ///< [rad/s] of the hand
};

/// In place of a set of bits in a phase: that of the phase before.
inline constexpr std::int32_t as_before = -2;

/// One phase of the script.
struct Phase {
  std::string name{};                    ///< shown in the progress line and the log
  Master master = Master::spaceball;     ///< the device in the operator's hand
  PhaseFrame frame = PhaseFrame::world;  ///< of the rates and of the direction
  double duration = 1.0;                 ///< [s]
  Twist rates{};            ///< [m/s, rad/s] spaceball, six axes: constant through the phase
  Vec3 direction{1, 0, 0};  ///< torque arm: unit, direction in which the lever drives the tool
  /// Torque arm: the lever screws the tool about an axis along `direction`, which stays fixed to
  /// the tool.
  std::optional<Screw> screw{};
  double lever_rate = 0.0;  ///< [rad/s] torque arm: rate of the hand
  Twist second{};           ///< [m/s, rad/s] of a second hand with six axes, meanwhile
  std::optional<LeverMotion> second_lever{};  ///< of a second hand with a lever, meanwhile
  double scale = 0.0;               ///< HandInput::scale of both from here on; 0: as before
  std::int32_t guides = as_before;  ///< HandInput::guides from here on
  double guide_strength = -1.0;     ///< HandInput::guide_strength from here on; below 0: as before
  std::int32_t compliant = as_before;  ///< HandInput::compliant from here on
  bool silent = false;                 ///< the device does not respond: its last sample is held
};

using Script = std::vector<Phase>;  ///< played one after the other

/// The operator's input of one period.
struct Command {
  HandInput hand{};         ///< if not finite: taken as rest, and a fault
  HandInput second{};       ///< of a second hand at the same tool; likewise
  bool sound = true;        ///< false: the source reports that its data are invalid
  double silent_for = 0.0;  ///< [s] age of the sample
  std::int32_t phase = 0;   ///< of a script; copied to the record

  /// The sample is older than `patience` [s], or its age is none: below 0, or not a number.
  [[nodiscard]] bool is_silent(double patience) const noexcept {
    return !(silent_for >= 0.0 && silent_for <= patience);
  }
};

/// Plays a script, phase after phase, and gives zero input when it is over. The hand holds the
/// lever still unless a torque-arm phase moves it.
class ScriptedOperator {
 public:
  /// At the beginning of the script.
  explicit ScriptedOperator(Script script) : script_(std::move(script)) {}

  /// Advances by one period and returns its input.
  /// @param R_WT orientation of the tool, for phases in its frame
  [[nodiscard]] const Command& step(const Mat3& R_WT, double period) noexcept {
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
    command_.hand.ball = command_.second.ball = {};
    command_.hand.lever_rate = command_.second.lever_rate = 0.0;
    if (!over()) switch_over(script_[phase_]);
    command_.silent_for = 0.0;
    command_.sound = over() || read(script_[phase_], R_WT, period);
    return command_;
  }

  /// The last phase has ended.
  [[nodiscard]] bool over() const noexcept { return phase_ >= script_.size(); }
  /// Index of the phase being played; the number of phases when the script is over.
  [[nodiscard]] std::size_t phase() const noexcept { return phase_; }
  [[nodiscard]] const Script& script() const noexcept { return script_; }  ///< as it was given

 private:
  // What stays from phase to phase.
  void switch_over(const Phase& phase) noexcept {
    if (phase.scale > 0.0) command_.hand.scale = command_.second.scale = phase.scale;
    if (phase.guides != as_before) command_.hand.guides = phase.guides;
    if (phase.compliant != as_before) command_.hand.compliant = phase.compliant;
    if (phase.guide_strength >= 0.0) command_.hand.guide_strength = phase.guide_strength;
  }
  [[nodiscard]] bool read(const Phase& phase, const Mat3& R_WT, double period) noexcept {
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

  /// The axis is fixed to the tool from the start of the phase on, so that the tool stays on it:
  /// its screw about the axis leaves the axis where it is in the world.
  void follow_screw(const Phase& phase, const Mat3& R_WT, bool begins) noexcept {
    if (begins) {
      screw_T_ = phase.screw->per_motion(phase.direction);
      if (phase.frame == PhaseFrame::world) screw_T_ = rotated(R_WT.transpose(), screw_T_);
    }
    const Twist screw_W = rotated(R_WT, screw_T_);
    command_.hand.direction_W = screw_W.linear;
    command_.hand.turning_W = screw_W.angular;
  }

  Script script_;
  Command command_;
  std::size_t phase_ = 0;
  double in_phase_ = 0.0;  ///< [s]
  Twist screw_T_;          ///< of the phase, in axes of the tool
};

}  // namespace repel::network
