// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Parts that come and go, move and are held while the world runs: what happens to them over time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <repel/base/ids.hpp>
#include <repel/base/rotation.hpp>
#include <repel/force/law.hpp>
#include <repel/world/body_state.hpp>

namespace repel::detail {

/// Moves a number towards `end` at its rate, which is zero afterwards. @param dt [s]
inline void advance(Ramp& ramp, double end, double dt) noexcept {
  ramp.before = ramp.now;
  if (ramp.rate == 0.0) return;
  const bool arrives = std::abs(end - ramp.now) <= std::abs(ramp.rate * dt);
  ramp.now = arrives ? end : ramp.now + ramp.rate * dt;
  if (arrives) ramp.rate = 0.0;
}

/// A motion along a straight line, with an even turn, from one pose to another.
struct PoseMove {
  Pose from = Pose::Identity();  ///< [m]
  Pose to = Pose::Identity();    ///< [m]
  double over = 0.0;             ///< [s] the whole of it; 0: there is none
  double at = 0.0;               ///< [s] since its beginning

  [[nodiscard]] Pose pose() const noexcept {
    const double share = at < over ? at / over : 1.0;
    if (share >= 1.0) return to;
    return posed(between(rotation(from), rotation(to), share),
                 (1.0 - share) * origin(from) + share * origin(to));
  }
  /// [m/s, rad/s] of the origin
  [[nodiscard]] Twist twist() const noexcept {
    if (!(at < over)) return {};
    const Turn turn = turn_of(rotation(to) * transposed(rotation(from)));
    return {(origin(to) - origin(from)) / over, turn.angle / over * turn.axis};
  }
};

/// What a world knows of a part that comes and goes, beside the state of its body.
struct LoosePart {
  PartId part;
  BodyId body;
  double room = 0.0;             ///< [m] largest reach of a shape that it can have
  double mass = 0.0;             ///< [kg] at the origin of its body
  bool is_mass_known = true;     ///< to the controllers of arms, not only to simulated ones
  PoseMove move{};               ///< while it lies free
  Pose X_TB = Pose::Identity();  ///< [m] in the tool that holds it
  std::vector<PairId> pairs{};   ///< of this part
};

/// The parts of a world that come and go. The functions are those of `World` (world.hpp), which
/// documents them. Only `reserve` allocates.
class LooseParts {
 public:
  static constexpr double longest_time = 3600.0;  ///< [s] in which parts come, go or change hands
  static constexpr double least_speed = 1e-6;     ///< [m/s] of parts that are moved
  static constexpr double greatest_speed = 10.0;  ///< [m/s]

  /// A part can come, go or change hands in it. @param over [s]
  [[nodiscard]] static bool is_time(double over) noexcept {
    return over >= 0.0 && over <= longest_time;
  }
  /// A part can be moved at it. @param speed [m/s]
  [[nodiscard]] static bool is_speed(double speed) noexcept {
    return speed >= least_speed && speed <= greatest_speed;
  }

  void reserve(PartId part, BodyId body, double room) {
    all_.push_back({.part = part, .body = body, .room = room});
  }

  [[nodiscard]] const std::vector<LoosePart>& all() const noexcept { return all_; }
  /// Null for a part that is none of these.
  [[nodiscard]] LoosePart* find(PartId id) noexcept {
    const auto is_before = [](const LoosePart& loose, std::int32_t i) {
      return loose.part.index < i;
    };
    const auto found = std::lower_bound(all_.begin(), all_.end(), id.index, is_before);
    return found != all_.end() && found->part == id ? &*found : nullptr;
  }

  bool add(Motion& motion, PartId id, const Pose& X_WB, double over) noexcept {
    LoosePart* const loose = find(id);
    if (loose == nullptr || !is_time(over)) return false;
    BodyState& body = state(motion, *loose);
    if (body.presence.is_there() || !place(body, X_WB, {})) return false;
    const std::int32_t generation = body.presence.generation + 1;
    body.presence = {};
    body.presence.generation = generation;
    // It is there, but none of its forces is before the next `advance`.
    body.presence.there = {std::numeric_limits<double>::min(), 0.0,
                           1.0 / std::max(over, least_time)};
    body.arm = {};
    loose->move = {};
    ++motion.changes;
    return true;
  }

  bool move(Motion& motion, PartId id, const Pose& X_WB, double speed) noexcept {
    LoosePart* const loose = find(id);
    if (loose == nullptr || !is_speed(speed)) return false;
    const BodyState& body = state(motion, *loose);
    if (!body.presence.is_there() || body.presence.holder.valid()) return false;
    if (!is_a_place(X_WB, 1e-6)) return false;
    const Turn turn = turn_of(rotation(X_WB) * transposed(rotation(body.X_WB)));
    const double way = norm(origin(X_WB) - origin(body.X_WB));
    loose->move = {body.X_WB, X_WB, (way + std::abs(turn.angle) * loose->room) / speed};
    return true;
  }

  bool attach(Motion& motion, PartId id, BodyId tool, double over) noexcept {
    LoosePart* const loose = find(id);
    if (loose == nullptr || !is_time(over)) return false;
    if (tool.index < 0 || tool.index >= static_cast<int>(motion.bodies.size())) return false;
    const BodyState& holder = motion.bodies[static_cast<std::size_t>(tool.index)];
    BodyState& body = state(motion, *loose);
    if (holder.is_loose || holder.arm != tool) return false;
    if (!body.presence.is_there() || body.presence.holder.valid()) return false;
    body.presence.holder = tool;
    body.presence.grip.rate = 1.0 / std::max(over, least_time);
    body.V_WB = {};
    loose->move = {};
    return true;
  }

  bool release(Motion& motion, PartId id, double over) noexcept {
    const LoosePart* const loose = find(id);
    if (loose == nullptr || !is_time(over)) return false;
    BodyState& body = state(motion, *loose);
    if (!body.presence.is_there() || !body.presence.holder.valid()) return false;
    body.presence.grip.rate = -1.0 / std::max(over, least_time);
    return true;
  }

  bool remove(Motion& motion, PartId id, double over) noexcept {
    LoosePart* const loose = find(id);
    if (loose == nullptr || !is_time(over)) return false;
    BodyState& body = state(motion, *loose);
    if (!(body.presence.there.now > 0.0)) return false;
    body.presence.there.rate = -1.0 / std::max(over, least_time);
    return true;
  }

  void advance(Motion& motion, double dt) noexcept {
    motion.elapsed = dt;
    for (LoosePart& loose : all_) {
      if (state(motion, loose).presence.is_there()) advance(motion, loose, dt);
    }
  }

  void carry(Motion& motion) const noexcept {
    for (const LoosePart& loose : all_) {
      BodyState& body = state(motion, loose);
      if (!body.arm.valid()) continue;
      const BodyState& tool = motion.bodies[static_cast<std::size_t>(body.arm.index)];
      const Pose X_WB = composed(tool.X_WB, loose.X_TB);
      (void)place(body, X_WB, moved_to(tool.V_WB, origin(X_WB) - origin(tool.X_WB)));
    }
  }

 private:
  static constexpr double least_time = 1e-9;  ///< [s] what happens in it happens at once

  [[nodiscard]] static BodyState& state(Motion& motion, const LoosePart& loose) noexcept {
    return motion.bodies[static_cast<std::size_t>(loose.body.index)];
  }
  /// Which kinds of force on a body act or have acted at the last tick.
  struct Kinds {
    explicit Kinds(const Presence& p)
        : any(p.is_there()),
          as_obstacle(p.grip.now < 0.0 || p.grip.before < 0.0),
          as_tool(p.grip.now > 0.0 || p.grip.before > 0.0),
          beside_held(p.grip.now < 1.0 || p.grip.before < 1.0) {}
    friend bool operator==(const Kinds&, const Kinds&) noexcept = default;
    bool any, as_obstacle, as_tool, beside_held;
  };

  /// Stops for a tick at zero, where forces of neither kind act.
  static void advance_grip(Ramp& grip, double dt) noexcept {
    const double rate = grip.rate;
    const double half = grip.now * rate < 0.0 ? 0.0 : 1.0;
    detail::advance(grip, rate > 0.0 ? half : -half, dt);
    if (grip.now == 0.0) grip.rate = rate;
  }

  /// Advances how far a body is there and held. Returns whether some force that was none can now be
  /// one, or the other way round.
  static bool advance(Presence& p, double dt) noexcept {
    const Kinds last(p);
    detail::advance(p.there, p.there.rate > 0.0 ? 1.0 : 0.0, dt);
    advance_grip(p.grip, dt);
    const bool is_free = p.grip.now <= -1.0 && p.grip.before <= -1.0 && !(p.grip.rate > 0.0);
    if (is_free || !p.is_there()) p.holder = {};
    return !(Kinds(p) == last);
  }

  static void advance(Motion& motion, LoosePart& loose, double dt) noexcept {
    BodyState& body = state(motion, loose);
    const bool was_held = body.arm.valid();
    if (advance(body.presence, dt)) ++motion.changes;
    // The last of its forces as a tool acts on the tool.
    const bool is_held =
        body.presence.is_there() &&
        (body.presence.grip.now > 0.0 || (was_held && body.presence.grip.before > 0.0));
    if (is_held && !body.arm.valid()) {
      body.arm = body.presence.holder;
      const Pose& X_WT = motion.bodies[static_cast<std::size_t>(body.arm.index)].X_WB;
      loose.X_TB = composed(inverted(X_WT), body.X_WB);
    }
    if (!is_held && body.arm.valid()) {
      body.arm = {};
      body.V_WB = {};
    }
    if (loose.move.over > 0.0) {
      loose.move.at += dt;
      (void)place(body, loose.move.pose(), loose.move.twist());
      if (!(loose.move.at < loose.move.over)) loose.move = {};
    }
  }

  std::vector<LoosePart> all_;  ///< in the order of their parts
};

}  // namespace repel::detail
