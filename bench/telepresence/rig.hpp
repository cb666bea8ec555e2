// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The test rig of the parts: a hand, a network, and a slider in front of a wall.
#pragma once

#include <string>

#include <repel/force/law.hpp>
#include <repel/network/modules.hpp>
#include <repel/network/plan.hpp>

#include "slider.hpp"

namespace repel::telepresence {

/// The connection between hand and slider.
enum class Way {
  direct,  ///< the coupling alone
  waves,   ///< a line of wave variables
  plain,   ///< a line that transmits velocity one way and force the other
};

[[nodiscard]] const char* name_of(Way way);

/// A wall of stiffness K [N/m] and damping [N s/m] that is linear above 1 N: the force law with a
/// range of 2 N / K.
[[nodiscard]] ForceLaw stiff_wall(double stiffness, double damping);

struct RigOptions {
  double rate_hz = 1000.0;
  Way way = Way::direct;
  network::ChannelOptions channel{};         ///< of the line
  double buffer = -1.0;                      ///< [s] of a line of waves; negative: its default
  ForceLaw wall = stiff_wall(50000.0, 5.0);  ///< on the slider
  double wall_at = 0.05;                     ///< [m] the slider starts at 0
  double resolution = 0.0;                   ///< [m] quantization of the measured slider position
  SliderOptions slider{};                    ///< the arm
  static constexpr double hand_mass = 1.5;   ///< [kg] including the lever
  static constexpr double hand_stiffness = 400;   ///< [N/m]
  static constexpr double hand_damping = 20.0;    ///< [N s/m]
  static constexpr double force_limit = 150.0;    ///< [N] of the coupling and of the lever's motor
  static constexpr double line_impedance = 40.0;  ///< Z and the shunt B2 at its end [N s/m]
};

/// The state at one tick.
struct Sample {
  double lever = 0.0;        ///< [m] position of hand and lever
  double lever_speed = 0.0;  ///< [m/s] of the same
  double felt = 0.0;         ///< [N] of the lever's motor, against the hand
  double slider = 0.0;       ///< [m]
  double wall = 0.0;         ///< [N] of the wall on the slider, out of it
  double drive = 0.0;        ///< [N] commanded to the joint of the slider
};

/// The modules between hand and joints as built by `Plan`: TORQUE ARM of one metre per radian,
/// MULTIPLEX, optionally LINE, KBB2, OBSTACLE, PUMA_KIN, PUMA_JOINTS; then a slider whose force is
/// held between ticks.
class Rig {
 public:
  explicit Rig(const RigOptions& options);

  /// One tick with the hand moving at `hand_speed` [m/s].
  Sample tick(double hand_speed);
  [[nodiscard]] double period() const { return signals_.period; }  ///< [s]
  /// [s] How long the line waits for late packets; 0 without a line of waves.
  [[nodiscard]] double buffer() const;
  /// [s] One-way delay of the line; 0 without one.
  [[nodiscard]] double transit() const;
  /// The lowest energy in the line's ledger [J], negative if it generated energy; 0 without a line.
  [[nodiscard]] double least_of_line() const;
  /// The fault, or empty: a tick not solved, a number that is not finite, or a passive module that
  /// delivered more energy than it absorbed, by over 1e-9 of the energy passed.
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
