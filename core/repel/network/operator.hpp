/// @file
/// A scripted operator: what a person at the master does, written down so that it can be repeated.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <repel/base/spatial.hpp>

namespace repel::network {

enum class Master {
  spaceball,   ///< six rates, nothing is felt
  torque_arm,  ///< one lever, which pushes back
};

/// Frame in which a phase states its directions.
enum class PhaseFrame { world, tool };

/// One stretch of the script.
struct Phase {
  std::string name;                         ///< shown in the progress line and the log
  Master master = Master::spaceball;        ///< the device in the operator's hand
  PhaseFrame frame = PhaseFrame::world;     ///< of the rates and of the direction
  double duration = 1.0;                    ///< [s]
  Twist rates;                              ///< [m/s, rad/s] spaceball: held through the phase
  Vec3 direction = Vec3::UnitX();           ///< torque arm: unit, the way the lever drives the tool
  double lever_rate = 0.0;                  ///< [rad/s] torque arm: rate at which the hand leads
};

using Script = std::vector<Phase>;

}  // namespace repel::network
