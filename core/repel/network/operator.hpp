/// @file
/// A scripted operator: what a person at the master does, written down so that it can be repeated.
#pragma once

#include <concepts>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <repel/network/signals.hpp>

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
  bool silent = false;                   ///< the device does not answer: its last sample stands
};

using Script = std::vector<Phase>;

/// What one period of the operator gives.
struct Command {
  HandInput hand;           ///< finite
  bool sound = true;        ///< false: the input was not finite and was taken as rest
  double silent_for = 0.0;  ///< [s] age of the sample
};

/// Whoever moves the master: a script, a person at a device, a recording. Nothing throws.
template <class T>
concept Operator = requires(T hands, const T& const_hands, const Mat3& R_WT, double period) {
  { hands.step(R_WT, period) } -> std::convertible_to<const Command&>;  // once a tick; [s]
  { const_hands.phase() } -> std::convertible_to<std::size_t>;          // of a script
};

/// Plays a script, phase after phase, and rests when it is over. The hand that does not lead the
/// lever holds it still.
class ScriptedOperator {
 public:
  explicit ScriptedOperator(Script script) : script_(std::move(script)) {}

  /// One period on.
  /// @param R_WT orientation of the tool, for phases in its frame
  [[nodiscard]] const Command& step(const Mat3& R_WT, double period) noexcept {
    while (phase_ < script_.size() && in_phase_ > script_[phase_].duration - 0.5 * period) {
      ++phase_;
      in_phase_ = 0.0;
    }
    in_phase_ += period;
    if (!over() && script_[phase_].silent) {
      command_.silent_for += period;
      return command_;
    }
    command_.hand.ball = {};
    command_.hand.lever_rate = 0.0;
    command_.silent_for = 0.0;
    command_.sound = over() || read(script_[phase_], R_WT, period);
    return command_;
  }

  [[nodiscard]] bool over() const noexcept { return phase_ >= script_.size(); }
  /// Index of the phase being played; the number of phases when the script is over.
  [[nodiscard]] std::size_t phase() const noexcept { return phase_; }
  [[nodiscard]] const Script& script() const noexcept { return script_; }

 private:
  [[nodiscard]] bool read(const Phase& phase, const Mat3& R_WT, double period) noexcept {
    const bool in_tool = phase.frame == PhaseFrame::tool;
    if (phase.master == Master::spaceball) {
      if (!is_finite(phase.rates)) return false;
      command_.hand.ball = in_tool ? rotated(R_WT, phase.rates) : phase.rates;
      return true;
    }
    const bool finite = is_finite(phase.direction) && phase.lever_rate - phase.lever_rate == 0.0;
    if (!finite) return false;
    // The direction is fixed when the phase begins: a lever coupled to a turning axis would move
    // the tool without the hand.
    if (in_phase_ <= period) {
      command_.hand.direction_W = in_tool ? Vec3(R_WT * phase.direction) : phase.direction;
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
