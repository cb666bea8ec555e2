// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The poses of parts at one tick, computed lazily.
#pragma once

#include <cstdint>
#include <vector>

#include <repel/world/world.hpp>

namespace repel::detail {

/// Cache of the world poses of a world's parts. All memory is allocated at construction.
class PartPoses {
 public:
  explicit PartPoses(const World& world) : world_(&world), cached_(world.parts().size()) {
    for (std::size_t i = 0; i < cached_.size(); ++i) {
      const Part& part = world.parts()[i];
      cached_[i].X_WP = composed(world.motion().bodies[part.body.index].X_WB, part.X_BP);
      if (part.body == World::fixed) cached_[i].at = forever;
    }
  }

  /// Begins a tick: invalidates the cached poses, except those of fixed parts.
  void begin_tick() noexcept { ++now_; }

  /// The pose of a part [m] at this tick. Cost: a pose product at the first call per tick.
  /// @param motion that of this tick, the same in all calls
  const Pose& at(PartId id, const Motion& motion) noexcept {
    Cached& part = cached_[id.index];
    if (part.at < now_) compute(id, motion);
    return part.X_WP;
  }

  /// The pose of a part [m] last returned by `at`; before its first call, that at construction.
  [[nodiscard]] const Pose& last(PartId id) const noexcept { return cached_[id.index].X_WP; }

 private:
  static constexpr std::int64_t forever = INT64_MAX;
  struct alignas(64) Cached {
    Pose X_WP = Pose::Identity();  ///< [m]
    std::int64_t at = 0;           ///< the tick, on the scale of `now_`
  };

  [[gnu::noinline]] void compute(PartId id, const Motion& motion) noexcept {
    const Part& part = world_->part(id);
    const Pose& X_WB = motion.bodies[part.body.index].X_WB;
    Cached& cached = cached_[id.index];
    for (int k = 0; k < 3; ++k) {
      set_column(cached.X_WP, k, rotate(X_WB, column<double>(part.X_BP, k)));
    }
    set_column(cached.X_WP, 3,
               rotate(X_WB, column<double>(part.X_BP, 3)) + column<double>(X_WB, 3));
    cached.at = now_;
  }

  const World* world_;
  std::vector<Cached> cached_;  ///< by PartId
  std::int64_t now_ = 0;
};

}  // namespace repel::detail
