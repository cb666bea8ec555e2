// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The features of a pair, kept from tick to tick: mostly to rule out a contact patch.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>

#include <repel/contact/patch.hpp>
#include <repel/contact/pointed.hpp>
#include <repel/distance/feature_lanes.hpp>

namespace repel::detail {

/// The features of two shapes facing each other.
struct PointedPair {
  Pointed a, b;

  /// True where `find_patch` finds no patch for these poses: one of them shows a corner, or both an
  /// edge and these cross.
  /// @param n unit, `Separation::extraction_W`, world axes
  [[nodiscard]] bool rule_out(const Vec<double>& n, const Pose& X_WA,
                              const Pose& X_WB) const noexcept {
    const Vec<double> n_A = rotate_transposed(X_WA, -n);
    const Vec<double> n_B = rotate_transposed(X_WB, n);
    const bool a_holds = a.holds(n_A);
    const bool b_holds = b.holds(n_B);
    if ((a_holds && !a.has_edge(n_A)) || (b_holds && !b.has_edge(n_B))) return true;
    if (!a_holds || !b_holds) return false;
    const Vec<double> across = cross(rotate(X_WA, a.along), rotate(X_WB, b.along));
    return std::abs(dot(across, n)) > Crossing::widest;
  }

  /// As `repel::find_patch`. Remembers where there is none.
  bool find_patch(const Separation& s, PosedShape A, PosedShape B, double tilt,
                  ContactPatch& patch) noexcept {
    if (s.level_a > 0 || s.level_b > 0) return repel::find_patch(s, A, B, tilt, patch);
    const Vec<double> n(s.extraction_W);
    if (rule_out(n, A.X_W, B.X_W)) return false;
    if (repel::find_patch(s, A, B, tilt, patch)) return true;
    const Vec<double> n_A = rotate_transposed(A.X_W, -n);
    const Vec<double> n_B = rotate_transposed(B.X_W, n);
    if (!a.holds(n_A)) a = PointedSearch(A.shape.level(0).core, n_A, tilt).run();
    if (!b.holds(n_B)) b = PointedSearch(B.shape.level(0).core, n_B, tilt).run();
    return false;
  }
};

/// The same for several pairs, one per lane.
class PointedPairLanes {
 public:
  void set(int k, const PointedPair& pair) noexcept {
    a_.set(k, pair.a);
    b_.set(k, pair.b);
  }
  [[nodiscard]] PointedPair at(int k) const noexcept { return {a_.at(k), b_.at(k)}; }

  struct Shown {
    LaneMask may_be_flat;  ///< false where there is no patch, as PointedPair::rule_out
    LaneMask edge;         ///< one of the sets shows nothing flat but one edge
  };
  [[nodiscard]] Shown shown(const FeatureLanes& features, const LaneGap& gap) const noexcept {
    const LaneMask a = a_.holds(gap.n_A);
    const LaneMask b = b_.holds(gap.n_B);
    const LaneMask edge_a = a & a_.has_edge(gap.n_A);
    const LaneMask edge_b = b & b_.has_edge(gap.n_B);
    const LaneMask corner = (a & ~edge_a) | (b & ~edge_b);
    const LaneMask edges = edge_a & edge_b;
    if (bits_of(edges) == 0U) return {~corner, edge_a | edge_b};
    const LaneVec across =
        cross(features.A.X_W.rotate(a_.along()), features.B.X_W.rotate(b_.along()));
    const LaneMask crossed = edges & (magnitudes(dot(across, gap.n_BA_W)) > Crossing::widest);
    return {~(corner | crossed), edge_a | edge_b};
  }

  /// Updates the features of those lanes that no longer hold.
  /// @param tilt [rad] of the laws
  void look_at(unsigned lanes, const FeatureLanes& features, const LaneGap& gap,
               const Lanes& tilt) noexcept {
    look_at(lanes, features.A, gap.n_A, tilt, a_);
    look_at(lanes, features.B, gap.n_B, tilt, b_);
  }

 private:
  static void look_at(unsigned lanes, const LaneSets& sets, const LaneVec& n, const Lanes& tilt,
                      PointedLanes& pointed) noexcept {
    for (unsigned left = lanes & ~bits_of(pointed.holds(n)); left != 0U; left &= left - 1U) {
      const int k = std::countr_zero(left);
      const Convex& set = *sets.sets[static_cast<std::size_t>(k)];
      pointed.set(k, PointedSearch(set, Vec<double>(n.at(k)), tilt[k]).run());
    }
  }

  PointedLanes a_, b_;
};

}  // namespace repel::detail
