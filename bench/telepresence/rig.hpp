/// @file
/// A hand, a network and a slider before a wall: what the parts measure on.
#pragma once

#include <string>

#include <repel/force/law.hpp>
#include <repel/network/modules.hpp>
#include <repel/network/plan.hpp>

#include "slider.hpp"

namespace repel::telepresence {

/// How hand and slider are joined.
enum class Way {
  direct,  ///< the coupling alone
  waves,   ///< a line of waves
  plain,   ///< a line that carries velocity one way and force the other
};

[[nodiscard]] const char* name_of(Way way);

/// A wall of stiffness K [N/m] and damping [N s/m] that is linear from 1 N on: the force law with a
/// range of 2 N / K.
[[nodiscard]] ForceLaw stiff_wall(double stiffness, double damping);

struct RigOptions {
  double rate_hz = 1000.0;
  Way way = Way::direct;
  network::ChannelOptions channel{};         ///< of a line
  double buffer = -1.0;                      ///< [s] of a line of waves; below zero: its default
  ForceLaw wall = stiff_wall(50000.0, 5.0);  ///< on the slider
  double wall_at = 0.05;                     ///< [m] the slider starts at 0
  double resolution = 0.0;                   ///< [m] of the slider's position as measured
  SliderOptions slider{};                    ///< the arm
  static constexpr double hand_mass = 1.5;   ///< [kg] with the lever in it
  static constexpr double hand_stiffness = 400;   ///< [N/m]
  static constexpr double hand_damping = 20.0;    ///< [N s/m]
  static constexpr double force_limit = 150.0;    ///< [N] of the coupling and of the lever's motor
  static constexpr double line_impedance = 40.0;  ///< Z and the shunt B2 at its end [N s/m]
};

/// What a tick has shown.
struct Sample {
  double lever = 0.0;        ///< [m] position of hand and lever
  double lever_speed = 0.0;  ///< [m/s] of the same
  double felt = 0.0;         ///< [N] of the lever's motor, against the hand
  double slider = 0.0;       ///< [m]
  double wall = 0.0;         ///< [N] of the wall on the slider, out of it
};

/// The modules between hand and joints as `Plan` builds them: TORQUE ARM of one metre per radian,
/// MULTIPLEX, perhaps LINE, KBB2, OBSTACLE, PUMA_KIN, PUMA_JOINTS; behind them a slider whose force
/// is held from tick to tick.
class Rig {
 public:
  explicit Rig(const RigOptions& options);

  /// One tick, the hand leading at `hand_speed` [m/s].
  Sample tick(double hand_speed);
  [[nodiscard]] double period() const { return signals_.period; }  ///< [s]
  /// [s] that the line waits for late packets; 0 without one of waves.
  [[nodiscard]] double buffer() const;
  /// [s] from one end of the line to the other; 0 without one.
  [[nodiscard]] double transit() const;
  /// The lowest energy of the line's ledger [J], below zero where it made energy; 0 without one.
  [[nodiscard]] double least_of_line() const;
  /// What is wrong: a tick not solved, a number that is not finite, a passive module that gave more
  /// than it took by over 1e-9 of what passed. Empty when nothing is.
  [[nodiscard]] std::string complaint() const;

 private:
  RigOptions options_;
  network::Network network_;
  network::Signals signals_;
  network::MeasuredFlow flow_{1};
  Slider slider_;
  bool sound_ = true;
};

}  // namespace repel::telepresence
