// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// SIMD proof for several pairs at once that the features of the last tick still contain the
/// nearest points.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <repel/base/lanes.hpp>
#include <repel/distance/query.hpp>
#include <repel/geometry/convex.hpp>

namespace repel::detail {

/// One side (A or B) of several pairs, one lane per pair.
struct LaneSets {
  std::array<const Convex*, lane_count> sets{};
  LanePose X_W{};                    ///< [m]
  std::array<LaneVec, 3> corners{};  ///< [m] corners of the features, in the frames of the sets
  std::array<LaneVec, 3> turned{};   ///< [m] the same in world axes, from the origins of the sets
  LaneVec half_extents{};            ///< [m] of boxes
  std::array<VertexBlock, lane_count> vertices{};  ///< of hulls that are scanned
  unsigned scanned = 0;  ///< bit k: the support map of lane k scans `vertices`
  unsigned hulls = 0;    ///< bit k: the set of lane k is not a box

  /// @param names of the corners of the feature in the set
  void set(int k, const Convex& one, const std::array<std::uint32_t, 4>& names) noexcept {
    sets[static_cast<std::size_t>(k)] = &one;
    for (std::size_t i = 0; i < 3; ++i) corners[i].set(k, one.place(names[i]));
    half_extents.set(k, one.half_extents());
    const unsigned bit = 1U << k;
    hulls = (hulls & ~bit) | (one.kind() == Convex::Kind::box ? 0U : bit);
    scanned = (scanned & ~bit) | (one.is_scanned() ? bit : 0U);
    if (one.is_scanned()) vertices[static_cast<std::size_t>(k)] = one.vertices();
  }

  /// To be called after `X_W` or a lane was set and before the next proof. Never inlined, because
  /// the compiler might then round differently: sets at rest are rotated only once.
  [[gnu::noinline]] void turn() noexcept {
    for (std::size_t i = 0; i < 3; ++i) turned[i] = X_W.rotate(corners[i]);
  }

  /// `Convex::support_value` of each set along `d`, given in its own frame.
  [[nodiscard]] Lanes support_values(const LaneVec& d) const noexcept {
    Lanes values = dot(half_extents, magnitudes(d));
    for (unsigned left = scanned; left != 0U; left &= left - 1U) {
      const int k = std::countr_zero(left);
      values[k] = vertices[static_cast<std::size_t>(k)].largest_product(Vec<double>(d.at(k)));
    }
    for (unsigned left = hulls & ~scanned; left != 0U; left &= left - 1U) {
      const int k = std::countr_zero(left);
      values[k] = sets[static_cast<std::size_t>(k)]->support_value(Vec<double>(d.at(k)));
    }
    return values;
  }
};

/// The members of Gap, one lane per pair.
struct LaneGap {
  Lanes distance, lower, upper;      ///< [m]
  LaneVec n_BA_W, p_AQa_W, p_AQb_W;  ///< [1], [m], [m]
  LaneVec n_A, n_B;                  ///< [1] unit, outward from each set, in its own frame
  LaneMask proven;                   ///< lane k is a valid result for its pair
};

/// `confirm_nearest` for several pairs of boxes and polytopes. It evaluates vertex, edge and face
/// formulas for all lanes, as lanes may differ, and applies the same proof: an accepted result lies
/// within the same bracket, the last bits of which may differ by the order of summation. The result
/// of a lane does not depend on the others.
struct FeatureLanes {
  LaneSets A, B;
  Lanes size{};   ///< number of corners of the features
  Lanes reach{};  ///< [m] sum of the reaches of A and B

  /// @param warm left by the last query on the pair, with 1 to 3 corners
  void set(int k, const Convex& a, const Convex& b, const WarmStart& warm) noexcept {
    A.set(k, a, warm.a);
    B.set(k, b, warm.b);
    size[k] = warm.size;
    reach[k] = a.reach() + b.reach();
  }

  /// Every lane must be set, and `A` and `B` turned.
  [[nodiscard]] LaneGap prove(const QueryOptions& options) const noexcept {
    const LaneVec p_AB = B.X_W.columns[3] - A.X_W.columns[3];
    std::array<LaneVec, 3> w;  // [m] points of A - B, world axes
    for (std::size_t i = 0; i < 3; ++i) w[i] = A.turned[i] - (B.turned[i] + p_AB);
    const Foot foot = foot_on(w);
    const Lanes vv = dot(foot.v, foot.v);
    const Lanes length = roots(vv);
    const Lanes margin = 0x1p-49 * (sum(magnitudes(p_AB)) + reach);
    const LaneVec v_A = A.X_W.rotate_transposed(-foot.v);
    const LaneVec v_B = B.X_W.rotate_transposed(foot.v);
    const Lanes least_vw = -(A.support_values(v_A) + B.support_values(v_B) + dot(foot.v, p_AB));
    LaneGap gap;
    const Lanes inverse = 1.0 / length;
    gap.n_A = inverse * v_A;
    gap.n_B = inverse * v_B;
    gap.lower = (least_vw * inverse - margin) * (1.0 - 0x1p-50);
    const LaneVec mean_w = mean(w, foot);
    const Lanes off = sum(magnitudes(mean_w - foot.v));
    gap.upper = (length + off) * (1.0 + 0x1p-51) + margin;
    const double width = std::max(options.relative_width, 2.0 * options.tolerance);
    const LaneMask converged = (vv - least_vw <= larger(options.tolerance * vv, margin * length)) &
                               (off <= margin) & (gap.upper - gap.lower <= width * gap.upper);
    const LaneMask inside = (foot.p >= 0.0) & (foot.q >= 0.0) & (foot.r >= 0.0);
    gap.proven = inside & converged & (length >= 1e-150) & (length <= 1e150);
    gap.distance = smaller(larger(length, gap.lower), gap.upper);
    gap.n_BA_W = inverse * foot.v + LaneVec{};
    gap.p_AQa_W = mean(A.turned, foot);
    gap.p_AQb_W = gap.p_AQa_W - mean_w;
    return gap;
  }

 private:
  /// The point nearest to the origin and the barycentric weights of the three corners.
  struct Foot {
    LaneVec v;
    Lanes p, q, r;
  };

  // A feature with fewer than three corners has arbitrary other points of its sets in the unused
  // slots, with weight 0.
  [[nodiscard]] Foot foot_on(const std::array<LaneVec, 3>& w) const noexcept {
    const LaneMask is_corner = size == 1.0;
    const LaneMask is_face = size == 3.0;
    const auto& [p, q, r] = w;
    const LaneVec e = q - p;
    const Lanes scale = 1.0 / dot(e, e);
    const Lanes first = scale * dot(e, p);
    const LaneVec slanted = p - first * e;
    const Lanes rest = scale * dot(e, slanted);
    const Lanes none{};
    const Lanes along = either(is_corner, none, first + rest);
    Foot foot{either(is_corner, p, slanted - rest * e), 1.0 + along, -along, none};
    if (bits_of(is_face) == 0U) return foot;
    const LaneVec n = cross(e, r - p);
    const LaneVec areas{dot(cross(q, r), n), dot(cross(r, p), n), dot(cross(p, q), n)};
    const Lanes share = 1.0 / sum(areas);
    foot.v = either(is_face, (dot(n, p) / dot(n, n)) * n, foot.v);
    foot.p = either(is_face, share * areas.x, foot.p);
    foot.q = either(is_face, share * areas.y, foot.q);
    foot.r = either(is_face, share * areas.z, foot.r);
    return foot;
  }

  [[nodiscard]] static LaneVec mean(const std::array<LaneVec, 3>& x, const Foot& foot) noexcept {
    return foot.p * x[0] + foot.q * x[1] + foot.r * x[2];
  }
};

}  // namespace repel::detail
