/// @file
/// The deepest common point of two polytopes: a linear program of five variables.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <repel/distance/query.hpp>
#include <repel/geometry/planes.hpp>

namespace repel::detail {

/// A polytope at its pose, by its planes.
struct PosedPlanes {
  const Planes& planes;
  const Pose& X_W;
  double reach;  ///< [m] of the polytope around the origin of its frame
};

/// Where two polytopes overlap, the point x at which the depths below the surfaces of both together
/// are largest:
///
///     max a + b   with   n.x + a <= o for all planes (n, o) of A,   a >= 0,   and so for b and B.
///
/// Two balls around x, of radii a and b, lie in A and B: nothing shorter than a + b parts the
/// shapes. Moved along, the maximum is concave, changes no faster than the shapes move, and its
/// gradient are the multipliers of A's planes: the force it gives is conservative.
///
/// Solved by the dual simplex method. A basis is five of the constraints that hold with equality;
/// x follows from three equations, and so do the multipliers. While these are not negative, the
/// basis gives an upper bound; the plane that x violates most comes in and the one whose multiplier
/// falls to zero first goes out. A basis that was best at the last tick is mostly the best again.
class DeepestPoint {
 public:
  static constexpr int cap = 64;  ///< pivots

  DeepestPoint(const PosedPlanes& A, const PosedPlanes& B) noexcept
      : sides_{Side{A, Vec<double>()},
               Side{B, column<double>(B.X_W, 3) - column<double>(A.X_W, 3)}} {
    tolerance_ = 0x1p-49 * (A.reach + B.reach + sum(magnitudes(sides_[1].p)));
  }

  /// Begins with the basis in `warm` where it has one that still holds, and leaves the last one
  /// there. False when the polytopes have no common point, or none was found in `cap` pivots.
  [[nodiscard, gnu::flatten, gnu::noinline]] bool solve(WarmStart& warm) noexcept {
    bool kept = load(warm) && weigh();
    if (!kept) {
      begin();
      if (!weigh()) return false;
    }
    for (pivots_ = 0; pivots_ < cap; ++pivots_) {
      const Entry entry = most_violated();
      if (!(entry.violation > tolerance_)) {
        if (!kept) save(warm);
        return std::min(depth(0), depth(1)) >= -tolerance_;
      }
      if (!exchange(entry) || !weigh()) return false;
      kept = false;
    }
    return false;
  }

  /// The depth below the surface of A (0) or B (1) [m].
  [[nodiscard]] double depth(std::size_t side) const noexcept { return sides_[side].depth; }
  /// The point [m], from the origin of A, world axes.
  [[nodiscard]] const Vec<double>& point() const noexcept { return x_; }
  /// The gradient of the sum of the depths when A moves, world axes; at most 1 long.
  [[nodiscard]] Vec<double> gradient() const noexcept {
    Vec<double> g{};
    for (int i = 0; i < sides_[0].count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      g = g + sides_[0].multiplier[k] * sides_[0].rows[k].n;
    }
    return g;
  }
  [[nodiscard]] int pivots() const noexcept { return pivots_; }

 private:
  // Names of constraints in a warm start: the index of a plane, or one of those that hold for any
  // point of the polytope and bound the first basis; with the side in the highest bit.
  static constexpr std::uint32_t side_bit = 0x80000000U;
  static constexpr std::uint32_t first_bound = 0x7FFFFF00U;  ///< four around the polytope
  static constexpr std::uint32_t depth_bound = first_bound + 4;
  static constexpr std::uint32_t not_negative = first_bound + 5;
  static constexpr std::uint8_t basis_size = 5;

  struct Row {
    Vec<double> n;
    double offset;  ///< [m] around the origin of A
    std::uint32_t name;
  };
  struct Side {
    Side(const PosedPlanes& of, const Vec<double>& from_a) noexcept : set(of), p(from_a) {}

    const PosedPlanes& set;
    Vec<double> p;            ///< [m] its origin from that of A, world axes
    std::array<Row, 5> rows;  ///< of the basis
    std::array<double, 5> multiplier;
    std::array<double, 5> share;  ///< of the rows in the one that enters
    int count = 0;
    bool at_zero = false;  ///< the constraint of a depth not below 0 is in the basis
    double zero_multiplier = 0.0;
    double zero_share = 0.0;
    double level = 0.0;  ///< [m] the depth by the basis
    double depth = 0.0;  ///< [m] the depth of x
  };
  struct Entry {
    std::size_t side = 0;
    std::uint32_t name = 0;
    double violation = 0.0;  ///< [m]
  };

  [[nodiscard]] static Row row(const Side& side, std::uint32_t name) noexcept {
    const PosedPlanes& set = side.set;
    Row r{Vec<double>(), set.reach, name};
    if (name < set.planes.size()) {
      r.n = rotate(set.X_W, set.planes.normal(name));
      r.offset = set.planes.offset(name);
    } else if (name < depth_bound) {
      static constexpr double c = 0.57735026918962576;
      static constexpr double corners[4][4] = {
          {c, c, c, 0}, {c, -c, -c, 0}, {-c, c, -c, 0}, {-c, -c, c, 0}};
      r.n = from_four<double>(corners[(name - first_bound) % 4]);
    }
    r.offset += dot(r.n, side.p);
    return r;
  }
  static void add(Side& side, std::uint32_t name) noexcept {
    if (name == not_negative) {
      side.at_zero = true;
    } else {
      side.rows[static_cast<std::size_t>(side.count++)] = row(side, name);
    }
  }

  void clear() noexcept {
    for (Side& side : sides_) {
      side.count = 0;
      side.at_zero = false;
    }
  }
  /// Four planes all around A and the largest depth B can have: a basis of anything.
  void begin() noexcept {
    clear();
    for (std::uint32_t k = 0; k < 4; ++k) add(sides_[0], first_bound + k);
    add(sides_[1], depth_bound);
  }
  bool load(const WarmStart& warm) noexcept {
    clear();
    if (warm.level_a != WarmStart::deepest_point) return false;
    for (std::size_t k = 0; k < basis_size; ++k) {
      const std::uint32_t name = k < 4 ? warm.a[k] : warm.b[0];
      Side& side = sides_[name >> 31U];
      const std::uint32_t own = name & ~side_bit;
      const bool known =
          own < side.set.planes.size() || (own >= first_bound && own <= not_negative);
      if (!known || (own == not_negative && side.at_zero)) return false;
      add(side, own);
    }
    return sides_[0].count > 0 && sides_[1].count > 0;
  }
  void save(WarmStart& warm) const noexcept {
    std::size_t k = 0;
    const auto put = [&](std::uint32_t name) {
      (k < 4 ? warm.a[k] : warm.b[0]) = name;
      ++k;
    };
    for (std::uint32_t s = 0; s < 2; ++s) {
      const Side& side = sides_[s];
      const std::uint32_t bit = s == 0 ? 0U : side_bit;
      for (int i = 0; i < side.count && k < basis_size; ++i) {
        put(side.rows[static_cast<std::size_t>(i)].name | bit);
      }
      if (side.at_zero && k < basis_size) put(not_negative | bit);
    }
    warm.size = 0;
    warm.level_a = WarmStart::deepest_point;
    warm.level_b = WarmStart::deepest_point;
  }

  /// The three equations for x, its value, the depths there and the multipliers. False when the
  /// equations have no solution or a multiplier is negative.
  bool weigh() noexcept {
    std::array<Vec<double>, 3> rows;
    std::array<double, 3> values;
    std::size_t used = 0;
    for (const Side& side : sides_) {
      for (int i = side.at_zero ? 0 : 1; i < side.count && used < 3; ++i) {
        const Row& r = side.rows[static_cast<std::size_t>(i)];
        const Row& base = side.rows[0];
        rows[used] = side.at_zero ? r.n : r.n - base.n;
        values[used++] = side.at_zero ? r.offset : r.offset - base.offset;
      }
    }
    if (used != 3) return false;
    cofactors_ = {cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])};
    const double determinant = dot(rows[0], cofactors_[0]);
    if (!(std::abs(determinant) > 1e-200)) return false;
    inverse_ = 1.0 / determinant;
    x_ = inverse_ *
         (values[0] * cofactors_[0] + values[1] * cofactors_[1] + values[2] * cofactors_[2]);
    spread(Vec<double>(), {1.0, 1.0}, &Side::multiplier, &Side::zero_multiplier);
    bool feasible = true;
    for (Side& side : sides_) {
      side.level = side.at_zero ? 0.0 : side.rows[0].offset - dot(side.rows[0].n, x_);
      feasible &= !side.at_zero || side.zero_multiplier >= -negligible;
      for (int i = 0; i < side.count; ++i) {
        feasible &= side.multiplier[static_cast<std::size_t>(i)] >= -negligible;
      }
    }
    return feasible;
  }

  /// The shares of the constraints of the basis in one with the normal `target` and the factors
  /// `sums` before the depths of A and B.
  void spread(Vec<double> target, const std::array<double, 2>& sums,
              std::array<double, 5> Side::*shares, double Side::*zero_share) noexcept {
    for (std::size_t s = 0; s < 2; ++s) {
      if (!sides_[s].at_zero) target = target - sums[s] * sides_[s].rows[0].n;
    }
    const std::array<double, 3> t{inverse_ * dot(cofactors_[0], target),
                                  inverse_ * dot(cofactors_[1], target),
                                  inverse_ * dot(cofactors_[2], target)};
    std::size_t used = 0;
    for (std::size_t s = 0; s < 2; ++s) {
      Side& side = sides_[s];
      double rest = sums[s];
      for (int i = side.at_zero ? 0 : 1; i < side.count && used < 3; ++i) {
        (side.*shares)[static_cast<std::size_t>(i)] = t[used];
        rest -= t[used++];
      }
      if (!side.at_zero) (side.*shares)[0] = rest;
      side.*zero_share = side.at_zero ? -rest : 0.0;
    }
  }

  [[nodiscard]] Entry most_violated() noexcept {
    Entry most;
    for (std::size_t s = 0; s < 2; ++s) {
      Side& side = sides_[s];
      const Planes::Nearest nearest =
          side.set.planes.nearest(rotate_transposed(side.set.X_W, x_ - side.p));
      side.depth = nearest.depth;
      const double above = side.level - nearest.depth;
      if (above > most.violation) most = {s, nearest.plane, above};
      if (-side.level > most.violation) most = {s, not_negative, -side.level};
    }
    return most;
  }

  /// Takes the entry into the basis for the constraint whose multiplier falls to zero first. False
  /// when none falls: the polytopes have no common point.
  bool exchange(const Entry& entry) noexcept {
    Side& into = sides_[entry.side];
    const bool is_plane = entry.name != not_negative;
    const Row entering = is_plane ? row(into, entry.name) : Row{Vec<double>(), 0.0, entry.name};
    std::array<double, 2> sums{0.0, 0.0};
    sums[entry.side] = is_plane ? 1.0 : -1.0;
    spread(entering.n, sums, &Side::share, &Side::zero_share);
    double least = std::numeric_limits<double>::infinity();
    Side* from = nullptr;
    int leaving = 0;  // -1 for the depth not below zero
    const auto consider = [&](Side& side, int i, double multiplier, double share) {
      if (!(share > 1e-9)) return;
      const double ratio = std::max(multiplier, 0.0) / share;
      if (!(ratio < least)) return;
      least = ratio;
      from = &side;
      leaving = i;
    };
    for (Side& side : sides_) {
      if (side.at_zero) consider(side, -1, side.zero_multiplier, side.zero_share);
      for (int i = 0; i < side.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        consider(side, i, side.multiplier[k], side.share[k]);
      }
    }
    if (from == nullptr) return false;
    if (leaving < 0) {
      from->at_zero = false;
    } else {
      from->rows[static_cast<std::size_t>(leaving)] =
          from->rows[static_cast<std::size_t>(--from->count)];
    }
    if (is_plane) {
      into.rows[static_cast<std::size_t>(into.count++)] = entering;
    } else {
      into.at_zero = true;
    }
    return sides_[0].count > 0 && sides_[1].count > 0;
  }

  static constexpr double negligible = 1e-9;  ///< of a multiplier

  std::array<Side, 2> sides_;
  double tolerance_ = 0.0;  ///< [m] what rounding can move a depth by
  std::array<Vec<double>, 3> cofactors_;
  double inverse_ = 0.0;
  Vec<double> x_;
  int pivots_ = 0;
};

}  // namespace repel::detail
