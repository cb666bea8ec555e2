// SPDX-License-Identifier: BSD-3-Clause
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

/// A polytope at its pose, described by its planes.
struct PosedPlanes {
  const Planes& planes;
  const Pose& X_W;
  double reach;  ///< [m] of the polytope around the origin of its frame
};

/// The role of each of the five rows of a basis, by the set of rows that belong to B.
struct BasisRoles {
  std::array<std::uint8_t, 2> base{};          ///< for A and B: the row that eliminates the depth
  std::array<std::uint8_t, 3> equation{};      ///< the other rows, which determine x
  std::array<std::uint8_t, 3> side{};          ///< the side of each of these, 0 for A, 1 for B
  std::array<std::array<double, 4>, 2> has{};  ///< 1 where an equation belongs to A, and to B
};

[[nodiscard]] constexpr std::array<BasisRoles, 32> all_basis_roles() {
  std::array<BasisRoles, 32> all{};
  for (unsigned of_b = 1; of_b < 31; ++of_b) {
    std::array<bool, 2> has_base{};
    std::size_t equations = 0;
    for (unsigned k = 0; k < 5; ++k) {
      const unsigned side = of_b >> k & 1U;
      if (!has_base[side]) {
        all[of_b].base[side] = static_cast<std::uint8_t>(k);
        has_base[side] = true;
      } else {
        all[of_b].equation[equations] = static_cast<std::uint8_t>(k);
        all[of_b].has[side][equations] = 1.0;
        all[of_b].side[equations++] = static_cast<std::uint8_t>(side);
      }
    }
  }
  return all;
}

/// Five active constraints of max a + b (see DeepestPoint) and the solution they determine: three
/// equations for x once the depths are eliminated, and, by the same cofactors, the multipliers.
/// Where planes are nearly parallel, solutions by cofactors are refined once: the other constraints
/// would not hold with equality otherwise.
template <class T>
class PlaneBasis {
 public:
  static constexpr std::size_t rows = 5;
  // Names of constraints, as a warm start keeps them: the index of a plane, or one of the bounds
  // that hold for any point of the polytope and form the initial basis.
  static constexpr std::uint32_t first_bound = 0x7FFFFF00U;  ///< four around the polytope
  static constexpr std::uint32_t depth_bound = first_bound + 4;
  static constexpr std::uint32_t not_negative = first_bound + 5;  ///< a depth is at least 0

  struct Entry {
    unsigned side = 0;
    std::uint32_t name = 0;
    T violation{0.0};  ///< [m]
  };

  PlaneBasis(const PosedPlanes& A, const PosedPlanes& B) noexcept
      : sets_{A, B},
        columns_{columns_of(A.X_W), columns_of(B.X_W)},
        p_{Vec<T>(), column<T>(B.X_W, 3) - column<T>(A.X_W, 3)} {}

  /// [m] from the origin of A, world axes
  [[nodiscard]] const Vec<T>& point() const noexcept { return x_; }
  /// [m] Depth of the point below the surface of A (0) or B (1); valid after most_violated().
  [[nodiscard]] T depth(std::size_t side) const noexcept { return depth_[side]; }
  /// [m] Upper bound of the sum of depths of any common point, if no multiplier is negative.
  [[nodiscard]] T bound() const noexcept { return level_[0] + level_[1] + slack_; }
  [[nodiscard]] std::uint32_t name(std::size_t k) const noexcept { return rows_[k].name; }
  [[nodiscard]] unsigned side(std::size_t k) const noexcept { return of_b_ >> k & 1U; }

  void clear() noexcept {
    count_ = 0;
    of_b_ = 0;
  }
  /// Adds `tilt`.x to the objective: against cycling, it separates multipliers of 0.
  void tilt(const Vec<T>& tilt) noexcept { tilt_ = tilt; }
  [[nodiscard]] const Vec<T>& tilt() const noexcept { return tilt_; }
  /// The multipliers without it; they may be negative for a basis optimal only with it.
  void untilt() noexcept { spread({}, {T(1.0), T(1.0)}, multiplier_); }
  /// Adds a constraint to fewer than five; false for an unknown name.
  bool add(unsigned side, std::uint32_t name) noexcept {
    if (!has_plane(side, name) && (name < first_bound || name > not_negative)) {
      return false;
    }
    set_row(count_, side, name);
    of_b_ |= side << count_;
    ++count_;
    if (name == not_negative) put_first(side);
    return true;
  }

  /// Solves for x, the depths there and the multipliers. False when the equations are singular.
  bool weigh() noexcept;

  [[nodiscard]] T least_multiplier() const noexcept {
    T least = multiplier_[0];
    for (const T& multiplier : multiplier_) least = std::min(least, multiplier);
    return least;
  }
  /// The gradient of the sum of the depths with respect to a translation of A, in world axes.
  [[nodiscard]] Vec<T> gradient() const noexcept {
    Vec<T> g{};
    for (std::size_t k = 0; k < rows; ++k) {
      static constexpr std::array<double, 2> counts{1.0, 0.0};
      g = g + (T(counts[side(k)]) * multiplier_[k]) * rows_[k].n;
    }
    return g;
  }

  /// The constraint most violated by the point; a violation of at most `tolerance` [m] counts as
  /// none.
  [[nodiscard]] Entry most_violated(T tolerance) noexcept {
    Entry most{0, 0, tolerance};
    for (unsigned s = 0; s < 2; ++s) {
      const auto& [x, y, z] = columns_[s];
      const auto nearest = sets_[s].planes.nearest(dots(x, y, z, x_ - p_[s]));
      depth_[s] = nearest.depth;
      const T above = level_[s] - nearest.depth;
      if (above > most.violation) most = {s, nearest.plane, above};
      if (-level_[s] > most.violation) most = {s, not_negative, -level_[s]};
    }
    return most;
  }

  /// A plane of A (0) or B (1) and its violation by the point.
  [[nodiscard]] Entry entry(unsigned side, std::uint32_t name) noexcept {
    set_row(rows, side, name);
    const Row& row = rows_[rows];
    return {side, name, level_[side] + dot(row.n, x_) - row.offset};
  }
  /// The two tangent planes of the round side of A (0) or B (1) that face the other polytope.
  [[nodiscard]] std::array<std::uint32_t, 2> facing(unsigned side) const noexcept {
    const Vec<double> across(p_[1 - side] - p_[side]);
    return sets_[side].planes.facing(rotate_transposed(sets_[side].X_W, across));
  }
  [[nodiscard]] bool has_plane(unsigned side, std::uint32_t name) const noexcept {
    return name < sets_[side].planes.size();
  }
  [[nodiscard]] bool is_round(unsigned side) const noexcept {
    return sets_[side].planes.is_round();
  }

  /// True when the constraint is in the basis. A constraint that holds with equality can be
  /// violated by rounding only.
  [[nodiscard]] bool holds(const Entry& entry) const noexcept {
    for (std::size_t k = 0; k < count_; ++k) {
      if (side(k) == entry.side && rows_[k].name == entry.name) return true;
    }
    return false;
  }

  /// Pivot: the entry replaces the constraint with the first multiplier to fall to zero. False if
  /// none falls: the polytopes have no common point.
  /// @param least_share pivot tolerance: smaller shares are ignored, the planes being nearly
  /// parallel
  /// @param late how far below zero rounding may take a multiplier
  bool exchange(const Entry& entry, double least_share, double late) noexcept {
    const bool is_plane = entry.name != not_negative;
    set_row(rows, entry.side, entry.name);
    std::array<T, 2> sums{T(0.0), T(0.0)};
    sums[entry.side] = T(is_plane ? 1.0 : -1.0);
    std::array<T, rows> share;
    spread(rows_[rows].n, sums, share);
    // Of multipliers falling to zero nearly at once, the fastest leaves: its plane is the least
    // parallel to the others (ratio test of Harris 1973).
    const auto falls_at = [&](std::size_t k, double after) {
      return (std::max(multiplier_[k], T(0.0)) + T(after)) / share[k];
    };
    T least(std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < rows; ++k) {
      if (share[k] > T(least_share)) least = std::min(least, falls_at(k, late));
    }
    std::size_t leaving = rows;
    T fastest(least_share);
    for (std::size_t k = 0; k < rows; ++k) {
      if (!(share[k] > fastest) || falls_at(k, 0.0) > least) continue;
      fastest = share[k];
      leaving = k;
    }
    if (leaving == rows) return false;
    rows_[leaving] = rows_[rows];
    of_b_ = (of_b_ & ~(1U << leaving)) | entry.side << leaving;
    put_first(entry.side);
    return true;
  }

 private:
  struct Row {
    Vec<T> n;
    T offset;  ///< [m] around the origin of A
    std::uint32_t name;
  };

  /// Columns of a rotation, in the precision of T.
  using Columns = std::array<Vec<T>, 3>;
  [[nodiscard]] static Columns columns_of(const Pose& X) noexcept {
    return {column<T>(X, 0), column<T>(X, 1), column<T>(X, 2)};
  }

  static constexpr std::array<BasisRoles, 32> all_roles = all_basis_roles();

  /// Moves the constraint "depth not below 0" to the front of the rows of its side: there it
  /// eliminates the depth, like a plane without a normal.
  void put_first(unsigned side) noexcept {
    std::size_t first = count_;
    for (std::size_t k = 0; k < count_; ++k) {
      if (this->side(k) != side) continue;
      first = std::min(first, k);
      if (rows_[k].name == not_negative) std::swap(rows_[k], rows_[first]);
    }
  }

  void set_row(std::size_t k, unsigned side, std::uint32_t name) noexcept {
    Row& row = rows_[k];
    const PosedPlanes& set = sets_[side];
    row.name = name;
    if (name < set.planes.size()) {
      const Vec<T> n(set.planes.normal(name));
      const auto& [x, y, z] = columns_[side];
      row.n = n.x() * x + n.y() * y + n.z() * z;
      row.offset = T(set.planes.offset(name)) + dot(row.n, p_[side]);
      return;
    }
    static constexpr double c = 0.57735026918962576;
    static constexpr double none[4] = {0, 0, 0, 0};
    static constexpr double corners[4][4] = {
        {c, c, c, 0}, {c, -c, -c, 0}, {-c, c, -c, 0}, {-c, -c, c, 0}};
    row.n = from_four<T>(name < depth_bound ? corners[name - first_bound] : none);
    row.offset = name == not_negative ? T(0.0) : T(set.reach) + dot(row.n, p_[side]);
  }

  /// Expresses a constraint as a combination of the rows: their `shares` for one with the normal
  /// `target` and the coefficients `sums` of the depths of A and B.
  void spread(const Vec<T>& target, const std::array<T, 2>& sums,
              std::array<T, rows>& shares) const noexcept {
    const BasisRoles& roles = all_roles[of_b_];
    const Vec<T> of_depths = sums[0] * rows_[roles.base[0]].n + sums[1] * rows_[roles.base[1]].n;
    const Vec<T> aim = target - of_depths;
    Vec<T> t = inverse_ * dots(cofactors_[0], cofactors_[1], cofactors_[2], aim);
    if (thin_) {
      const Vec<T> rest =
          aim - (t.x() * equations_[0] + t.y() * equations_[1] + t.z() * equations_[2]);
      t = t + inverse_ * dots(cofactors_[0], cofactors_[1], cofactors_[2], rest);
    }
    shares[roles.equation[0]] = t.x();
    shares[roles.equation[1]] = t.y();
    shares[roles.equation[2]] = t.z();
    for (std::size_t s = 0; s < 2; ++s) {
      const std::size_t k = roles.base[s];
      const T left = sums[s] - dot(t, from_four<T>(roles.has[s].data()));
      shares[k] = rows_[k].name == not_negative ? -left : left;
    }
  }

  [[nodiscard]] Vec<T> solved(const Vec<T>& values) const noexcept {
    return inverse_ *
           (values.x() * cofactors_[0] + values.y() * cofactors_[1] + values.z() * cofactors_[2]);
  }

  std::array<PosedPlanes, 2> sets_;
  std::array<Columns, 2> columns_;
  std::array<Vec<T>, 2> p_;         ///< [m] the origins of A and B from that of A, world axes
  std::array<Row, rows + 1> rows_;  ///< the basis, and the entering row
  std::array<T, rows> multiplier_;
  std::size_t count_ = 0;
  unsigned of_b_ = 0;  ///< bit k: row k belongs to B
  std::array<Vec<T>, 3> equations_;
  std::array<Vec<T>, 3> cofactors_;
  T inverse_{0.0};
  Vec<T> tilt_{};
  Vec<T> x_;
  std::array<T, 2> level_;  ///< [m] the depths according to the basis
  std::array<T, 2> depth_;  ///< [m] the depths of x below all planes
  bool thin_ = false;       ///< some planes are nearly parallel
  T slack_{0.0};            ///< [m] residuals of the equations in x, weighted by the multipliers
};

template <class T>
bool PlaneBasis<T>::weigh() noexcept {
  const BasisRoles& roles = all_roles[of_b_];
  if (count_ != rows || roles.base[0] == roles.base[1]) return false;
  std::array<T, 3> values;
  for (std::size_t e = 0; e < 3; ++e) {
    const Row& row = rows_[roles.equation[e]];
    const Row& base = rows_[roles.base[roles.side[e]]];
    equations_[e] = row.n - base.n;
    values[e] = row.offset - base.offset;
  }
  cofactors_ = {cross(equations_[1], equations_[2]), cross(equations_[2], equations_[0]),
                cross(equations_[0], equations_[1])};
  const T determinant = dot(equations_[0], cofactors_[0]);
  if (!(std::abs(static_cast<double>(determinant)) > 1e-200)) return false;
  inverse_ = T(1.0) / determinant;
  const Vec<T> value(values[0], values[1], values[2]);
  const auto missed = [&] { return value - dots(equations_[0], equations_[1], equations_[2], x_); };
  x_ = solved(value);
  thin_ = std::abs(static_cast<double>(inverse_)) > 100.0;
  if (thin_) x_ = x_ + solved(missed());
  spread(tilt_, {T(1.0), T(1.0)}, multiplier_);
  for (std::size_t s = 0; s < 2; ++s) {
    const Row& base = rows_[roles.base[s]];
    level_[s] = base.offset - dot(base.n, x_);
  }
  slack_ = T(0.0);
  if (thin_) {
    slack_ = dot(missed(), Vec<T>(multiplier_[roles.equation[0]], multiplier_[roles.equation[1]],
                                  multiplier_[roles.equation[2]]));
  }
  return true;
}

}  // namespace repel::detail
