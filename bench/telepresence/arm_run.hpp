/// @file
/// The PUMA 560, simulated by Bullet, in a scene: tick after tick, without the clock.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <repel/loop/record.hpp>
#include <repel/network/modules.hpp>
#include <repel/network/network.hpp>

namespace repel::telepresence {

/// What a scene of this benchmark is made of. Texts are YAML, as scenes/README.md has it.
struct ArmScene {
  std::string tool;       ///< the parts of the tool, whose frame is 100 mm beyond the flange
  std::string obstacles;  ///< their law is `wall`
  /// The modules before the tool: the masters and what couples them.
  std::string network = free_coupling;
  std::string script{};
  std::string start = "0 45 -180 0 -45 0 deg";  ///< the tool points down, at 0.60 -0.15 0.48 m
  double rate_hz = 400.0;

  /// That of the default scene: firm along, soft enough in rotation for a face to turn flat.
  static constexpr const char* free_coupling =
      "{module: torque_arm}, {module: multiplex}, {module: spaceball}, {module: kbb2, stiffness: 3 "
      "N/mm, damping: 300 N s/m, force_limit: 120 N, angular_stiffness: 30 N m/rad, "
      "angular_damping: 4 N m s/rad, torque_limit: 15 N m}";
};

/// One tick as it was.
struct ArmTick {
  const TickRecord& record;
  const Pose& X_WT;           ///< [m]
  std::span<const double> q;  ///< [rad]
  const network::Network& network;
};

/// What came of a run as a whole.
struct ArmEnd {
  std::string complaint;                        ///< of ledgers and forces; empty: all is well
  std::vector<network::JointRange> ranges{};    ///< [rad] of the joints
  std::array<std::int64_t, 32> status_ticks{};  ///< ticks in which each status bit was set
};

/// Runs `seconds` of the scene.
/// @throws SetupError when the scene cannot be taken
ArmEnd run_arm(const ArmScene& scene, double seconds,
               const std::function<void(const ArmTick&)>& each);

/// A signal over the ticks of a run, and figures of its last second.
struct Trace {
  std::vector<double> samples{};
  double rate_hz = 400.0;

  [[nodiscard]] std::span<const double> last_second() const;
  [[nodiscard]] double mean() const;
  /// Greatest less least, without its mean slope: a creep is no swing.
  [[nodiscard]] double swing() const;
  /// How much it changes in a second, by its mean slope.
  [[nodiscard]] double drift() const;
  /// Root mean square of what is above 30 Hz, where a force is felt as roughness.
  [[nodiscard]] double chatter() const;
};

}  // namespace repel::telepresence
