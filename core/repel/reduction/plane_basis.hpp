/// @file
/// A basis of the linear program of the deepest common point.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <repel/geometry/planes.hpp>

namespace repel::detail {

/// A polytope at its pose, by its planes.
struct PosedPlanes {
  const Planes& planes;
  const Pose& X_W;
  double reach;  ///< [m] of the polytope around the origin of its frame
};

/// Five constraints of max a + b (see DeepestPoint) that hold with equality, and what follows from
/// them: three equations for x once the depths are eliminated, and by the same cofactors the
/// multipliers.
class PlaneBasis {
 public:
  // Names of constraints, as a warm start keeps them: the index of a plane, or one of those that
  // hold for any point of the polytope and bound the first basis.
  static constexpr std::uint32_t first_bound = 0x7FFFFF00U;  ///< four around the polytope
  static constexpr std::uint32_t depth_bound = first_bound + 4;
  static constexpr std::uint32_t not_negative = first_bound + 5;

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

  PlaneBasis(const PosedPlanes& A, const PosedPlanes& B) noexcept
      : sides_{Side{A, Vec<double>()},
               Side{B, column<double>(B.X_W, 3) - column<double>(A.X_W, 3)}} {}

  [[nodiscard]] const Side& side(std::size_t s) const noexcept { return sides_[s]; }
  /// [m] from the origin of A, world axes
  [[nodiscard]] const Vec<double>& point() const noexcept { return x_; }

  void clear() noexcept {
    for (Side& side : sides_) {
      side.count = 0;
      side.at_zero = false;
    }
  }
  void add(std::size_t s, std::uint32_t name) noexcept {
    Side& side = sides_[s];
    if (name == not_negative) {
      side.at_zero = true;
    } else {
      side.rows[static_cast<std::size_t>(side.count++)] = row(side, name);
    }
  }

  /// The three equations for x, its value, the depths there and the multipliers. False when the
  /// equations have no solution.
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
    x_ = solved({values[0], values[1], values[2]});
    // Planes that are nearly parallel: what is left is as well determined as x itself.
    x_ = x_ +
         solved(Vec<double>(values[0], values[1], values[2]) - dots(rows[0], rows[1], rows[2], x_));
    spread(Vec<double>(), {1.0, 1.0}, &Side::multiplier, &Side::zero_multiplier);
    for (Side& side : sides_) {
      side.level = side.at_zero ? 0.0 : side.rows[0].offset - dot(side.rows[0].n, x_);
    }
    return true;
  }

  [[nodiscard]] double least_multiplier() const noexcept {
    double least = std::min(sides_[0].zero_multiplier, sides_[1].zero_multiplier);
    for (const Side& side : sides_) {
      for (int i = 0; i < side.count; ++i) {
        least = std::min(least, side.multiplier[static_cast<std::size_t>(i)]);
      }
    }
    return least;
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

  /// The two tangents of the round side of A (0) or B (1) that face the other, as entries.
  [[nodiscard]] std::array<Entry, 2> facing(std::size_t s) const noexcept {
    const Side& side = sides_[s];
    const Vec<double> across = sides_[1 - s].p - side.p;
    std::array<Entry, 2> entries;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::uint32_t name = side.set.planes.facing(rotate_transposed(side.set.X_W, across))[k];
      const Row r = row(side, name);
      entries[k] = {s, name, side.level + dot(r.n, x_) - r.offset};
    }
    return entries;
  }

  /// Rounding alone can violate a constraint that holds with equality.
  [[nodiscard]] bool holds(const Entry& entry) const noexcept {
    const Side& side = sides_[entry.side];
    if (entry.name == not_negative) return side.at_zero;
    const auto last = side.rows.begin() + side.count;
    return std::any_of(side.rows.begin(), last, [&](const Row& r) { return r.name == entry.name; });
  }

  /// Takes the entry into the basis for the constraint whose multiplier falls to zero first. False
  /// when none falls: the polytopes have no common point.
  /// @param least_share what falls slower than this does not count, being nearly parallel
  bool exchange(const Entry& entry, double least_share) noexcept {
    Side& into = sides_[entry.side];
    const bool is_plane = entry.name != not_negative;
    const Row entering = is_plane ? row(into, entry.name) : Row{Vec<double>(), 0.0, entry.name};
    std::array<double, 2> sums{0.0, 0.0};
    sums[entry.side] = is_plane ? 1.0 : -1.0;
    spread(entering.n, sums, &Side::share, &Side::zero_share);
    // Of multipliers that fall to zero nearly at once, the one that falls fastest goes: its plane
    // is the least parallel to the others (Harris 1973).
    double least = std::numeric_limits<double>::infinity();
    for_each_of_basis([&](Side&, int, double multiplier, double share) {
      if (share > least_share) least = std::min(least, (std::max(multiplier, 0.0) + 1e-12) / share);
    });
    Side* from = nullptr;
    int leaving = 0;
    double fastest = least_share;
    for_each_of_basis([&](Side& side, int i, double multiplier, double share) {
      if (!(share > fastest) || std::max(multiplier, 0.0) / share > least) return;
      fastest = share;
      from = &side;
      leaving = i;
    });
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

 private:
  [[nodiscard]] Vec<double> solved(const Vec<double>& values) const noexcept {
    return inverse_ *
           (values.x() * cofactors_[0] + values.y() * cofactors_[1] + values.z() * cofactors_[2]);
  }
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

  /// Calls with the side, the index of the row, or -1 for the depth not below zero, its multiplier
  /// and its share.
  template <class F>
  void for_each_of_basis(const F& f) noexcept {
    for (Side& side : sides_) {
      if (side.at_zero) f(side, -1, side.zero_multiplier, side.zero_share);
      for (int i = 0; i < side.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        f(side, i, side.multiplier[k], side.share[k]);
      }
    }
  }

  std::array<Side, 2> sides_;
  std::array<Vec<double>, 3> cofactors_;
  double inverse_ = 0.0;
  Vec<double> x_;
};

}  // namespace repel::detail
