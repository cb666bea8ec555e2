/// @file
/// The proof that last tick's features still hold the nearest points, for several pairs at once.
#pragma once

#include <array>
#include <cstddef>

#include <repel/base/lanes.hpp>
#include <repel/distance/query.hpp>
#include <repel/geometry/convex.hpp>

namespace repel::detail {

/// Two sets at their poses and what the last query on them has left.
struct LanePair {
  const Convex* A;
  const Pose* X_WA;
  const Convex* B;
  const Pose* X_WB;
  const WarmStart* warm;
  double beyond;  ///< [m] a gap proven to be larger need not be known better
};

/// The members of Gap, a lane for each pair, and in bits what was proven.
struct LaneGap {
  Lanes distance, lower, upper;      ///< [m]
  LaneVec n_BA_W, p_AQa_W, p_AQb_W;  ///< [1], [m], [m]
  LaneVec p_WA;                      ///< [m] origin of A
  unsigned proven = 0;               ///< bit k: lane k is the answer of its pair
  unsigned far = 0;                  ///< bit k: proven to be farther than asked, no better
};

/// `still_nearest` of several pairs. It looks at faces, edges and vertices alike, as the lanes may
/// have any of them, and has the same proof: what it accepts is true within the same bracket, to
/// the last bits of which the order of its sums may differ. What a lane answers does not depend on
/// the others.
class FeatureLanes {
 public:
  /// Of boxes and polytopes.
  explicit FeatureLanes(const std::array<LanePair, lane_count>& pairs) noexcept
      : pairs_(pairs),
        X_WA_(LanePose::of([&](int k) -> const Pose& { return *at(k).X_WA; })),
        X_WB_(LanePose::of([&](int k) -> const Pose& { return *at(k).X_WB; })),
        p_AB_(X_WB_.columns[3] - X_WA_.columns[3]) {
    for (std::size_t i = 0; i < 3; ++i) {
      a_[i] = X_WA_.rotate(LaneVec::of([&](int k) { return at(k).A->place(at(k).warm->a[i]); }));
      const LaneVec b = LaneVec::of([&](int k) { return at(k).B->place(at(k).warm->b[i]); });
      w_[i] = a_[i] - (X_WB_.rotate(b) + p_AB_);
    }
  }

  [[nodiscard]] LaneGap prove(const QueryOptions& options) const noexcept {
    const Foot foot = foot_on_features();
    const Lanes vv = dot(foot.v, foot.v);
    const Lanes length = roots(vv);
    const Lanes reach = lanes_of([&](int k) { return at(k).A->reach() + at(k).B->reach(); });
    const Lanes margin = 0x1p-49 * (sum(magnitudes(p_AB_)) + reach);
    const Lanes least_vw = least_products(foot.v);
    LaneGap gap;
    gap.lower = (least_vw / length - margin) * (1.0 - 0x1p-51);
    const LaneVec w = mean(w_, foot);
    const Lanes off = sum(magnitudes(w - foot.v));
    gap.upper = (length + off) * (1.0 + 0x1p-51) + margin;
    const double width = std::max(options.relative_width, 2.0 * options.tolerance);
    const LaneMask converged = (vv - least_vw <= larger(options.tolerance * vv, margin * length)) &
                               (off <= margin) & (gap.upper - gap.lower <= width * gap.upper);
    const LaneMask far = gap.lower > lanes_of([&](int k) { return at(k).beyond; });
    const LaneMask inside = (foot.p >= 0.0) & (foot.q >= 0.0) & (foot.r >= 0.0);
    gap.proven = bits_of(inside & (converged | far) & (length <= 1e150));
    gap.far = bits_of(far);
    gap.distance = smaller(larger(length, gap.lower), gap.upper);
    const Lanes inverse = 1.0 / length;
    gap.n_BA_W = inverse * foot.v + LaneVec{};
    gap.p_AQa_W = mean(a_, foot);
    gap.p_AQb_W = gap.p_AQa_W - w;
    gap.p_WA = X_WA_.columns[3];
    return gap;
  }

 private:
  /// The nearest point and the weights of the three corners in it.
  struct Foot {
    LaneVec v;
    Lanes p, q, r;
  };

  [[nodiscard]] const LanePair& at(int k) const noexcept {
    return pairs_[static_cast<std::size_t>(k)];
  }

  // A feature of fewer than three corners has some others of its sets in their places, and no
  // weight on them.
  [[nodiscard]] Foot foot_on_features() const noexcept {
    const LaneMask is_corner =
        lanes_of([&](int k) { return static_cast<double>(at(k).warm->size); }) == 1.0;
    const LaneMask is_face =
        lanes_of([&](int k) { return static_cast<double>(at(k).warm->size); }) == 3.0;
    const auto& [p, q, r] = w_;
    const LaneVec e = q - p;
    const Lanes scale = 1.0 / dot(e, e);
    const Lanes first = scale * dot(e, p);
    const LaneVec slanted = p - first * e;
    const Lanes rest = scale * dot(e, slanted);
    const LaneVec n = cross(e, r - p);
    const LaneVec areas{dot(cross(q, r), n), dot(cross(r, p), n), dot(cross(p, q), n)};
    const Lanes share = 1.0 / sum(areas);
    const LaneVec on_face = (dot(n, p) / dot(n, n)) * n;
    const Lanes none{};
    const Lanes whole = none + 1.0;
    const LaneVec on_edge = slanted - rest * e;
    return {either(is_face, on_face, either(is_corner, p, on_edge)),
            is_face ? share * areas.x : (is_corner ? whole : whole + (first + rest)),
            is_face ? share * areas.y : (is_corner ? none : -(first + rest)),
            is_face ? share * areas.z : none};
  }

  [[nodiscard]] static LaneVec mean(const std::array<LaneVec, 3>& x, const Foot& foot) noexcept {
    return foot.p * x[0] + foot.q * x[1] + foot.r * x[2];
  }

  /// The least products of v with a point of A - B.
  [[nodiscard]] Lanes least_products(const LaneVec& v) const noexcept {
    const Lanes of_a = support_values(&LanePair::A, X_WA_.rotate_transposed(-v));
    const Lanes of_b = support_values(&LanePair::B, X_WB_.rotate_transposed(v));
    return -(of_a + of_b + dot(v, p_AB_));
  }

  /// Of one of the two sets of each pair along `d`, in its own frame.
  [[nodiscard]] Lanes support_values(const Convex* LanePair::*set,
                                     const LaneVec& d) const noexcept {
    bool boxes = true;
    for (const LanePair& pair : pairs_) boxes &= (pair.*set)->kind() == Convex::Kind::box;
    if (boxes) {
      return dot(LaneVec::of([&](int k) { return (at(k).*set)->half_extents(); }), magnitudes(d));
    }
    const std::array<Vec<double>, lane_count> each = d.each();
    return lanes_of(
        [&](int k) { return (at(k).*set)->support_value(each[static_cast<std::size_t>(k)]); });
  }

  const std::array<LanePair, lane_count>& pairs_;
  LanePose X_WA_;
  LanePose X_WB_;
  LaneVec p_AB_;              ///< [m] world axes
  std::array<LaneVec, 3> a_;  ///< [m] points of A, from the origin of A, world axes
  std::array<LaneVec, 3> w_;  ///< [m] a - b
};

}  // namespace repel::detail
