// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Changes of a running world from another thread: parts that come, move, are held and go.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <repel/base/ring.hpp>
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
                        int levels = ReductionOptions{}.levels);

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
             const ReservedShare& share = {});
  /// Lets a reserved part come with the shape that it has. @param X_WP [m] @param over [s]
  bool add(PartId id, const Pose& X_WP, double over = usual_time);
  /// Moves a part to a pose [m] at a speed [m/s]: World::move.
  bool move(PartId id, const Pose& X_WP, double speed = usual_speed);
  /// Lets a tool take a part: World::attach.
  bool attach(PartId id, BodyId tool, double over = usual_time);
  /// Lets the tool that holds a part put it down: World::release.
  bool release(PartId id, double over = usual_time);
  /// Lets a part go, and its place be used again: World::remove.
  bool remove(PartId id, double over = usual_time);

  /// The thread of the tick, just before the bodies are placed for the next exchange: applies the
  /// changes that have come, up to `most`. One that needs a shape to be let go by the part's last
  /// user and by all threads waits for that, and those behind it with it; so does one for a part
  /// that has not gone yet. Cost: a look at each reserved part; for each change what `World` says.
  void apply(World& world, Coprocessor& coprocessor, int most = 64) noexcept;
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

  [[nodiscard]] static bool is_time(double over) noexcept;
  [[nodiscard]] static bool is_pose(const Pose& X) noexcept;
  [[nodiscard]] Reserved* find(PartId id) noexcept;
  bool post(Change&& change);

  [[nodiscard]] bool must_wait(World& world, Coprocessor& coprocessor,
                               const Change& change) const noexcept;
  static bool make(World& world, Change& change) noexcept;

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
