/// @file
/// The parts and bodies of one side of several pairs, one per SIMD lane.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include <repel/base/lanes.hpp>
#include <repel/pairs/part_poses.hpp>
#include <repel/reduction/shape.hpp>
#include <repel/world/world.hpp>

namespace repel::detail {

/// One side of the pairs of a group: the parts and the bodies they belong to.
class LaneBodies {
 public:
  void set(const World& world, int k, PartId part) noexcept {
    parts_[index(k)] = part;
    shapes_[index(k)] = &world.part(part).shape;
    bodies_[index(k)] = world.part(part).body;
    same_body_ = std::all_of(bodies_.begin(), bodies_.end(),
                             [&](BodyId body) { return body == bodies_[0]; });
  }
  /// All lanes have the same body: that of lane 0.
  [[nodiscard]] bool same_body() const noexcept { return same_body_; }
  [[nodiscard]] BodyId body(int k) const noexcept { return bodies_[index(k)]; }
  /// All lanes have the fixed body.
  [[nodiscard]] bool are_fixed() const noexcept { return same_body_ && bodies_[0] == World::fixed; }
  [[nodiscard]] LanePose poses(PartPoses& of, const Motion& motion) const noexcept {
    std::array<const Pose*, lane_count> X_WP;
    for (std::size_t k = 0; k < X_WP.size(); ++k) X_WP[k] = &of.at(parts_[k], motion);
    return LanePose::of(X_WP);
  }
  [[nodiscard]] PosedShape posed(int k, PartPoses& of, const Motion& motion) const noexcept {
    return {*shapes_[index(k)], of.at(parts_[index(k)], motion)};
  }
  [[nodiscard]] const BodyState& state(const Motion& motion, int k) const noexcept {
    return motion.bodies[bodies_[index(k)].index];
  }

 private:
  [[nodiscard]] static std::size_t index(int k) noexcept { return static_cast<std::size_t>(k); }

  std::array<PartId, lane_count> parts_{};
  std::array<BodyId, lane_count> bodies_{};
  std::array<const Shape*, lane_count> shapes_{};
  bool same_body_ = false;
};

}  // namespace repel::detail
