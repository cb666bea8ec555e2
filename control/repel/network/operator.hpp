// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A scripted operator: a repeatable substitute for a person at the master.
#pragma once

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

  /// [m] Lever arm used to scale pure rotation: the scale of the lever moves the origin of the tool
  /// or a point so far off the axis, whichever is faster. With a scale of 0.1 m/rad the tool turns
  /// by as much as the lever.
  static constexpr double arm = 0.1;

  /// The motion of the tool per motion that the lever's scale states: the linear part without unit,
  /// of length one or less, the angular one [rad/m]. @param direction unit
  [[nodiscard]] Twist per_motion(const Vec3& direction) const noexcept;
};

/// A lever and the motion it gives the tool.
struct LeverMotion {
  Vec3 direction{1, 0, 0};  ///< unit, in the frame of the phase: in which the tool is driven
  double rate = 0.0;        ///< [rad/s] of the hand
};

/// Sentinel for a set of bits: keep that of the previous phase.
inline constexpr std::int32_t as_before = -2;

/// One phase of the script.
struct Phase {
  std::string name{};                    ///< shown in the progress line and the log
  Master master = Master::spaceball;     ///< the device in the operator's hand
  PhaseFrame frame = PhaseFrame::world;  ///< of the rates and of the direction
  double duration = 1.0;                 ///< [s]
  Twist rates{};            ///< [m/s, rad/s] spaceball, six axes: constant through the phase
  Vec3 direction{1, 0, 0};  ///< torque arm: unit, direction of the tool driven by the lever
  /// Torque arm: the lever screws the tool about an axis along `direction`, fixed to the tool.
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
  [[nodiscard]] bool is_silent(double patience) const noexcept;
};

/// Plays a script, phase after phase, and gives zero input when it is over. The hand holds the
/// lever still unless a torque-arm phase moves it.
class ScriptedOperator {
 public:
  /// At the beginning of the script.
  explicit ScriptedOperator(Script script) : script_(std::move(script)) {}

  /// Advances by one period and returns its input.
  /// @param R_WT orientation of the tool, for phases in its frame
  [[nodiscard]] const Command& step(const Mat3& R_WT, double period) noexcept;

  /// The last phase has ended.
  [[nodiscard]] bool over() const noexcept { return phase_ >= script_.size(); }
  /// Index of the phase being played; the number of phases when the script is over.
  [[nodiscard]] std::size_t phase() const noexcept { return phase_; }
  [[nodiscard]] const Script& script() const noexcept { return script_; }  ///< as it was given

 private:
  // What stays from phase to phase.
  void switch_over(const Phase& phase) noexcept;
  [[nodiscard]] bool read(const Phase& phase, const Mat3& R_WT, double period) noexcept;

  /// The axis is fixed to the tool from the start of the phase on: a screw about it leaves the axis
  /// at rest in the world, so the tool stays on it.
  void follow_screw(const Phase& phase, const Mat3& R_WT, bool begins) noexcept;

  Script script_;
  Command command_;
  std::size_t phase_ = 0;
  double in_phase_ = 0.0;  ///< [s]
  Twist screw_T_;          ///< of the phase, in axes of the tool
};

}  // namespace repel::network
