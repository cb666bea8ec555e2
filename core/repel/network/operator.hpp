/// @file
/// A scripted operator: a repeatable substitute for a person at the master.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <repel/network/elements/signals.hpp>

namespace repel::network {

enum class Master {
  spaceball,   ///< six rates, no force feedback
  torque_arm,  ///< one lever with force feedback
  six_axes,    ///< six rates of a hand, with force feedback
};

/// Frame in which a phase states its directions.
enum class PhaseFrame { world, tool };

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
  double lever_rate = 0.0;  ///< [rad/s] torque arm: rate of the hand
  double scale = 0.0;       ///< HandInput::scale from here on; 0: as before
  std::int32_t guides = as_before;  ///< HandInput::guides from here on
  double guide_strength = -1.0;     ///< HandInput::guide_strength from here on; below 0: as before
  std::int32_t compliant = as_before;  ///< HandInput::compliant from here on
  bool silent = false;              ///< the device does not respond: its last sample is held
};

using Script = std::vector<Phase>;

/// The operator's input of one period.
struct Command {
  HandInput hand{};         ///< if not finite: taken as rest, and a fault
  bool sound = true;        ///< false: the source reports that its data are invalid
  double silent_for = 0.0;  ///< [s] age of the sample
  std::int32_t phase = 0;   ///< of a script; copied to the record
};

/// Plays a script, phase after phase, and gives zero input when it is over. The hand holds the
/// lever still unless a torque-arm phase moves it.
class ScriptedOperator {
 public:
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
    command_.hand.ball = {};
    command_.hand.lever_rate = 0.0;
    if (!over()) switch_over(script_[phase_]);
    command_.silent_for = 0.0;
    command_.sound = over() || read(script_[phase_], R_WT, period);
    return command_;
  }

  [[nodiscard]] bool over() const noexcept { return phase_ >= script_.size(); }
  /// Index of the phase being played; the number of phases when the script is over.
  [[nodiscard]] std::size_t phase() const noexcept { return phase_; }
  [[nodiscard]] const Script& script() const noexcept { return script_; }

 private:
  // What stays from phase to phase.
  void switch_over(const Phase& phase) noexcept {
    if (phase.scale > 0.0) command_.hand.scale = phase.scale;
    if (phase.guides != as_before) command_.hand.guides = phase.guides;
    if (phase.compliant != as_before) command_.hand.compliant = phase.compliant;
    if (phase.guide_strength >= 0.0) command_.hand.guide_strength = phase.guide_strength;
  }
  [[nodiscard]] bool read(const Phase& phase, const Mat3& R_WT, double period) noexcept {
    const bool in_tool = phase.frame == PhaseFrame::tool;
    if (phase.master != Master::torque_arm) {
      if (!is_finite(phase.rates)) return false;
      command_.hand.ball = in_tool ? rotated(R_WT, phase.rates) : phase.rates;
      return true;
    }
    const bool finite = is_finite(phase.direction) && phase.lever_rate - phase.lever_rate == 0.0;
    if (!finite) return false;
    // The direction is fixed at the start of the phase: a lever coupled to a rotating axis would
    // move the tool without any motion of the hand.
    if (in_phase_ <= period) {
      command_.hand.direction_W = in_tool ? R_WT * phase.direction : phase.direction;
    }
    command_.hand.lever_rate = phase.lever_rate;
    return true;
  }

  Script script_;
  Command command_;
  std::size_t phase_ = 0;
  double in_phase_ = 0.0;  ///< [s]
};

}  // namespace repel::network
