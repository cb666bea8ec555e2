// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The PUMA 560, simulated by Bullet, in a scene: tick after tick, not in real time.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <repel/loop/record.hpp>
#include <repel/network/modules.hpp>
#include <repel/network/network.hpp>

namespace repel::telepresence {

/// The parts of a benchmark scene. Texts are YAML as described in scenes/README.md.
struct ArmScene {
  std::string tool;       ///< the parts of the tool, whose frame is 100 mm beyond the flange
  std::string obstacles;  ///< their law is `wall`
  /// The modules before the tool: the masters and their coupling.
  std::string network = free_coupling;
  std::string script{};
  std::string start = "0 45 -180 0 -45 0 deg";  ///< the tool points down, at 0.60 -0.15 0.48 m
  double rate_hz = 400.0;
  /// Without it the model that the cell has of the arm is without dry friction.
  bool compensates_friction = true;
  double encoder = 0.0;  ///< [rad] steps of the joint angles as read, rates being their
                         ///< differences; 0: both exact

  /// The coupling of the default scene: stiff in translation, and soft enough in rotation that a
  /// face can align with a wall.
  static constexpr const char* free_coupling =
      "{module: torque_arm}, {module: multiplex}, {module: spaceball}, {module: kbb2, stiffness: 3 "
      "N/mm, damping: 300 N s/m, force_limit: 120 N, angular_stiffness: 30 N m/rad, "
      "angular_damping: 4 N m s/rad, torque_limit: 15 N m}";
};

/// The state at one tick.
struct ArmTick {
  const TickRecord& record;
  const Pose& X_WT;           ///< [m]
  std::span<const double> q;  ///< [rad]
  const network::Network& network;
};

/// The results of a whole run.
struct ArmEnd {
  std::string complaint;                        ///< fault of ledgers or forces; empty: none
  std::vector<network::JointRange> ranges{};    ///< [rad] of the joints
  std::vector<double> dry_friction{};           ///< [N m] of the joints
  std::array<std::int64_t, 32> status_ticks{};  ///< ticks in which each status bit was set
};

/// Runs `seconds` of the scene.
/// @throws SetupError if the scene is invalid
ArmEnd run_arm(const ArmScene& scene, double seconds,
               const std::function<void(const ArmTick&)>& each);

/// A signal over the ticks of a run, with statistics of its last second.
struct Trace {
  std::vector<double> samples{};
  double rate_hz = 400.0;

  [[nodiscard]] std::span<const double> last_second() const;
  [[nodiscard]] double mean() const;
  /// Peak to peak after subtraction of the mean slope, so that drift does not count.
  [[nodiscard]] double swing() const;
  /// Change per second, by the mean slope.
  [[nodiscard]] double drift() const;
  /// Root mean square of the content above 30 Hz, where a force is felt as roughness.
  [[nodiscard]] double chatter() const;
  /// Largest change from one tick to the next, without sign.
  [[nodiscard]] double jump() const;
};

}  // namespace repel::telepresence
