// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The parts and bodies of one side of several pairs, one per SIMD lane.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include <repel/base/lanes.hpp>
#include <repel/pairs/part_poses.hpp>
#include <repel/reduction/convex_shape.hpp>
#include <repel/world/world.hpp>

namespace repel::detail {

/// One side of the pairs of a group: the parts and the bodies they belong to.
class LaneBodies {
 public:
  void set(const World& world, int k, PartId part) noexcept {
    parts_[index(k)] = part;
    shapes_[index(k)] = &world.part(part).shape;
    bodies_[index(k)] = world.part(part).body;
    X_BP_.set(k, world.part(part).X_BP);
    same_body_ = std::all_of(bodies_.begin(), bodies_.end(),
                             [&](BodyId body) { return body == bodies_[0]; });
  }
  /// All lanes have the same body: that of lane 0.
  [[nodiscard]] bool same_body() const noexcept { return same_body_; }
  [[nodiscard]] BodyId body(int k) const noexcept { return bodies_[index(k)]; }
  /// All lanes have the fixed body.
  [[nodiscard]] bool are_fixed() const noexcept { return same_body_ && bodies_[0] == World::fixed; }
  /// The poses of the parts: those of `PartPoses` but for rounding.
  [[nodiscard]] LanePose poses(const Motion& motion) const noexcept {
    LanePose X_WB;
    if (same_body_) {
      X_WB = LanePose::all(state(motion, 0).X_WB);
    } else {
      std::array<const Pose*, lane_count> each;
      for (int k = 0; k < lane_count; ++k) each[index(k)] = &state(motion, k).X_WB;
      X_WB = LanePose::of(each);
    }
    return composed(X_WB, X_BP_);
  }
  [[nodiscard]] PosedShape posed(int k, PartPoses& of, const Motion& motion) const noexcept {
    return {*shapes_[index(k)], of.at(parts_[index(k)], motion)};
  }
  [[nodiscard]] const BodyState& state(const Motion& motion, int k) const noexcept {
    return motion.bodies[bodies_[index(k)].index];
  }

 private:
  [[nodiscard]] static std::size_t index(int k) noexcept { return static_cast<std::size_t>(k); }

  LanePose X_BP_{};  ///< [m]
  std::array<PartId, lane_count> parts_{};
  std::array<BodyId, lane_count> bodies_{};
  std::array<const Shape*, lane_count> shapes_{};
  bool same_body_ = false;
};

}  // namespace repel::detail
