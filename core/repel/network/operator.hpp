/// @file
/// A scripted operator: what a person at the master does, written down so that it can be repeated.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <repel/network/multiplex.hpp>
#include <repel/network/spaceball.hpp>
#include <repel/network/torque_arm.hpp>

namespace repel::network {

enum class Master {
  spaceball,   ///< six rates, nothing is felt
  torque_arm,  ///< one lever, which pushes back
};

/// Frame in which a phase states its directions.
enum class PhaseFrame { world, tool };

/// One stretch of the script.
struct Phase {
  std::string name;                      ///< shown in the progress line and the log
  Master master = Master::spaceball;     ///< the device in the operator's hand
  PhaseFrame frame = PhaseFrame::world;  ///< of the rates and of the direction
  double duration = 1.0;                 ///< [s]
  Twist rates;                           ///< [m/s, rad/s] spaceball: held through the phase
  Vec3 direction = Vec3::UnitX();        ///< torque arm: unit, the way the lever drives the tool
  double lever_rate = 0.0;               ///< [rad/s] torque arm: rate at which the hand leads
};

using Script = std::vector<Phase>;

/// What one period of the operator gives.
struct Command {
  Twist twist;        ///< [m/s, rad/s] asked of the tool, world axes; finite
  bool sound = true;  ///< false: the input was not finite and was taken as rest
};

/// Plays a script, phase after phase, and rests when it is over.
class ScriptedOperator {
 public:
  ScriptedOperator(Script script, const SpaceballOptions& spaceball,
                   const TorqueArmOptions& torque_arm)
      : script_(std::move(script)), spaceball_(spaceball), lever_(torque_arm) {
    transformer_.velocity_scale = torque_arm.velocity_scale;
    transformer_.force_scale = torque_arm.force_scale;
  }

  /// One period on.
  /// @param R_WT orientation of the tool, for phases in its frame
  /// @param felt_W [N] force that the master should reflect, world axes
  [[nodiscard]] Command step(const Mat3& R_WT, const Vec3& felt_W, double period) noexcept {
    while (phase_ < script_.size() && in_phase_ > script_[phase_].duration - 0.5 * period) {
      ++phase_;
      in_phase_ = 0.0;
      lever_.reset();
    }
    in_phase_ += period;
    if (over()) return {spaceball_.step(Twist{}, period), true};
    const Phase& phase = script_[phase_];
    return phase.master == Master::spaceball ? by_ball(phase, R_WT, period)
                                             : by_lever(phase, R_WT, felt_W, period);
  }

  [[nodiscard]] bool over() const noexcept { return phase_ >= script_.size(); }
  /// Index of the phase being played; the number of phases when the script is over.
  [[nodiscard]] std::size_t phase() const noexcept { return phase_; }
  [[nodiscard]] const Script& script() const noexcept { return script_; }
  [[nodiscard]] const TorqueArm& lever() const noexcept { return lever_; }

 private:
  [[nodiscard]] Command by_ball(const Phase& phase, const Mat3& R_WT, double period) noexcept {
    if (!is_finite(phase.rates)) return {spaceball_.step(Twist{}, period), false};
    const bool in_tool = phase.frame == PhaseFrame::tool;
    return {spaceball_.step(in_tool ? rotated(R_WT, phase.rates) : phase.rates, period), true};
  }

  // The direction is fixed when the phase begins: a lever coupled to a turning axis would move the
  // tool without the hand.
  [[nodiscard]] Command by_lever(const Phase& phase, const Mat3& R_WT, const Vec3& felt_W,
                                 double period) noexcept {
    (void)spaceball_.step(Twist{}, period);
    if (in_phase_ <= period) {
      const bool in_tool = phase.frame == PhaseFrame::tool;
      transformer_.direction_W = in_tool ? Vec3(R_WT * phase.direction) : phase.direction;
    }
    const bool sound = phase.lever_rate - phase.lever_rate == 0.0 &&
                       is_finite(transformer_.direction_W) && is_finite(felt_W);
    if (!sound) return {Twist{}, false};
    return {transformer_.flow(lever_.step(phase.lever_rate, transformer_.effort(felt_W), period)),
            true};
  }

  Script script_;
  Spaceball spaceball_;
  TorqueArm lever_;
  Multiplex transformer_;
  std::size_t phase_ = 0;
  double in_phase_ = 0.0;  ///< [s]
};

}  // namespace repel::network
