// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Changes of a running world from another thread: parts that come, move, are held and go.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <repel/base/ring.hpp>
#include <repel/reduction/separation.hpp>
#include <repel/schedule/coprocessor.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// What has become of the changes of a `WorldChanges` so far.
struct ChangeCounts {
  std::int64_t applied = 0;  ///< done by the tick
  std::int64_t refused = 0;  ///< the state of the part did not allow it: World::move, attach, ...
  std::int64_t waited = 0;   ///< ticks in which a change waited for threads to let go of a shape
};

/// Some of the reserved parts of a world, one after the other in the order of World::loose. By
/// default all.
struct ReservedShare {
  std::size_t first = 0;                             ///< index in World::loose
  std::size_t count = static_cast<std::size_t>(-1);  ///< at most; fewer if there are not so many
};

/// A wait-free queue of changes between one thread that asks for them and the thread of the tick,
/// which applies them between two ticks, in their order. The asking thread may allocate, the tick
/// allocates and frees nothing: shapes that are no longer used come back through the queue. The
/// parts are those reserved at set-up (World::reserve). Allocates at construction.
class WorldChanges {
 public:
  static constexpr double usual_time = 0.2;    ///< [s] for parts to come, to go and to change hands
  static constexpr double usual_speed = 0.25;  ///< [m/s] of parts that are moved

  /// @param capacity of changes that wait, 1 to 2^30 @param levels of new shapes, if the measure
  /// needs them; at least 1
  explicit WorldChanges(const World& world, std::size_t capacity = 256,
                        int levels = ReductionOptions{}.levels)
      : world_(&world), levels_(levels), ring_(capacity, Change{}) {
    for (const detail::LoosePart& loose : world.loose()) {
      const bool keeps_shape = loose.room <= world.part(loose.part).shape.reach();
      parts_.push_back({loose.part, loose.room, keeps_shape, world.is_there(loose.part)});
      since_.push_back(0);
    }
  }

  // The next five: one thread, the same for all. Each returns false, or an invalid id, and nothing
  // is changed, if the queue is full, the part is none of those reserved, or a number is not within
  // what World takes; a change whose turn comes when the part's state does not allow it is counted
  // as refused.

  /// Lets a new part come, in the reserved part that has been free the longest of those with room
  /// for it and for more than the shape they were reserved with. Invalid if there is none, too.
  /// @param shape without levels or with; they are made here if the measure of the world needs them
  /// @param X_WP [m] @param over [s] see World::add @param share of the reserved parts, of which
  /// one is taken
  PartId add(const Shape& shape, const Pose& X_WP, double over = usual_time,
             const ReservedShare& share = {}) {
    if (!is_pose(X_WP) || !is_time(over)) return {};
    Reserved* chosen = nullptr;
    const std::size_t begin = std::min(share.first, parts_.size());
    const std::size_t end = begin + std::min(share.count, parts_.size() - begin);
    for (std::size_t i = begin; i < end; ++i) {
      Reserved& part = parts_[i];
      if (part.keeps_shape || part.is_used || !(shape.reach() <= part.room)) continue;
      if (chosen == nullptr || part.freed_at < chosen->freed_at) chosen = &part;
    }
    if (chosen == nullptr) return {};
    Change& change = ring_.draft();
    change = {.what = What::fit, .part = chosen->id, .X_WP = X_WP, .over = over, .shape = shape};
    if (needs_levels(shape, world_->query_options().measure)) {
      ReductionOptions reduction = shape.reduction();
      reduction.levels = levels_;
      change.shape = shape.reduced(reduction);
    }
    if (!ring_.post()) return {};
    chosen->is_used = true;
    return chosen->id;
  }
  /// Lets a reserved part come with the shape that it has. @param X_WP [m] @param over [s]
  bool add(PartId id, const Pose& X_WP, double over = usual_time) {
    Reserved* const part = find(id);
    if (part == nullptr || !is_pose(X_WP) || !is_time(over)) return false;
    if (!post({.what = What::add, .part = id, .X_WP = X_WP, .over = over})) return false;
    return part->is_used = true;
  }
  /// Moves a part to a pose [m] at a speed [m/s]: World::move.
  bool move(PartId id, const Pose& X_WP, double speed = usual_speed) {
    return find(id) != nullptr && is_pose(X_WP) && detail::LooseParts::is_speed(speed) &&
           post({.what = What::move, .part = id, .X_WP = X_WP, .over = speed});
  }
  /// Lets a tool take a part: World::attach.
  bool attach(PartId id, BodyId tool, double over = usual_time) {
    return find(id) != nullptr && is_time(over) &&
           post({.what = What::attach, .part = id, .tool = tool, .over = over});
  }
  /// Lets the tool that holds a part put it down: World::release.
  bool release(PartId id, double over = usual_time) {
    return find(id) != nullptr && is_time(over) &&
           post({.what = What::release, .part = id, .over = over});
  }
  /// Lets a part go, and its place be used again: World::remove.
  bool remove(PartId id, double over = usual_time) {
    Reserved* const part = find(id);
    if (part == nullptr || !is_time(over)) return false;
    if (!post({.what = What::remove, .part = id, .over = over})) return false;
    part->is_used = false;
    part->freed_at = ++freed_;
    return true;
  }

  /// The thread of the tick, just before the bodies are placed for the next exchange: applies the
  /// changes that have come, up to `most`. One that needs a shape to be let go by the part's last
  /// user and by all threads waits for that, and those behind it with it; so does one for a part
  /// that has not gone yet. Cost: a look at each reserved part; for each change what `World` says.
  void apply(World& world, Coprocessor& coprocessor, int most = 64) noexcept {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      // The exchange to come is the first in which it is absent.
      if (world.is_there(world.loose()[i].part)) since_[i] = coprocessor.exchanges() + 1;
    }
    for (int k = 0; k < most; ++k) {
      Change* const change = ring_.front();
      if (change == nullptr) return;
      if (must_wait(world, coprocessor, *change)) {
        ++counts_.waited;
        return;
      }
      (make(world, *change) ? counts_.applied : counts_.refused) += 1;
      ring_.pop();
    }
  }
  /// The thread of the tick.
  [[nodiscard]] const ChangeCounts& counts() const noexcept { return counts_; }
  /// Any thread: changes that were lost because the queue was full.
  [[nodiscard]] std::int64_t dropped() const noexcept { return ring_.dropped(); }

 private:
  enum class What : std::uint8_t { fit, add, move, attach, release, remove };
  struct Change {
    What what = What::remove;
    PartId part{};
    BodyId tool{};
    Pose X_WP = Pose::Identity();
    double over = 0.0;  ///< [s], of a move [m/s]
    Shape shape = Shape::sphere(0.0);
  };
  /// What the asking thread knows of a reserved part.
  struct Reserved {
    PartId id;
    double room = 0.0;         ///< [m]
    bool keeps_shape = false;  ///< it was reserved with no more room than its shape needs
    bool is_used = false;
    std::int64_t freed_at = 0;
  };

  [[nodiscard]] static bool is_time(double over) noexcept {
    return detail::LooseParts::is_time(over);
  }
  [[nodiscard]] static bool is_pose(const Pose& X) noexcept {
    return is_finite(X) && is_rigid(X, 1e-6);
  }
  [[nodiscard]] Reserved* find(PartId id) noexcept {
    const auto found = std::find_if(parts_.begin(), parts_.end(),
                                    [&](const Reserved& part) { return part.id == id; });
    return found == parts_.end() ? nullptr : &*found;
  }
  bool post(Change&& change) {
    ring_.draft() = std::move(change);
    return ring_.post();
  }

  [[nodiscard]] bool must_wait(World& world, Coprocessor& coprocessor,
                               const Change& change) const noexcept {
    if (change.what != What::fit && change.what != What::add) return false;
    const bool is_leaving = world.is_leaving(change.part);
    if (change.what == What::add || is_leaving) return is_leaving;
    if (world.is_there(change.part)) return false;  // and stays: the change is refused
    for (std::size_t i = 0; i < since_.size(); ++i) {
      if (world.loose()[i].part == change.part) return !coprocessor.is_past(since_[i]);
    }
    return false;
  }
  static bool make(World& world, Change& change) noexcept {
    switch (change.what) {
      case What::fit:
        return world.refit(change.part, change.shape) &&
               world.add(change.part, change.X_WP, change.over);
      case What::add:
        return world.add(change.part, change.X_WP, change.over);
      case What::move:
        return world.move(change.part, change.X_WP, change.over);
      case What::attach:
        return world.attach(change.part, change.tool, change.over);
      case What::release:
        return world.release(change.part, change.over);
      case What::remove:
        break;
    }
    return world.remove(change.part, change.over);
  }

  const World* world_;
  int levels_;
  Ring<Change> ring_;
  // Of the asking thread:
  std::vector<Reserved> parts_;
  std::int64_t freed_ = 0;
  // Of the thread of the tick:
  std::vector<std::int64_t> since_;  ///< the first exchange in which each part is absent
  ChangeCounts counts_;
};

}  // namespace repel
