/// @file
/// Where the parts are at one instant, worked out for those that are asked for.
#pragma once

#include <cstdint>
#include <vector>

#include <repel/world/world.hpp>

namespace repel::detail {

/// The poses of a world's parts in the world. All memory is taken at construction.
class PartPoses {
 public:
  explicit PartPoses(const World& world)
      : world_(&world), X_WP_(world.parts().size()), placed_at_(X_WP_.size(), 0) {
    for (std::size_t i = 0; i < X_WP_.size(); ++i) {
      const Part& part = world.parts()[i];
      X_WP_[i] = world.motion().bodies[part.body.index].X_WB * part.X_BP;
      if (part.body == World::fixed) placed_at_[i] = forever;
    }
  }

  /// What is asked from here on is asked of another motion than before.
  void begin() noexcept { ++instant_; }

  /// The pose of a part [m] at the motion of this instant. Cost: one product the first time.
  const Pose& at(PartId id, const Motion& motion) noexcept {
    std::int64_t& placed_at = placed_at_[id.index];
    if (placed_at < instant_) {
      const Part& part = world_->part(id);
      X_WP_[id.index] = motion.bodies[part.body.index].X_WB * part.X_BP;
      placed_at = instant_;
    }
    return X_WP_[id.index];
  }

  /// The pose of a part [m] when it was last asked for.
  [[nodiscard]] const Pose& last(PartId id) const noexcept { return X_WP_[id.index]; }

 private:
  static constexpr std::int64_t forever = INT64_MAX;

  const World* world_;
  std::vector<Pose> X_WP_;               ///< [m] by PartId
  std::vector<std::int64_t> placed_at_;  ///< the instant, by PartId
  std::int64_t instant_ = 0;
};

}  // namespace repel::detail
