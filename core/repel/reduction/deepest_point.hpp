/// @file
/// The deepest common point of two polytopes: a linear program of five variables.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <repel/distance/query.hpp>
#include <repel/reduction/plane_basis.hpp>

namespace repel::detail {

/// Where two polytopes overlap, the point x at which the depths below the surfaces of both together
/// are largest:
///
///     max a + b   with   n.x + a <= o for all planes (n, o) of A,   a >= 0,   and so for b and B.
///
/// Two balls around x, of radii a and b, lie in A and B: nothing shorter than a + b parts the
/// shapes. Moved along, the maximum is concave, changes no faster than the shapes move, and its
/// gradient are the multipliers of A's planes: the force it gives is conservative.
///
/// Solved by the dual simplex method. While the multipliers are not negative a basis gives an upper
/// bound; the plane that x violates most comes in and the one whose multiplier falls to zero first
/// goes out. A basis that was best at the last tick is mostly the best again.
class DeepestPoint {
 public:
  static constexpr int cap = 72;  ///< pivots of one attempt, of which there are at most three
  static constexpr int most_pivots = 3 * cap;

  DeepestPoint(const PosedPlanes& A, const PosedPlanes& B) noexcept
      : basis_(A, B),
        tolerance_(0x1p-49 * (A.reach + B.reach + sum(magnitudes(basis_.side(1).p)))) {}

  /// Begins with the basis in `warm` where it has one that still holds, and leaves the last one
  /// there. False when the polytopes have no common point deeper than rounding, or none was found.
  [[nodiscard, gnu::flatten, gnu::noinline]] bool solve(WarmStart& warm,
                                                        int allowed = most_pivots) noexcept {
    pivots_ = 0;
    if (load(warm) && basis_.weigh() && basis_.least_multiplier() >= -1e-9 &&
        improve(1e-9, allowed)) {
      if (pivots_ > 0) save(warm);
      return true;
    }
    // Planes that are nearly parallel can bar the way to one choice of pivots and not to another.
    for (const double least_share : {1e-9, 1e-7}) {
      if (!begin(least_share) || !improve(least_share, allowed)) continue;
      save(warm);
      return true;
    }
    return false;
  }

  /// The depth of the point below the surface of A (0) or B (1) [m].
  [[nodiscard]] double depth(std::size_t side) const noexcept { return basis_.side(side).depth; }
  /// The point [m], from the origin of A, world axes.
  [[nodiscard]] const Vec<double>& point() const noexcept { return basis_.point(); }
  /// The gradient of the sum of the depths when A moves, world axes; at most 1 long.
  [[nodiscard]] Vec<double> gradient() const noexcept {
    const PlaneBasis::Side& side = basis_.side(0);
    Vec<double> g{};
    for (int i = 0; i < side.count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      g = g + side.multiplier[k] * side.rows[k].n;
    }
    return g;
  }
  [[nodiscard]] int pivots() const noexcept { return pivots_; }

 private:
  /// Exchanges planes until none is violated; whether the point is the deepest then.
  bool improve(double least_share, int allowed) noexcept {
    const int begun = pivots_;
    for (; pivots_ < allowed; ++pivots_) {
      const PlaneBasis::Entry entry = basis_.most_violated();
      const int pivots = pivots_ - begun;
      if (!(entry.violation > enough(pivots)) || basis_.holds(entry) || pivots == cap ||
          !basis_.exchange(entry, least_share) || !basis_.weigh()) {
        return is_best();
      }
    }
    return false;
  }

  static constexpr std::uint32_t side_bit = 0x80000000U;  ///< of a name in a warm start: B
  static constexpr std::size_t basis_size = 5;

  /// [m] Planes that are nearly parallel say less well where x is than how deep it is: in the end a
  /// small violation is let pass. It is no error of the depth, which is measured at x.
  [[nodiscard]] double enough(int pivots) const noexcept {
    return (pivots < 48 ? 1.0 : pivots < 64 ? 256.0 : 65536.0) * tolerance_;
  }
  /// The depths at x are as large, to 2e-8 of the size, as the basis says they can be at most.
  [[nodiscard]] bool is_best() const noexcept {
    const double possible = basis_.side(0).level + basis_.side(1).level;
    return basis_.least_multiplier() >= -1e-6 && std::min(depth(0), depth(1)) >= -tolerance_ &&
           depth(0) + depth(1) > 4.0 * tolerance_ &&
           possible - (depth(0) + depth(1)) <= 1e7 * tolerance_;
  }

  /// Four planes all around A and the largest depth B can have: a basis of anything. Between round
  /// sides the way out mostly is where they face each other, and the search for it would be long.
  bool begin(double least_share) noexcept {
    basis_.clear();
    for (std::uint32_t k = 0; k < 4; ++k) basis_.add(0, PlaneBasis::first_bound + k);
    basis_.add(1, PlaneBasis::depth_bound);
    if (!basis_.weigh()) return false;
    for (const std::size_t s : {0U, 1U}) {
      if (!basis_.side(s).set.planes.is_round()) continue;
      for (const std::size_t k : {0U, 1U}) {
        const PlaneBasis::Entry entry = basis_.facing(s)[k];
        if (!(entry.violation > 0.0) || basis_.holds(entry)) continue;
        ++pivots_;
        if (!basis_.exchange(entry, least_share) || !basis_.weigh()) return false;
      }
    }
    return true;
  }
  bool load(const WarmStart& warm) noexcept {
    basis_.clear();
    if (warm.level_a != WarmStart::deepest_point) return false;
    for (std::size_t k = 0; k < basis_size; ++k) {
      const std::uint32_t name = k < 4 ? warm.a[k] : warm.b[0];
      const std::uint32_t own = name & ~side_bit;
      const PlaneBasis::Side& side = basis_.side(name >> 31U);
      const bool known = own < side.set.planes.size() ||
                         (own >= PlaneBasis::first_bound && own <= PlaneBasis::not_negative);
      if (!known || (own == PlaneBasis::not_negative && side.at_zero)) return false;
      basis_.add(name >> 31U, own);
    }
    return basis_.side(0).count > 0 && basis_.side(1).count > 0;
  }
  void save(WarmStart& warm) const noexcept {
    std::size_t k = 0;
    const auto put = [&](std::uint32_t name) {
      if (k < basis_size) (k < 4 ? warm.a[k] : warm.b[0]) = name;
      ++k;
    };
    for (const std::size_t s : {0U, 1U}) {
      const PlaneBasis::Side& side = basis_.side(s);
      const std::uint32_t bit = s == 0 ? 0U : side_bit;
      for (int i = 0; i < side.count; ++i) put(side.rows[static_cast<std::size_t>(i)].name | bit);
      if (side.at_zero) put(PlaneBasis::not_negative | bit);
    }
    warm.size = 0;
    warm.level_a = WarmStart::deepest_point;
    warm.level_b = WarmStart::deepest_point;
  }

  PlaneBasis basis_;
  double tolerance_;  ///< [m] what rounding can move a depth by
  int pivots_ = 0;
};

}  // namespace repel::detail
