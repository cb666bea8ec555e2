// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The pairs of a world and their forces, in the calling thread: the interface for users.
#pragma once

#include <cstdint>
#include <memory>

#include <repel/pairs/budget.hpp>
#include <repel/pairs/pair_search.hpp>
#include <repel/pairs/pair_set.hpp>

namespace repel {

/// Computes the forces of all pairs of a world, in the thread that asks for them: the search for
/// those that are near, their distances, their forces and the sums for each body. It is what the
/// `Coprocessor` of the machine (repel/schedule/coprocessor.hpp) does without threads, and gives
/// the same bits. All memory is allocated at construction.
class Pairs {
 public:
  /// Evaluates every pair once. Allocates. @param world must outlive this object
  explicit Pairs(const World& world, const Budget& budget = {})
      : world_(&world),
        budget_(budget),
        search_(std::make_shared<const detail::PairIndex>(world)),
        poses_(world),
        set_(world, world.limits().candidates, budget) {
    poses_.begin_tick();
    set_.prime(world.motion(), poses_);
    (void)evaluate({});
  }

  /// The forces at `world.motion()`. Cost: the search, where bodies have moved by its margin, and
  /// the near pairs.
  const PairForces& exchange() noexcept {
    return evaluate(detail::EvaluationLimit::from_now(budget_));
  }

  /// Calls see(NearPair) for each pair that was near at the last exchange, in an unspecified order.
  template <class See>
  void for_each_near(const See& see) const noexcept {
    set_.for_each_near(world_->motion(), see);
  }
  /// The last answer for a pair; a default `Separation`, which bounds nothing, if its slot has been
  /// reused for another pair (`Capacities::candidates`).
  [[nodiscard]] Separation separation_of(PairId id) const noexcept {
    return set_.separation_of(id);
  }
  /// Least distance and largest force of a pair since set-up.
  [[nodiscard]] PairExtremes extremes_of(PairId id) const noexcept { return set_.extremes_of(id); }

 private:
  /// Passes what the search finds to the pairs of this tick.
  struct Sink {
    bool take(PairId id, std::int32_t list, double distance) noexcept {
      return pairs.take(id, list, distance, motion, poses);
    }
    int end(std::int32_t list) noexcept { return pairs.end(list); }
    void drop(std::int32_t list) noexcept { pairs.drop(list); }
    detail::PairSet& pairs;
    const Motion& motion;
    detail::PartPoses& poses;
  };

  const PairForces& evaluate(const detail::EvaluationLimit& limit) noexcept {
    const Motion& motion = world_->motion();
    poses_.begin_tick();
    set_.begin_tick(motion.tick);
    search_.run(motion, Sink{set_, motion, poses_});
    (void)set_.select(motion, poses_, limit);
    set_.evaluate_all(motion, poses_);
    set_.finish(motion, poses_);
    return set_.forces();
  }

  const World* world_;
  Budget budget_;
  detail::PairSearch search_;
  detail::PartPoses poses_;
  detail::PairSet set_;
};

}  // namespace repel
