// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The deepest common point of two polytopes: a linear program with five variables.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <repel/distance/query.hpp>
#include <repel/reduction/plane_basis.hpp>

namespace repel::detail {

/// A face of one box and the three faces of the other one at its corner below it, by their names.
struct BoxStart {
  unsigned side = 0;                      ///< which box the face is of: A (0) or B (1)
  std::uint32_t face = 0;                 ///< of that box
  std::array<std::uint32_t, 3> corner{};  ///< of the other one
};

/// Of all faces of two boxes, the one with the shortest way out for the other box, and the last
/// corner of that box to leave. The deepest common point is mostly near it. Cost: six support
/// functions.
/// @param tilt of the objective, in world axes: it decides for one of the corners of a parallel
/// edge or face
[[nodiscard]] inline BoxStart box_start(const PosedPlanes& A, const PosedPlanes& B,
                                        const Vec<double>& tilt) noexcept {
  const std::array<const PosedPlanes*, 2> boxes{&A, &B};
  const Vec<double> p_AB = column<double>(B.X_W, 3) - column<double>(A.X_W, 3);
  BoxStart start;
  double least = std::numeric_limits<double>::infinity();
  Vec<double> outward = Vec<double>();
  for (unsigned side = 0; side < 2; ++side) {
    const PosedPlanes& box = *boxes[side];
    const PosedPlanes& other = *boxes[1 - side];
    const Planes& of_other = other.planes;
    const Vec<double> half(of_other.offset(0), of_other.offset(2), of_other.offset(4));
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const Vec<double> n = column<double>(box.X_W, static_cast<int>(axis));
      const double along = side == 0 ? dot(n, p_AB) : -dot(n, p_AB);
      const double overlap = box.planes.offset(2 * axis) - std::abs(along) +
                             dot(half, magnitudes(rotate_transposed(other.X_W, n)));
      if (!(overlap < least)) continue;
      least = overlap;
      outward = along < 0.0 ? -n : n;
      start.side = side;
      start.face = 2 * axis + (along < 0.0 ? 1U : 0U);
    }
  }
  const unsigned minus = minus_signs(rotate_transposed(boxes[1 - start.side]->X_W, tilt - outward));
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    start.corner[axis] = 2 * axis + (minus >> axis & 1U);
  }
  return start;
}

/// In an overlap, the point x with the largest sum of the depths below both surfaces:
///
///     max a + b   with   n.x + a <= o for all planes (n, o) of A,   a >= 0,   and so for b and B.
///
/// The balls around x with radii a and b lie inside A and B, so no translation shorter than a + b
/// separates the shapes. As a function of a translation, the maximum is concave, changes no faster
/// than the shapes move, and its gradient is given by the multipliers of the planes of A: the
/// resulting force is conservative.
///
/// Solved by the dual simplex method. While no multiplier is negative, a basis gives an upper
/// bound. The plane most violated by x enters, and the first multiplier to fall to zero leaves. The
/// optimal basis of the last tick is mostly optimal again.
class DeepestPoint {
 public:
  static constexpr int most_pivots = 216;  ///< total of all attempts in both precisions

  DeepestPoint(const PosedPlanes& A, const PosedPlanes& B) noexcept
      : A_(A),
        B_(B),
        size_(A.reach + B.reach +
              sum(magnitudes(column<double>(B.X_W, 3) - column<double>(A.X_W, 3)))),
        slack_(A.planes.slack() + B.planes.slack()) {}

  /// Warm starts from the basis in `warm` if it is still dual feasible, and stores the last basis
  /// there. False when the polytopes have no common point deeper than rounding, or none was found.
  /// @param doubted the polytopes may be disjoint: infeasibility found in double precision is then
  /// accepted, and left to the gap search to confirm
  [[nodiscard]] bool solve(WarmStart& warm, int allowed = most_pivots,
                           bool doubted = false) noexcept {
    pivots_ = 0;
    doubted_ = doubted;
    const End end = solve_in_double(warm, allowed);
    return end == End::best || (end == End::unclear && solve_at_length(warm, allowed) == End::best);
  }

  /// The depth of the point below the surface of A (0) or B (1) [m].
  [[nodiscard]] double depth(std::size_t side) const noexcept { return depth_[side]; }
  /// The point [m], from the origin of A, world axes.
  [[nodiscard]] const Vec<double>& point() const noexcept { return point_; }
  /// The gradient of the sum of the depths with respect to a translation of A, in world axes;
  /// length at most 1.
  [[nodiscard]] const Vec<double>& gradient() const noexcept { return gradient_; }
  /// [m] How far the point may be outside the polytopes, by rounding, apart from the margins of the
  /// planes; the sum for both.
  [[nodiscard]] double outside() const noexcept { return outside_; }
  [[nodiscard]] int pivots() const noexcept { return pivots_; }

 private:
  enum class End { best, none, unclear };

  static constexpr std::uint32_t side_bit = 0x80000000U;  ///< of a name in a warm start: B

  /// Pivot limits and tolerances in one precision.
  template <class T>
  struct Precision {
    static constexpr bool is_double = std::is_same_v<T, double>;
    static constexpr int warm_pivots = is_double ? 24 : 40;
    static constexpr int cold_pivots = is_double ? 72 : 80;
    static constexpr double of_depth = is_double ? 0x1p-49 : 0x1p-86;  ///< relative to the size
    /// Relative to the size, how far outside a sliver the point may be: what is left is subtracted.
    static constexpr double of_place =
        is_double ? 0x1p-43 : std::numeric_limits<double>::infinity();
    /// Above the rounding of a multiplier, and far below the tilt, which it would hide.
    static constexpr double of_multiplier = is_double ? 1e-15 : 1e-24;
    static constexpr double least_share = is_double ? 1e-9 : 1e-18;
    /// Of the objective, a perturbation [-]: it separates multipliers of 0, and makes one of
    /// several deepest points the answer, cold as well as warm. Above rounding, and so little that
    /// the answer is the deepest point but for rounding.
    static constexpr double tilt = is_double ? 1e-12 : 1e-20;
  };

  [[gnu::flatten, gnu::noinline]] End solve_in_double(WarmStart& warm, int allowed) noexcept {
    return solve_in<double>(warm, allowed);
  }
  [[gnu::noinline]] End solve_at_length(WarmStart& warm, int allowed) noexcept {
    return solve_in<DoubleDouble>(warm, allowed);
  }

  template <class T>
  End solve_in(WarmStart& warm, int allowed) noexcept {
    PlaneBasis<T> basis(A_, B_);
    // Around a round side, the planes that are nearly right are many, and the tilt leads past them.
    if (!Precision<T>::is_double || !(basis.is_round(0) || basis.is_round(1))) {
      constexpr double tilt = Precision<T>::tilt;
      basis.tilt(rotated<T>({0.7 * tilt, -0.4 * tilt, 0.5 * tilt}));
    }
    End end = End::unclear;
    if (load(warm, basis) && basis.weigh() &&
        basis.least_multiplier() >= T(-Precision<T>::of_multiplier)) {
      const int before = pivots_;
      end = improve(basis, std::min(allowed, pivots_ + Precision<T>::warm_pivots + more_pivots()));
      if (end == End::best && pivots_ == before) return end;
    }
    if (end == End::unclear && begin(warm, basis, allowed)) {
      end = improve(basis, std::min(allowed, pivots_ + Precision<T>::cold_pivots + more_pivots()));
    }
    save(basis, warm);
    return end;
  }

  /// Around an ellipsoid, the planes that are nearly right are many in two directions.
  [[nodiscard]] int more_pivots() const noexcept { return slack_ > 0.0 ? 120 : 0; }

  /// Pivots until no plane is violated, or the number of pivots reaches `most`.
  template <class T>
  End improve(PlaneBasis<T>& basis, int most) noexcept {
    const T tolerance(Precision<T>::of_depth * size_ + slack_);
    while (true) {
      const auto entry = basis.most_violated(tolerance);
      if (!(entry.violation > tolerance) || basis.holds(entry)) return judge(basis, tolerance);
      if (pivots_ >= most) return End::unclear;
      if (!replace(basis, entry)) return doubted_ ? End::none : End::unclear;
      if (!basis.weigh()) return End::unclear;
    }
  }
  template <class T>
  bool replace(PlaneBasis<T>& basis, const typename PlaneBasis<T>::Entry& entry) noexcept {
    ++pivots_;
    return basis.exchange(entry, Precision<T>::least_share, Precision<T>::of_multiplier);
  }

  /// Checks that the depths at the point reach their upper bound, and exceed rounding.
  template <class T>
  End judge(PlaneBasis<T>& basis, const T& tolerance) noexcept {
    basis.untilt();
    const T found = basis.depth(0) + basis.depth(1);
    // The perturbation can reduce a multiplier that is 0 by twice the tilt.
    if (!(basis.least_multiplier() >= T(-Precision<T>::of_multiplier - 2.0 * Precision<T>::tilt)) ||
        basis.bound() - found > T(4.0) * tolerance) {
      return End::unclear;
    }
    outside_ = 0.0;
    for (std::size_t s = 0; s < 2; ++s) {
      const double above = std::max(0.0, -static_cast<double>(basis.depth(s)));
      outside_ += above * (s == 0 ? A_ : B_).planes.sharpness();
    }
    if (outside_ > Precision<T>::of_place * size_ + 4.0 * slack_) return End::unclear;
    point_ = Vec<double>(basis.point());
    gradient_ = Vec<double>(basis.gradient());
    for (std::size_t s = 0; s < 2; ++s) depth_[s] = static_cast<double>(basis.depth(s));
    return depth_[0] + depth_[1] > 4.0 * Precision<double>::of_depth * size_ ? End::best
                                                                             : End::none;
  }

  /// The initial basis, valid for any input: four bounding planes around A and the largest depth
  /// that B can have. Then the planes of the last tick enter, or otherwise the tangent planes of
  /// round sides facing the other shape: the extraction direction is mostly there, and its search
  /// would be long.
  template <class T>
  bool begin(const WarmStart& warm, PlaneBasis<T>& basis, int allowed) noexcept {
    const bool cold = warm.level_a != WarmStart::deepest_point;
    if (cold && A_.planes.is_box() && B_.planes.is_box() && begin_at_corner(basis)) return true;
    basis.clear();
    for (std::uint32_t k = 0; k < 4; ++k) basis.add(0, PlaneBasis<T>::first_bound + k);
    basis.add(1, PlaneBasis<T>::depth_bound);
    bool is_basis = basis.weigh();
    const auto hint = [&](unsigned side, std::uint32_t name) {
      if (!is_basis || pivots_ >= allowed || !basis.has_plane(side, name)) return;
      const auto entry = basis.entry(side, name);
      if (entry.violation > T(0.0) && !basis.holds(entry))
        is_basis = replace(basis, entry) && basis.weigh();
    };
    if (warm.level_a == WarmStart::deepest_point) {
      for (std::size_t k = 0; k < PlaneBasis<T>::rows; ++k) {
        hint(name_in(warm, k) >> 31U, name_in(warm, k) & ~side_bit);
      }
    } else {
      for (const unsigned side : {0U, 1U}) {
        if (!basis.is_round(side)) continue;
        for (const std::uint32_t name : basis.facing(side)) hint(side, name);
      }
    }
    return is_basis;
  }
  /// The initial basis of two boxes, at a corner of one of them: below the surface of the other by
  /// as much as that box has to move, and not at all below its own. False where, by rounding, a
  /// multiplier is negative.
  template <class T>
  bool begin_at_corner(PlaneBasis<T>& basis) noexcept {
    const BoxStart start = box_start(A_, B_, Vec<double>(basis.tilt()));
    basis.clear();
    basis.add(start.side, start.face);
    for (const std::uint32_t face : start.corner) basis.add(1 - start.side, face);
    basis.add(1 - start.side, PlaneBasis<T>::not_negative);
    return basis.weigh() && basis.least_multiplier() >= T(-Precision<T>::of_multiplier);
  }
  /// A vector in the frame of A, in world axes.
  template <class T>
  [[nodiscard]] Vec<T> rotated(const Vec3& v_A) const noexcept {
    return T(v_A.x()) * column<T>(A_.X_W, 0) + T(v_A.y()) * column<T>(A_.X_W, 1) +
           T(v_A.z()) * column<T>(A_.X_W, 2);
  }
  [[nodiscard]] static std::uint32_t name_in(const WarmStart& warm, std::size_t k) noexcept {
    return k < 4 ? warm.a[k] : warm.b[0];
  }
  template <class T>
  static bool load(const WarmStart& warm, PlaneBasis<T>& basis) noexcept {
    basis.clear();
    if (warm.level_a != WarmStart::deepest_point) return false;
    for (std::size_t k = 0; k < PlaneBasis<T>::rows; ++k) {
      const std::uint32_t name = name_in(warm, k);
      if (!basis.add(name >> 31U, name & ~side_bit)) return false;
    }
    return true;
  }
  template <class T>
  static void save(const PlaneBasis<T>& basis, WarmStart& warm) noexcept {
    for (std::size_t k = 0; k < PlaneBasis<T>::rows; ++k) {
      (k < 4 ? warm.a[k] : warm.b[0]) = basis.name(k) | (basis.side(k) == 0 ? 0U : side_bit);
    }
    warm.size = 0;
    warm.level_a = WarmStart::deepest_point;
    warm.level_b = WarmStart::deepest_point;
  }

  PosedPlanes A_;
  PosedPlanes B_;
  double size_;   ///< [m]
  double slack_;  ///< [m] Planes::slack of both
  int pivots_ = 0;
  bool doubted_ = false;
  std::array<double, 2> depth_{};
  double outside_ = 0.0;  ///< [m]
  Vec<double> point_{};
  Vec<double> gradient_{};
};

}  // namespace repel::detail
