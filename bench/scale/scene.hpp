// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The benchmark scene: a tool of many convex parts moving among many obstacles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <repel/schedule/coprocessor_options.hpp>
#include <repel/world/world.hpp>

namespace repel::scale {

/// The parameters of a scene.
struct Setting {
  int pairs = 32;
  double near = 3.0;  ///< target for the mean number of pairs within range
  int ticks = 10000;
  int threads = 0;
  CoprocessorMode mode = CoprocessorMode::together;
  int most_threads = 2;  ///< Limits::threads of the world; also the largest of the sweep
  int bodies = 2;        ///< moving bodies: the tool, and bodies that carry obstacles
  double speed = 0.28;   ///< [m/s] of the tool, root mean square
  std::uint64_t seed = 1;
};

/// The pose of a body at a tick.
struct Placement {
  BodyId body;
  Pose X_WB = Pose::Identity();
  Twist V_WB;
};

/// A smooth path in a bounded region: a sum of sines in each coordinate of position and rotation.
class Path {
 public:
  /// @param region [m] largest deviation from `centre` along an axis
  /// @param speed [m/s] root mean square
  Path(const Vec3& centre, double region, double speed, std::uint64_t seed);
  [[nodiscard]] Pose at(double seconds) const;

 private:
  static constexpr int waves = 3;
  struct Wave {
    double amplitude, rate, phase;
  };
  [[nodiscard]] static Vec3 sum(const Wave (&of)[3][waves], double seconds);

  Vec3 centre_;
  Wave position_[3][waves];  ///< [m] by axis
  Wave rotation_[3][waves];  ///< [rad] by axis of the rotation vector
};

/// Speed statistics of the tool.
struct Speed {
  double mean = 0.0;       ///< [m/s]
  double most = 0.0;       ///< [m/s]
  double most_turn = 0.0;  ///< [rad] in a tick
};

/// Pairs every tool part with every obstacle, tool part by tool part, up to the requested number of
/// pairs. Most obstacles are fixed; up to 64 are carried by each other moving body, as closely
/// spaced as the fixed ones.
class Scene {
 public:
  static constexpr double period = 0.0025;  ///< [s] of a tick
  static constexpr double range = 0.03;     ///< [m] of the force
  static constexpr double closest = 0.02;   ///< [m] radius below which the tool shrinks, too

  /// Draws the parts. The obstacles have no place before `spread`.
  explicit Scene(const Setting& setting);

  /// Spreads the obstacles over a ball of `radius` [m], on moving bodies over a smaller ball of
  /// equal density, and lays the paths of the bodies. In a small scene the bodies stray less.
  void spread(double radius);

  [[nodiscard]] World world() const;
  /// Of all moving bodies. Ticks count from 0.
  [[nodiscard]] std::span<const Placement> placements(std::int64_t tick) const;
  [[nodiscard]] Speed speed() const;

  [[nodiscard]] const Setting& setting() const { return setting_; }
  [[nodiscard]] int tool_parts() const { return tool_parts_; }
  [[nodiscard]] int obstacles() const { return static_cast<int>(parts_.size()) - tool_parts_; }
  /// Tool parts first, then obstacles.
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  [[nodiscard]] const ForceLaw& law() const { return law_; }
  /// The pair of a tool part and an obstacle, both counted from 0; it exists when it is below
  /// `setting().pairs`.
  [[nodiscard]] std::int32_t pair(int tool_part, int obstacle) const {
    return tool_part * obstacles() + obstacle;
  }

 private:
  Setting setting_;
  ForceLaw law_{.range = range};
  int tool_parts_;
  int riding_ = 0;  ///< obstacles on each moving body
  std::vector<Part> parts_;
  std::vector<Vec3> tool_places_, places_;  ///< of tool parts and obstacles, in balls of radius 1
  std::vector<Path> paths_;                 ///< by body, without the fixed one
  mutable std::vector<Placement> placements_;
};

}  // namespace repel::scale
