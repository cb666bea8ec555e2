// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The distance of two convex sets by the algorithm of Gilbert, Johnson and Keerthi (GJK, 1988),
/// with a certificate.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <repel/distance/cylinder_foot.hpp>
#include <repel/distance/gap.hpp>
#include <repel/distance/query.hpp>
#include <repel/distance/simplex.hpp>
#include <repel/geometry/convex.hpp>

namespace repel {

namespace detail {

/// One run of the algorithm in the precision of T. The difference is formed in world axes around
/// the origin of A, so that rounding errors do not grow with the distance from the world origin.
///
///     v        point of A - B nearest to the origin so far; |v| is an upper bound of the distance
///     w        support point of A - B along -v; v.w / |v| is a lower bound
///     margin_  error bound of a support value due to rounding [m]
template <class T>
class Gjk {
 public:
  Gjk(const Convex& A, const Pose& X_WA, const Convex& B, const Pose& X_WB) noexcept
      : A_(A),
        B_(B),
        X_WA_(X_WA),
        X_WB_(X_WB),
        named_exactly_(A.is_polytope() && B.is_polytope()),
        round_(round_of(A, B)) {
    const Vec<T> p_WA = column<T>(X_WA, 3);
    p_AB_ = column<T>(X_WB, 3) - p_WA;
    const double size = A.reach() + B.reach() + norm(to_vec3(p_AB_));
    margin_ = 8.0 * epsilon(T{}) * size;
    // Smaller lengths underflow when squared.
    margin_ = std::max(margin_, 1e-150);
  }

  Gap run(const QueryOptions& options, WarmStart& warm) noexcept {
    start(warm);
    Gap gap;
    gap.end = iterate(options, gap);
    finish(gap);
    store(warm);
    return gap;
  }

 private:
  [[nodiscard]] static const Convex* round_of(const Convex& A, const Convex& B) noexcept {
    const auto is_round = [](const Convex& set) {
      return set.kind() == Convex::Kind::cylinder && !set.is_polytope();
    };
    if (is_round(A) && B.is_polytope()) return &A;
    return is_round(B) && A.is_polytope() ? &B : nullptr;
  }

  static constexpr double epsilon(double) noexcept { return 0x1p-52; }
  static constexpr double epsilon(DoubleDouble) noexcept { return 0x1p-98; }

  DifferencePoint<T> difference(const Convex::Point<T>& a,
                                const Convex::Point<T>& b) const noexcept {
    DifferencePoint<T> p;
    p.a = rotate(X_WA_, a.p);
    p.w = p.a - (rotate(X_WB_, b.p) + p_AB_);
    p.ww = dot(p.w, p.w);
    p.name_a = a.name;
    p.name_b = b.name;
    return p;
  }

  /// The support point of A - B along -v.
  DifferencePoint<T> support(const Vec<T>& v) const noexcept {
    return difference(A_.support(rotate_transposed(X_WA_, -v)),
                      B_.support(rotate_transposed(X_WB_, v)));
  }

  void start(const WarmStart& warm) noexcept {
    for (int i = 0; i < std::min<int>(warm.size, 4); ++i) {
      const Convex::Point<T> a = A_.template point<T>(warm.a[i]);
      const Convex::Point<T> b = B_.template point<T>(warm.b[i]);
      if (!simplex_.holds(a.name, b.name)) simplex_.append(difference(a, b));
    }
    if (simplex_.size() == 0) {
      Vec<T> centres = -p_AB_;
      if (!(dot(centres, centres) > T(0.0))) centres = {T(1.0), T(0.0), T(0.0)};
      simplex_.restart(support(centres));
      ++iterations_;
    } else {
      encloses_ = simplex_.project_all(T(margin_)) == Projection::encloses;
    }
  }

  QueryEnd iterate(const QueryOptions& options, Gap& gap) noexcept {
    const T tolerance(options.tolerance);
    bool separated = false;
    while (!encloses_) {
      by_foot_ = false;
      if (sqrt_of(simplex_.vv()) <= T(margin_)) return QueryEnd::touching;
      if (iterations_ >= options.iterations) return QueryEnd::budget_spent;
      by_foot_ = find_foot();
      const Vec<T> v = by_foot_ ? foot_.v : simplex_.v();
      const T vv = by_foot_ ? dot(v, v) : simplex_.vv();
      const T length = sqrt_of(vv);
      const DifferencePoint<T> w = support(v);
      ++iterations_;
      const T vw = dot(v, w.w);
      const double below = static_cast<double>(vw / length) - margin_;
      gap.lower = std::max(gap.lower, below);
      separated = separated || below > margin_;
      if (below > options.ignore_beyond) return QueryEnd::far_apart;
      const T slack = vv - vw;
      if (slack <= tolerance * vv || slack <= T((by_foot_ ? 0.5 : 0.25) * margin_) * length) break;
      // Names of points on a curve are rounded: different points may have the same name.
      if (named_exactly_ && simplex_.holds(w.name_a, w.name_b)) break;
      const Projection step = simplex_.add(w, T(margin_));
      if (step == Projection::nearer || (step == Projection::no_nearer && by_foot_)) continue;
      // Sets proven to be disjoint stay disjoint: an enclosing simplex is then a rounding error.
      encloses_ = step == Projection::encloses && !separated;
      if (encloses_) simplex_.append(w);
      break;
    }
    return QueryEnd::converged;
  }

  void finish(Gap& gap) const noexcept {
    gap.iterations = iterations_;
    gap.meets = encloses_;
    if (encloses_) {
      gap.lower = gap.upper = 0.0;
      return;
    }
    Vec<T> a{};
    Vec<T> w{};
    for (int i = 0; i < simplex_.size(); ++i) {
      a = a + simplex_.weight(i) * simplex_.point(i).a;
      w = w + simplex_.weight(i) * simplex_.point(i).w;
    }
    Vec<T> v = simplex_.v();
    if (by_foot_) {
      a = foot_.a;
      w = foot_.w;
      v = foot_.v;
    }
    const T length = sqrt_of(dot(v, v));
    gap.p_AQa_W = Vec<double>(a);
    gap.p_AQb_W = Vec<double>(a - w);
    // The witness points are points of the sets even where a thin simplex makes v inaccurate: their
    // distance is an upper bound, and the better estimate.
    const double between = static_cast<double>(sqrt_of(dot(w, w)));
    gap.upper = between * (1.0 + 0x1p-51) + margin_;
    gap.lower *= 1.0 - 0x1p-51;
    gap.distance = std::clamp(between, gap.lower, gap.upper);
    // Adding zero turns a negative zero into a positive one.
    if (length > T(0.0)) gap.n_BA_W = Vec<double>((T(1.0) / length) * v) + Vec<double>();
  }

  /// The points of a cylinder and of the corners of the polytope that are in the simplex, nearest
  /// to each other. False if these corners are those of before, or there is no such foot.
  [[nodiscard]] bool find_foot() noexcept {
    if constexpr (std::is_same_v<T, double>) {
      if (round_ == nullptr) return false;
      const bool is_a = round_ == &A_;
      std::array<std::uint32_t, 4> names{};
      std::array<Vec<double>, 4> corners;  // world axes, from the origin of A
      int count = 0;
      std::uint64_t sum = 0;  // that of others may be the same: then there is one foot less
      for (int i = 0; i < simplex_.size(); ++i) {
        const DifferencePoint<T>& p = simplex_.point(i);
        const std::uint32_t name = is_a ? p.name_b : p.name_a;
        if (std::find(names.begin(), names.begin() + count, name) != names.begin() + count)
          continue;
        names[count] = name;
        corners[count++] = is_a ? p.a - p.w : p.a;
        sum += 1U + std::uint64_t{name} * (name + 3U);
      }
      if (std::exchange(foot_.corners, sum) == sum) return false;
      const Pose& X_W = is_a ? X_WA_ : X_WB_;
      const Vec<double> origin = is_a ? Vec<double>() : p_AB_;
      std::array<Vec<double>, 4> in_frame;
      for (int i = 0; i < count; ++i) in_frame[i] = rotate_transposed(X_W, corners[i] - origin);
      const CylinderFoot foot =
          CylinderFootSearch(*round_).run({in_frame.data(), static_cast<std::size_t>(count)});
      if (!foot.found) return false;
      const Vec<double> c = rotate(X_W, foot.on_cylinder) + origin;
      Vec<double> p = foot.weights.x() * corners[0];
      if (count > 1) p = p + foot.weights.y() * corners[1];
      if (count > 2) p = p + foot.weights.z() * corners[2];
      if (minus_signs(foot.weights) != 0U && !is_in_box(p)) return false;
      foot_.a = is_a ? c : p;
      foot_.w = is_a ? c - p : p - c;
      foot_.v = rotate(X_W, is_a ? -foot.v : foot.v);
      return dot(foot_.v, foot_.v) > margin_ * margin_;
    } else {
      return false;
    }
  }

  /// The polytope beside a cylinder is a box that has this point, to rounding.
  [[nodiscard]] bool is_in_box(const Vec<double>& p) const noexcept {
    const bool is_a = round_ == &B_;
    const Convex& box = is_a ? A_ : B_;
    if (box.kind() != Convex::Kind::box) return false;
    const Vec<double> p_box =
        rotate_transposed(is_a ? X_WA_ : X_WB_, is_a ? p : p - Vec<double>(p_AB_));
    const Vec<double> room = box.half_extents() - magnitudes(p_box);
    return room.x() >= -margin_ && room.y() >= -margin_ && room.z() >= -margin_;
  }

  void store(WarmStart& warm) const noexcept {
    warm.size = static_cast<std::uint8_t>(simplex_.size());
    for (int i = 0; i < simplex_.size(); ++i) {
      warm.a[i] = simplex_.point(i).name_a;
      warm.b[i] = simplex_.point(i).name_b;
    }
  }

  static double sqrt_of(double x) noexcept { return std::sqrt(x); }
  static DoubleDouble sqrt_of(DoubleDouble x) noexcept { return sqrt(x); }

  const Convex& A_;
  const Convex& B_;
  const Pose& X_WA_;
  const Pose& X_WB_;
  bool named_exactly_;
  Vec<T> p_AB_;
  double margin_ = 0.0;
  Simplex<T> simplex_;
  bool encloses_ = false;
  int iterations_ = 0;
  const Convex* round_;  ///< the cylinder of a cylinder and a polytope; else null
  /// Points of a cylinder and some corners of a polytope.
  struct Foot {
    std::uint64_t corners = 0;  ///< which ones
    Vec<T> a{};                 ///< [m] the point of A
    Vec<T> w{};                 ///< [m] from that of B to it
    Vec<T> v{};                 ///< [m] the same, normal to what is straight there
  };
  Foot foot_;
  bool by_foot_ = false;  ///< the last support point is along the foot, not the simplex
};

/// True when the bracket, rounding included, is narrow enough to be reported: relative to the
/// distance and to `size` [m], the sizes involved.
[[nodiscard]] inline bool is_certified(const Gap& gap, const QueryOptions& options,
                                       double size) noexcept {
  if (gap.meets || gap.end == QueryEnd::far_apart || gap.end == QueryEnd::budget_spent) return true;
  const double width = gap.upper - gap.lower;
  const double asked = 2.0 * options.tolerance * gap.upper;
  // 1.5 times the margins on either side.
  return width <= std::max(options.relative_width * gap.upper, asked) &&
         width <= asked + 24.0 * 0x1p-52 * size;
}

}  // namespace detail

/// The distance of A and B. Cases beyond double precision - a gap near rounding, the noisy normal
/// of a needle, nearly parallel discs - are decided in extended precision; a bracket still too wide
/// then ends in `budget_spent`. Cost: one or two support-map pairs when the warm start still holds,
/// otherwise a few more, for curved sets but a cylinder and a polytope a few dozen; at most
/// `options.iterations` in each precision. No heap, no lock.
[[nodiscard]] inline Gap gap_between(const Convex& A, const Pose& X_WA, const Convex& B,
                                     const Pose& X_WB, const QueryOptions& options,
                                     WarmStart& warm) noexcept {
  const bool curved = !A.is_polytope() || !B.is_polytope();
  const bool began_warm = warm.size > 0;
  const double size = A.reach() + B.reach() + norm(origin(X_WB) - origin(X_WA));
  Gap gap = detail::Gjk<double>(A, X_WA, B, X_WB).run(options, warm);
  if (detail::is_certified(gap, options, size)) return gap;
  int spent = gap.iterations;
  if (curved && began_warm) {
    // Points kept from the last tick may be too close to new ones to determine the direction.
    warm.size = 0;
    gap = detail::Gjk<double>(A, X_WA, B, X_WB).run(options, warm);
    gap.iterations += spent;
    if (detail::is_certified(gap, options, size)) return gap;
    spent = gap.iterations;
  }
  gap = detail::Gjk<DoubleDouble>(A, X_WA, B, X_WB).run(options, warm);
  gap.iterations += spent;
  gap.extended = true;
  const bool wide = gap.end == QueryEnd::converged && !detail::is_certified(gap, options, size);
  if (wide) gap.end = QueryEnd::budget_spent;
  return gap;
}

}  // namespace repel
