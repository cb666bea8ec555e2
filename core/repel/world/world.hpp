// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The world model: bodies, their convex parts, and the pairs of parts to be kept apart.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <repel/base/capacities.hpp>
#include <repel/base/ids.hpp>
#include <repel/base/spatial.hpp>
#include <repel/base/vec.hpp>
#include <repel/distance/query.hpp>
#include <repel/force/law.hpp>
#include <repel/reduction/convex_shape.hpp>
#include <repel/world/body_state.hpp>
#include <repel/world/loose_parts.hpp>

namespace repel {

/// A convex part of a body.
struct Part {
  std::string name;              ///< in reports and messages
  BodyId body;                   ///< to which it is fixed
  Shape shape;                   ///< convex, in the frame P
  Pose X_BP = Pose::Identity();  ///< [m] in its body
  double room = 0.0;  ///< [m] largest reach that its shape can get while running; 0: it stays
};

/// Two parts to be kept apart, and how.
struct Pair {
  PartId a;            ///< the part that is pushed along the extraction direction
  PartId b;            ///< the part it is pushed away from
  ForceLaw law;        ///< as it acts: World::effective
  ForceLaw law_given;  ///< as it was given
};

/// A body that is attached to a link of an arm; its frame is that of the link.
struct LinkBody {
  BodyId body;   ///< in the world
  int link = 0;  ///< index in ArmModel::links
};

/// Built at set-up, by the functions that throw; `place` is the one for the tick.
class World {
 public:
  /// @param measure of the overlaps of all pairs, see docs/reduction.md. `Measure::reduction` has
  /// as many steps as the shapes have levels
  /// @throws SetupError for a value that is no measure
  explicit World(const Capacities& limits = {}, Measure measure = QueryOptions{}.measure)
      : limits_(limits), measure_(measure) {
    checked("measure", static_cast<double>(measure), 0.0, all_measures.size() - 1.0, "");
    add_body("world");
  }

  /// The body that never moves: walls, tables, everything bolted down.
  static constexpr BodyId fixed{0};

  /// Adds a body that moves by `place`. @throws SetupError for one too many, or a pose not rigid.
  BodyId add_body(const std::string& name, const Pose& X_WB = Pose::Identity()) {
    const std::size_t lasting = motion_.bodies.size() - loose_.all().size();
    if (static_cast<int>(lasting) >= limits_.bodies) over("bodies", limits_.bodies);
    check_rigid(name, X_WB);
    return push_body(name, X_WB);
  }

  /// Adds a part to a body. @throws SetupError for one too many, no such body, or a pose not rigid.
  PartId add_part(BodyId body, const std::string& name, const Shape& shape,
                  const Pose& X_BP = Pose::Identity()) {
    if (static_cast<int>(parts_.size()) >= limits_.parts) over("parts", limits_.parts);
    if (body.index < 0 || body.index >= body_count())
      throw SetupError("part " + name + ": no such body");
    check_rigid(name, X_BP);
    double& reach = motion_.bodies[body.index].reach;
    reach = std::max(reach, norm(origin(X_BP)) + shape.reach());
    parts_.push_back({name, body, shape, X_BP});
    return {static_cast<std::int32_t>(parts_.size()) - 1};
  }

  /// Reserves a part, on a body of its own, that can come and go while the world runs. It is absent
  /// at first. Its pairs are added as those of any part: with parts of arms, whose way it is in
  /// while it lies free, and with obstacles and other such parts, which it meets while it is held.
  /// @param room [m] largest reach of any shape that it will have, 1e-6 to 1e6; at least that of
  /// `shape`, and no more than that for a part that is to keep it
  PartId reserve(const std::string& name, const Shape& shape, double room) {
    checked("room of " + name, room, std::max(1e-6, shape.reach()), Shape::largest, "m");
    if (static_cast<int>(loose_.all().size()) >= limits_.loose) over("loose", limits_.loose);
    const BodyId body = push_body(name, Pose::Identity());
    const PartId id = add_part(body, name, shape);
    parts_.back().room = motion_.bodies.back().reach = room;
    motion_.bodies.back().is_loose = true;
    loose_.reserve(id, body, room);
    return id;
  }

  /// Gives a reserved part a mass [kg], at the origin of its body, whose weight a tool that holds
  /// it carries. @param is_known to the controllers of arms, not only to simulated ones. Set-up
  /// only.
  void weigh(PartId id, double mass, bool is_known = true) {
    checked("mass of " + part(id).name, mass, 0.0, 1e3, "kg");
    if (detail::LoosePart* const loose = loose_.find(id)) {
      loose->mass = mass;
      loose->is_mass_known = is_known;
    }
  }

  /// Lets two parts repel each other. @throws SetupError for one too many, parts of one body or a
  /// law.
  PairId add_pair(PartId a, PartId b, const ForceLaw& law) {
    if (static_cast<int>(pairs_.size()) >= limits_.pairs) over("pairs", limits_.pairs);
    for (const PartId id : {a, b}) {
      if (id.index < 0 || id.index >= static_cast<int>(parts_.size())) {
        throw SetupError("a pair names a part that does not exist");
      }
    }
    if (part(a).body == part(b).body) {
      throw SetupError("parts " + part(a).name + " and " + part(b).name + " are of one body");
    }
    pairs_.push_back({a, b, effective(checked(law), part(a).shape, part(b).shape), law});
    const PairId id{static_cast<std::int32_t>(pairs_.size()) - 1};
    for (const PartId each : {a, b}) {
      if (detail::LoosePart* loose = loose_.find(each)) loose->pairs.push_back(id);
    }
    return id;
  }

  /// The law as it acts between two shapes: `depth` and `tilt` lowered to what their size allows.
  [[nodiscard]] static ForceLaw effective(ForceLaw law, const Shape& a, const Shape& b) noexcept {
    // By whatever measure, a passable body has let go where no common point can be deeper.
    law.depth = std::min(law.depth, deepest_point(a, b));
    // Over tilts up to e, the distance of two sets differs by at most e times the radius of the
    // smaller around its nearest point, two thirds of it in the mean.
    const double nearer = 4.0 / 3.0 * law.tilt * std::min(a.reach(), b.reach());
    if (law.passable) law.tilt = 0.0;
    if (nearer > ForceLaw::most_nearer) law.tilt *= ForceLaw::most_nearer / nearer;
    return law;
  }

  /// Makes a body part of the arm with this `tool`, which is part of it itself. Set-up only.
  void join(BodyId body, BodyId tool) { motion_.bodies[body.index].arm = tool; }
  /// Lets what the tool of its arm holds touch a body, as it may touch the tool. Set-up only.
  void spare_held(BodyId body) { motion_.bodies[body.index].spares_held = true; }

  /// The parts that can come and go. The functions below change one of them, between two exchanges
  /// of the coprocessor; each returns false, with nothing changed, if `id` is none of these parts,
  /// a number is not finite, or the state of the part does not allow it. Cost: below 1 us; of
  /// `refit`, 20 ns more for each pair. `schedule/world_changes.hpp` takes changes from other
  /// threads.
  [[nodiscard]] const std::vector<detail::LoosePart>& loose() const noexcept {
    return loose_.all();
  }
  /// The part is there, if only in part: some force on it may act. Always true of other parts.
  [[nodiscard]] bool is_there(PartId id) const noexcept {
    const BodyState& body = motion_.bodies[part(id).body.index];
    return !body.is_loose || body.presence.is_there();
  }

  /// The part is about to be absent: World::remove.
  [[nodiscard]] bool is_leaving(PartId id) const noexcept {
    const Presence& presence = motion_.bodies[part(id).body.index].presence;
    return presence.is_there() && (presence.there.rate < 0.0 || !(presence.there.now > 0.0));
  }

  /// Exchanges the shape of an absent part for a new one of at most its room; `shape` is the old
  /// one then. No thread may be using the part: Coprocessor::is_past.
  bool refit(PartId id, Shape& shape) noexcept {
    const detail::LoosePart* const loose = loose_.find(id);
    if (loose == nullptr || is_there(id) || !(shape.reach() <= loose->room)) return false;
    std::swap(parts_[id.index].shape, shape);
    for (const PairId each : loose->pairs) {
      Pair& pair = pairs_[each.index];
      pair.law = effective(pair.law_given, part(pair.a).shape, part(pair.b).shape);
    }
    return true;
  }
  /// Lets an absent part come. @param X_WB [m] @param over [s] the time in which its forces grow
  /// from nothing to those of their laws, in even steps, from the next `advance` on; 0: at once
  /// then. Here and below up to an hour
  bool add(PartId id, const Pose& X_WB, double over) noexcept {
    return loose_.add(motion_, id, X_WB, over);
  }
  /// Moves a part that lies free, on a straight line and with an even turn, from the next
  /// `advance` on. @param X_WB [m] where to @param speed [m/s] of its fastest point, 1e-6 to 10
  bool move(PartId id, const Pose& X_WB, double speed) noexcept {
    return loose_.move(motion_, id, X_WB, speed);
  }
  /// Lets a tool take a part where it is: in the time `over` [s] it stops being an obstacle to this
  /// tool, in as long again it becomes part of it.
  bool attach(PartId id, BodyId tool, double over) noexcept {
    return loose_.attach(motion_, id, tool, over);
  }
  /// Lets a tool put down a part that it holds: in the time `over` [s] it stops being part of the
  /// tool and stays where it is then, in as long again it becomes an obstacle to it.
  bool release(PartId id, double over) noexcept { return loose_.release(motion_, id, over); }
  /// Lets a part go, held or not. @param over [s] the time in which its forces fade; 0: at once
  bool remove(PartId id, double over) noexcept { return loose_.remove(motion_, id, over); }

  /// Advances what these functions have begun, before the bodies are placed for a tick.
  /// @param dt [s] since the last one
  void advance(double dt) noexcept { loose_.advance(motion_, dt); }
  /// Places what tools hold, when all tools have been placed for a tick.
  void carry() noexcept { loose_.carry(motion_); }

  /// Moves a body. False, with nothing changed, when the pose or twist is not finite or not rigid.
  bool place(BodyId body, const Pose& X_WB, const Twist& V_WB) noexcept {
    return repel::place(motion_.bodies[body.index], X_WB, V_WB);
  }

  /// The present state of all bodies; the caller counts the tick number.
  [[nodiscard]] Motion& motion() noexcept { return motion_; }
  /// The present state of all bodies.
  [[nodiscard]] const Motion& motion() const noexcept { return motion_; }
  /// The capacities, as given.
  [[nodiscard]] const Capacities& limits() const noexcept { return limits_; }
  /// The options of every query of a pair.
  [[nodiscard]] QueryOptions query_options() const noexcept { return {.measure = measure_}; }
  /// [m] The penetration of a pair by the measure of the world is never deeper.
  [[nodiscard]] double deepest(const Pair& pair) const noexcept {
    if (measure_ != Measure::exact) return deepest_point(part(pair.a).shape, part(pair.b).shape);
    return part(pair.a).shape.reach() + part(pair.b).shape.reach();
  }
  /// Number of bodies, with the fixed one and those of parts that can come and go.
  [[nodiscard]] int body_count() const noexcept { return static_cast<int>(motion_.bodies.size()); }
  /// The name of a body, as given; "world" for the fixed one.
  [[nodiscard]] const std::string& body_name(BodyId id) const noexcept {
    return body_names_[id.index];
  }
  /// All parts, by PartId.
  [[nodiscard]] const std::vector<Part>& parts() const noexcept { return parts_; }
  /// All pairs, by PairId.
  [[nodiscard]] const std::vector<Pair>& pairs() const noexcept { return pairs_; }
  /// The part of an id that exists.
  [[nodiscard]] const Part& part(PartId id) const noexcept { return parts_[id.index]; }
  /// The pair of an id that exists.
  [[nodiscard]] const Pair& pair(PairId id) const noexcept { return pairs_[id.index]; }

 private:
  BodyId push_body(const std::string& name, const Pose& X_WB) {
    body_names_.push_back(name);
    motion_.bodies.push_back({X_WB, {}, 0.0, 0.0});
    return {static_cast<std::int32_t>(motion_.bodies.size()) - 1};
  }

  [[nodiscard]] static double deepest_point(const Shape& a, const Shape& b) noexcept {
    return a.inscribed_radius() + b.inscribed_radius();
  }
  static void check_rigid(const std::string& name, const Pose& X) {
    if (is_a_place(X, 1e-9)) return;
    throw SetupError(name + ": its pose is not a rigid one within 1e14 m");
  }
  [[noreturn]] static void over(const std::string& field, int limit) {
    throw SetupError("more " + field + " than Capacities::" + field +
                     " allows: " + std::to_string(limit));
  }

  Capacities limits_;
  Measure measure_;
  std::vector<std::string> body_names_;
  Motion motion_;
  std::vector<Part> parts_;
  std::vector<Pair> pairs_;
  detail::LooseParts loose_;
};

/// A force of the pair can act at all: both bodies exist and are not held by the same tool.
[[nodiscard]] inline bool acts(const World& world, PairId id, const Motion& motion) noexcept {
  const auto state_of = [&](PartId part) -> const BodyState& {
    return motion.bodies[static_cast<std::size_t>(world.part(part).body.index)];
  };
  const Pair& pair = world.pair(id);
  return share_between(state_of(pair.a), state_of(pair.b)).acts();
}

}  // namespace repel
