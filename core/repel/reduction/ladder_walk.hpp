// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The signed distance of two shapes that overlap, from the levels of their reductions.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <repel/distance/feature_search.hpp>
#include <repel/distance/gjk.hpp>
#include <repel/reduction/separation_result.hpp>
#include <repel/reduction/way_out.hpp>

namespace repel::detail {

/// The chain of level pairs of two ladders, merged by Level::order, and the walk to the two pairs
/// that decide: the last intersecting one and the first disjoint one.
///
/// The signed distance is min(d - T) over the chain, T being the summed depth of a pair of levels
/// and d their distance. Along the chain the pairs are nested, so d never decreases, and where it
/// is positive it increases by at least as much as T. Hence only the last intersecting pair (-T)
/// and the first disjoint pair (d - T) can attain the minimum, wherever the walk starts.
class LadderWalk {
 public:
  LadderWalk(PosedShape A, PosedShape B, const QueryOptions& options, WarmStart& warm) noexcept
      : A_(A), B_(B), options_(options), warm_(warm) {}

  /// @param first the result of a query on the levels of the warm start, or null
  Separation run(const Gap* first) noexcept {
    i_ = warm_.level_a;
    j_ = warm_.level_b;
    if (!on_chain()) i_ = j_ = 0;
    if (first != nullptr) {
      iterations_ = first->iterations;
      if (first->meets) keep_meeting(warm_);
    }
    const int longest = A_.shape.levels() + B_.shape.levels() + 3;
    for (int step = 0; step < longest; ++step) {
      const Gap gap = step == 0 && first != nullptr ? *first : query();
      const bool meets = gap.meets || gap.end == QueryEnd::touching;
      const bool decided = meets ? went_in(gap) : went_out(gap);
      if (decided) break;
    }
    // The next call is fastest if it starts at the disjoint pair.
    warm_.level_a = static_cast<std::uint8_t>(apart_ ? apart_i_ : i_);
    warm_.level_b = static_cast<std::uint8_t>(apart_ ? apart_j_ : j_);
    return answer();
  }

 private:
  [[nodiscard]] double order_a(int i) const noexcept {
    return i < A_.shape.levels() ? A_.shape.level(i).order
                                 : std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] double order_b(int j) const noexcept {
    return j < B_.shape.levels() ? B_.shape.level(j).order
                                 : std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] bool on_chain() const noexcept {
    return i_ < A_.shape.levels() && j_ < B_.shape.levels() &&
           std::max(order_a(i_), order_b(j_)) < std::min(order_a(i_ + 1), order_b(j_ + 1));
  }
  [[nodiscard]] bool at_start() const noexcept { return i_ == 0 && j_ == 0; }
  [[nodiscard]] bool at_end() const noexcept {
    return i_ + 1 == A_.shape.levels() && j_ + 1 == B_.shape.levels();
  }
  [[nodiscard]] double depth() const noexcept {
    return A_.shape.level(i_).depth + B_.shape.level(j_).depth;
  }

  void step_in() noexcept {
    const double a = order_a(i_ + 1);
    const double b = order_b(j_ + 1);
    i_ += a <= b ? 1 : 0;
    j_ += b <= a ? 1 : 0;
  }
  void step_out() noexcept {
    const double a = order_a(i_);
    const double b = order_b(j_);
    i_ -= a >= b && i_ > 0 ? 1 : 0;
    j_ -= b >= a && j_ > 0 ? 1 : 0;
  }

  /// The distance of the current pair of levels, warm started from the last call on a disjoint or
  /// an intersecting pair.
  Gap query() noexcept {
    const Level& a = A_.shape.level(i_);
    const Level& b = B_.shape.level(j_);
    QueryOptions options = options_;
    options.iterations = std::max(1, options_.iterations - iterations_);
    options.ignore_beyond += at_start() ? depth() : std::numeric_limits<double>::infinity();
    Gap gap;
    if (a.core.is_polytope() && b.core.is_polytope() &&
        find_quickly({a.core, A_.X_W, b.core, B_.X_W}, options, gap)) {
      return gap;
    }
    WarmStart start = warm_;
    if (warm_.met_size == 4 && apart_) {
      start.a = warm_.met_a;
      start.b = warm_.met_b;
      start.size = 4;
    }
    gap = gap_between(a.core, A_.X_W, b.core, B_.X_W, options, start);
    iterations_ += gap.iterations;
    if (gap.meets) {
      keep_meeting(start);
    } else {
      warm_.a = start.a;
      warm_.b = start.b;
      warm_.size = start.size;
    }
    return gap;
  }

  /// True when the feature or corners that decided last still decide.
  bool find_quickly(const PosedPair& pair, const QueryOptions& options, Gap& gap) noexcept {
    ++iterations_;
    if (apart_) {
      gap.meets = warm_.met_size == 4 && still_meets(pair, warm_);
      gap.upper = 0.0;
      gap.end = QueryEnd::converged;
      return gap.meets;
    }
    if (warm_.size < 1 || warm_.size > 3) return false;
    if (confirm_nearest(pair, warm_, options, options.ignore_beyond, gap)) return true;
    const bool found = FeatureSearch(pair).run(options, warm_, gap);
    iterations_ += gap.iterations;
    return found;
  }

  void keep_meeting(const WarmStart& four) noexcept {
    warm_.met_size = four.size;
    warm_.met_a = four.a;
    warm_.met_b = four.b;
  }

  /// The current pair intersects. True when the next one is known to be disjoint, or the walk must
  /// end.
  bool went_in(const Gap& gap) noexcept {
    if (at_shapes_) {
      at_shapes_ = false;
      cut_short_ = spent();
      if (gap.meets && !cut_short_) {
        i_ = from_i_;
        j_ = from_j_;
        return false;
      }
      apart_ = cut_short_;
    }
    meets_ = true;
    touches_ = at_start() && gap.end == QueryEnd::touching;
    depth_met_ = depth();
    margin_ = gap.upper;
    if (apart_ || at_end() || spent()) return true;
    step_in();
    return false;
  }

  /// The current pair is disjoint. True when the previous one is known to intersect, or the walk
  /// must end.
  bool went_out(const Gap& gap) noexcept {
    apart_ = true;
    gap_ = gap;
    apart_i_ = i_;
    apart_j_ = j_;
    if (meets_ || at_start()) return true;
    const double here = depth();
    const bool far_out = gap.distance > here;
    step_out();
    // If the previous pair were disjoint, this distance would exceed the depth gained between the
    // two.
    if (gap.distance <= here - depth()) return true;
    cut_short_ = spent() || gap.end == QueryEnd::budget_spent;
    if (cut_short_) return true;
    if (far_out && !seen_shapes_) {
      // The shapes seem to be disjoint: look at them first, and go on from here if they are not.
      seen_shapes_ = at_shapes_ = true;
      from_i_ = i_;
      from_j_ = j_;
      i_ = j_ = 0;
    }
    return false;
  }

  [[nodiscard]] bool spent() const noexcept { return iterations_ >= options_.iterations; }

  [[nodiscard]] Separation answer() const noexcept;
  void choose_direction(Separation& s) const noexcept;

  PosedShape A_;
  PosedShape B_;
  const QueryOptions& options_;
  WarmStart& warm_;
  int i_ = 0;
  int j_ = 0;
  int iterations_ = 0;
  bool meets_ = false;
  bool apart_ = false;
  bool touches_ = false;
  bool seen_shapes_ = false;  ///< the walk has skipped to the shapes themselves
  bool at_shapes_ = false;    ///< it has just done so, from the pair below
  int from_i_ = 0;
  int from_j_ = 0;
  bool cut_short_ = false;  ///< the iterations were spent before the deciding pairs were found
  double depth_met_ = 0.0;  ///< [m] T of the last intersecting pair
  double margin_ = 0.0;     ///< [m] by which it may be disjoint, due to rounding
  Gap gap_;                 ///< of the first disjoint pair
  int apart_i_ = 0;
  int apart_j_ = 0;
};

/// For shapes that are both reduced to one common point: it is as deep as their levels.
inline void LadderWalk::choose_direction(Separation& s) const noexcept {
  s.extraction_W = shortest_axis(A_, B_);
  const Vec3 common = A_.X_W * to_vec3(A_.shape.level(i_).core.point(0).p);
  s.p_WA = common - A_.shape.level(i_).depth * s.extraction_W;
  s.p_WB = common + B_.shape.level(j_).depth * s.extraction_W;
}

inline Separation LadderWalk::answer() const noexcept {
  const bool plain = apart_ && apart_i_ == 0 && apart_j_ == 0;
  const double none = std::numeric_limits<double>::infinity();
  const double met = meets_ ? -depth_met_ : none;
  const double slack = 1e-14 * (A_.shape.reach() + B_.shape.reach());
  Separation s;
  if (apart_) {
    s = apart(gap_, A_.shape.level(apart_i_).depth, B_.shape.level(apart_j_).depth, A_.X_W);
    s.distance = std::min(s.distance, met);
    s.upper = std::min(s.upper, met + margin_);
  } else {
    choose_direction(s);
    s.distance = met;
    s.upper = met + margin_;
    s.end = at_end() ? QueryEnd::converged : QueryEnd::budget_spent;
  }
  s.level_a = apart_ ? apart_i_ : i_;
  s.level_b = apart_ ? apart_j_ : j_;
  s.level = std::max(s.level_a, s.level_b);
  s.iterations = iterations_ + (plain ? 0 : apart_ ? 1 : 13);
  if (!plain || !(gap_.lower > 0.0)) {
    s.lower = widened(std::min(s.distance, -overlap_along(s.extraction_W, A_, B_) - slack), -1.0);
  }
  if (!plain) s.upper = widened(s.upper + slack, 1.0);
  // A point deep inside but coplanar with all support points found looks like contact to GJK.
  const bool is_whole = s.end == QueryEnd::converged;
  if (is_whole && touches_ && s.distance >= -(margin_ + slack)) s.end = QueryEnd::touching;
  if (cut_short_) s.end = QueryEnd::budget_spent;
  return s;
}

}  // namespace repel::detail
