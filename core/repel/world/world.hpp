/// @file
/// The world model: bodies, their convex parts, and the pairs of parts to be kept apart.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <repel/base/ids.hpp>
#include <repel/base/limits.hpp>
#include <repel/base/spatial.hpp>
#include <repel/base/vec.hpp>
#include <repel/distance/query.hpp>
#include <repel/force/law.hpp>
#include <repel/reduction/shape.hpp>

namespace repel {

/// Pose, twist and accumulated travel of a body.
struct BodyState {
  Pose X_WB = Pose::Identity();  ///< [m]
  Twist V_WB;                    ///< [m/s, rad/s] of the body's origin, world axes
  double travel = 0.0;  ///< [m] upper bound on the path of any point of the body since set-up
  double turn = 0.0;    ///< [m] the part of `travel` due to rotation
  BodyId arm{};         ///< tool of the arm that the body belongs to; invalid: of none
};

/// All bodies at one instant: the input of the coprocessor.
struct Motion {
  std::int64_t tick = -1;         ///< -1: before the first one
  std::vector<BodyState> bodies;  ///< by BodyId
};

/// A convex part of a body.
struct Part {
  std::string name;
  BodyId body;
  Shape shape;
  Pose X_BP = Pose::Identity();  ///< [m] in its body
};

/// Two parts to be kept apart, and how.
struct Pair {
  PartId a;      ///< the part that is pushed along the extraction direction
  PartId b;      ///< the part it is pushed away from
  ForceLaw law;  ///< its `depth` clamped to the deepest that the two shapes can have, and its
                 ///< `tilt` to what their size allows
};

/// A body that is attached to a link of an arm; its frame is that of the link.
struct LinkBody {
  BodyId body;
  int link = 0;  ///< index in ArmModel::links
};

/// Built at set-up, by the functions that throw; `place` is the one for the tick.
class World {
 public:
  /// @param measure of the overlaps of all pairs, see docs/reduction.md. `Measure::reduction` has
  /// as many steps as the shapes have levels
  /// @throws SetupError for a value that is no measure
  explicit World(const Limits& limits = {}, Measure measure = QueryOptions{}.measure)
      : limits_(limits), measure_(measure) {
    checked("measure", static_cast<double>(measure), 0.0, all_measures.size() - 1.0, "");
    add_body("world");
  }

  /// The body that never moves: walls, tables, everything bolted down.
  static constexpr BodyId fixed{0};

  BodyId add_body(const std::string& name, const Pose& X_WB = Pose::Identity()) {
    if (static_cast<int>(motion_.bodies.size()) >= limits_.bodies) over("bodies", limits_.bodies);
    check_rigid(name, X_WB);
    body_names_.push_back(name);
    reach_.push_back(0.0);
    motion_.bodies.push_back({X_WB, {}, 0.0, 0.0});
    return {static_cast<std::int32_t>(motion_.bodies.size()) - 1};
  }

  PartId add_part(BodyId body, const std::string& name, const Shape& shape,
                  const Pose& X_BP = Pose::Identity()) {
    if (static_cast<int>(parts_.size()) >= limits_.parts) over("parts", limits_.parts);
    if (body.index < 0 || body.index >= body_count())
      throw SetupError("part " + name + ": no such body");
    check_rigid(name, X_BP);
    double& reach = reach_[body.index];
    reach = std::max(reach, norm(origin(X_BP)) + shape.reach());
    parts_.push_back({name, body, shape, X_BP});
    return {static_cast<std::int32_t>(parts_.size()) - 1};
  }

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
    pairs_.push_back({a, b, fitted(checked(law), part(a).shape, part(b).shape)});
    return {static_cast<std::int32_t>(pairs_.size()) - 1};
  }

  /// The law that a pair of two shapes gets: `depth` and `tilt` lowered to what their size allows.
  [[nodiscard]] static ForceLaw fitted(ForceLaw law, const Shape& a, const Shape& b) noexcept {
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

  /// Moves a body. False, with nothing changed, when the pose or twist is not finite or not rigid.
  bool place(BodyId body, const Pose& X_WB, const Twist& V_WB) noexcept {
    if (!is_finite(X_WB) || !is_finite(V_WB) || !is_rigid(X_WB, 1e-6)) return false;
    BodyState& state = motion_.bodies[body.index];
    const auto moved = [&](int k) {
      const Vec<double> d = column<double>(X_WB, k) - column<double>(state.X_WB, k);
      return dot(d, d);
    };
    // |R - R'| (Frobenius) is 2 sqrt(2) sin(angle / 2), without the cancellation of an arc cosine.
    const double chord = std::sqrt(0.5 * (moved(0) + moved(1) + moved(2)));
    const double reach = reach_[body.index];
    const double turned = reach * chord;
    const double rounding = 1e-14 * (norm(origin(X_WB)) + reach);
    state.travel += std::sqrt(moved(3)) + turned + rounding;
    state.turn += turned + rounding;
    state.X_WB = X_WB;
    state.V_WB = V_WB;
    return true;
  }

  /// The present state of all bodies; the caller counts the tick number.
  [[nodiscard]] Motion& motion() noexcept { return motion_; }
  [[nodiscard]] const Motion& motion() const noexcept { return motion_; }
  [[nodiscard]] const Limits& limits() const noexcept { return limits_; }
  /// The options of every query of a pair.
  [[nodiscard]] QueryOptions query_options() const noexcept { return {.measure = measure_}; }
  /// [m] The penetration of a pair by the measure of the world is never deeper.
  [[nodiscard]] double deepest(const Pair& pair) const noexcept {
    if (measure_ != Measure::exact) return deepest_point(part(pair.a).shape, part(pair.b).shape);
    return part(pair.a).shape.reach() + part(pair.b).shape.reach();
  }
  [[nodiscard]] int body_count() const noexcept { return static_cast<int>(motion_.bodies.size()); }
  [[nodiscard]] const std::string& body_name(BodyId id) const noexcept {
    return body_names_[id.index];
  }
  [[nodiscard]] const std::vector<Part>& parts() const noexcept { return parts_; }
  [[nodiscard]] const std::vector<Pair>& pairs() const noexcept { return pairs_; }
  [[nodiscard]] const Part& part(PartId id) const noexcept { return parts_[id.index]; }
  [[nodiscard]] const Pair& pair(PairId id) const noexcept { return pairs_[id.index]; }

 private:
  [[nodiscard]] static double deepest_point(const Shape& a, const Shape& b) noexcept {
    return a.inscribed_radius() + b.inscribed_radius();
  }
  static void check_rigid(const std::string& name, const Pose& X) {
    if (!is_finite(X) || !is_rigid(X)) throw SetupError(name + ": its pose is not a rigid one");
  }
  [[noreturn]] static void over(const std::string& field, int limit) {
    throw SetupError("more " + field + " than Limits::" + field +
                     " allows: " + std::to_string(limit));
  }

  Limits limits_;
  Measure measure_;
  std::vector<std::string> body_names_;
  std::vector<double> reach_;  ///< [m] farthest point of each body from its origin
  Motion motion_;
  std::vector<Part> parts_;
  std::vector<Pair> pairs_;
};

}  // namespace repel
