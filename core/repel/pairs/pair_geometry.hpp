// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The geometry from which the force of a pair is computed, shared by the single-pair code (double,
/// Vec<double>) and the SIMD code with one pair per lane (Lanes, LaneVec).
#pragma once

#include <repel/base/lanes.hpp>
#include <repel/world/world.hpp>

namespace repel::detail {

/// The distance from which the force of a pair is computed [m]: the lower bound while the shapes
/// are apart, the measured distance (negative depth) in overlap.
template <class Number>
[[nodiscard]] Number proven_distance(const Number& distance, const Number& lower) noexcept {
  return either(lower > 0.0, lower, distance);
}

/// The body of part A relative to that of part B, in world axes.
template <class Number, class Vector>
struct RelativeMotion {
  Vector p_WoA;   ///< [m] origin of A in the world
  Vector p_BA_W;  ///< [m] origin of A from that of B
  Vector v_BA_W;  ///< [m/s] of A relative to B at the origin of A
  Vector w_BA_W;  ///< [rad/s]
  Number turn;    ///< [m] both bodies' BodyState::turn
};

/// Size [N] of the force of a pair that is not passable, at a distance [m] whose gradient, when A
/// moves, is a force and a moment about the origin of body A. Of one pair, or of one in each lane.
template <class Number, class Vector>
[[nodiscard]] Number force_of(const LawFormula<Number>& law, const Number& distance,
                              const Vector& force, const Vector& moment,
                              const RelativeMotion<Number, Vector>& relative) noexcept {
  return law(distance, dot(force, relative.v_BA_W) + dot(relative.w_BA_W, moment));
}

[[nodiscard]] inline RelativeMotion<double, Vec<double>> relative_motion(
    const BodyState& A, const BodyState& B) noexcept {
  const Vec<double> p_WoA = column<double>(A.X_WB, 3);
  const Vec<double> p_BA_W = p_WoA - column<double>(B.X_WB, 3);
  return {p_WoA, p_BA_W,
          Vec<double>(A.V_WB.linear) - Vec<double>(B.V_WB.linear) -
              cross(Vec<double>(B.V_WB.angular), p_BA_W),
          Vec<double>(A.V_WB.angular) - Vec<double>(B.V_WB.angular), A.turn + B.turn};
}

/// Broadcasts one relative motion to all lanes.
[[nodiscard]] inline RelativeMotion<Lanes, LaneVec> in_all_lanes(
    const RelativeMotion<double, Vec<double>>& one) noexcept {
  return {LaneVec::all(one.p_WoA), LaneVec::all(one.p_BA_W), LaneVec::all(one.v_BA_W),
          LaneVec::all(one.w_BA_W), all_of(one.turn)};
}
/// Stores the relative motion of one pair in lane k of `lanes`.
inline void set_lane(RelativeMotion<Lanes, LaneVec>& lanes, int k,
                     const RelativeMotion<double, Vec<double>>& one) noexcept {
  lanes.p_WoA.set(k, one.p_WoA);
  lanes.p_BA_W.set(k, one.p_BA_W);
  lanes.v_BA_W.set(k, one.v_BA_W);
  lanes.w_BA_W.set(k, one.w_BA_W);
  lanes.turn[k] = one.turn;
}

}  // namespace repel::detail
