// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The forces of a pair by one query and one contact patch: what a tick has to give.
#pragma once

#include <span>

#include <repel/contact/patch.hpp>
#include <repel/force/law.hpp>

namespace repel::scale {

/// A part of a pair and what it moves with.
struct PosedPart {
  const Shape& shape;
  const Pose& X_WP;
  const Pose& X_WB;   ///< of its body
  const Twist& V_WB;  ///< of its body, about the origin of that
};

/// Adds the forces of a pair to those on the bodies of A and B, about the origin of each.
/// @param s the answer of the query
inline void push(const Separation& s, const PosedPart& A, const PosedPart& B, const ForceLaw& law,
                 Wrench& on_a, Wrench& on_b) {
  ContactPatch patch{.gradient = {s.extraction_W}};
  (void)find_patch(s, {A.shape, A.X_WP}, {B.shape, B.X_WP}, law.tilt, patch);
  const Vec3 p_QA = A.X_WB.translation() - s.p_WA;
  const Vec3 p_QB = B.X_WB.translation() - s.p_WA;
  const Twist v_A = moved_to(A.V_WB, -p_QA);
  const Twist v_B = moved_to(B.V_WB, -p_QB);
  const Twist v_BA{v_A.linear - v_B.linear, v_A.angular - v_B.angular};
  const double distance = (s.lower > 0.0 ? s.lower : s.distance) - patch.nearer;
  const Wrench at_a = law(distance, power(patch.gradient, v_BA)) * patch.gradient;
  on_a += moved_to(at_a, p_QA);
  on_b += moved_to(-1.0 * at_a, p_QB);
}

}  // namespace repel::scale
