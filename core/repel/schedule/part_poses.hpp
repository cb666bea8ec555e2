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
  explicit PartPoses(const World& world) : world_(&world), placed_(world.parts().size()) {
    for (std::size_t i = 0; i < placed_.size(); ++i) {
      const Part& part = world.parts()[i];
      placed_[i].X_WP = world.motion().bodies[part.body.index].X_WB * part.X_BP;
      if (part.body == World::fixed) placed_[i].at = forever;
    }
  }

  /// What is asked from here on is asked of another motion than before.
  void begin() noexcept { ++instant_; }

  /// The pose of a part [m] at the motion of this instant. Cost: one product the first time.
  const Pose& at(PartId id, const Motion& motion) noexcept {
    Placed& part = placed_[id.index];
    if (part.at < instant_) place(id, motion);
    return part.X_WP;
  }

  /// The pose of a part [m] when it was last asked for.
  [[nodiscard]] const Pose& last(PartId id) const noexcept { return placed_[id.index].X_WP; }

 private:
  static constexpr std::int64_t forever = INT64_MAX;
  struct alignas(32) Placed {
    Pose X_WP = Pose::Identity();  ///< [m]
    std::int64_t at = 0;           ///< the instant
  };

  [[gnu::noinline]] void place(PartId id, const Motion& motion) noexcept {
    const Part& part = world_->part(id);
    const Pose& X_WB = motion.bodies[part.body.index].X_WB;
    Placed& placed = placed_[id.index];
    for (int k = 0; k < 3; ++k) {
      set_column(placed.X_WP, k, rotate(X_WB, column<double>(part.X_BP, k)));
    }
    set_column(placed.X_WP, 3,
               rotate(X_WB, column<double>(part.X_BP, 3)) + column<double>(X_WB, 3));
    placed.at = instant_;
  }

  const World* world_;
  std::vector<Placed> placed_;  ///< by PartId
  std::int64_t instant_ = 0;
};

}  // namespace repel::detail
