/// @file
/// The look at last tick's answer: when the same features still are the nearest, one evaluation of
/// both support functions proves it, and nothing has to be searched.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <repel/distance/gap.hpp>
#include <repel/distance/query.hpp>
#include <repel/geometry/convex.hpp>

namespace repel::detail {

/// The vertex p, edge pq or face pqr of A - B that was nearest to the origin when `warm` was
/// written, at today's poses, and its foot v, the point of its span nearest to the origin:
///
///     face    n = (q - p) x (r - p),  v = n (n.p) / n.n,  weights n.(q x r), n.(r x p), n.(p x q)
///     edge    e = q - p,              v = p + t e,        weights 1 - t, t       (t = -p.e / e.e)
///     vertex                          v = p,              weight 1
class KeptFeature {
 public:
  /// `warm` keeps one to three points.
  [[gnu::always_inline]] KeptFeature(const Convex& A, const Pose& X_WA, const Convex& B,
                                     const Pose& X_WB, const WarmStart& warm) noexcept
      : size_(std::min<int>(warm.size, 3)),
        p_AB_(column<double>(X_WB, 3) - column<double>(X_WA, 3)) {
    for (int i = 0; i < size_; ++i) {
      a_[i] = rotate(X_WA, A.place(warm.a[i]));
      w_[i] = a_[i] - (rotate(X_WB, B.place(warm.b[i])) + p_AB_);
    }
    find_foot();
    vv_ = dot(v_, v_);
    vw_ = -(A.support_value(rotate_transposed(X_WA, -v_)) +
            B.support_value(rotate_transposed(X_WB, v_)) + dot(v_, p_AB_));
    margin_ = 0x1p-49 * (A.reach() + B.reach() + sum(magnitudes(p_AB_)));
  }

  /// True when the foot is proven to be the nearest point of A and B within `options`, or the gap
  /// to be larger than `beyond`; never for what is not finite.
  [[nodiscard, gnu::always_inline]] bool still_nearest(const QueryOptions& options, double beyond,
                                                       Gap& gap) const noexcept {
    const double length = std::sqrt(vv_);
    const double lower = (vw_ / length - margin_) * (1.0 - 0x1p-51);
    // The foot as a point of the sets, whatever v has suffered from a thin face.
    const Vec<double> foot = at_foot(w_);
    const double upper = (length + sum(magnitudes(foot - v_))) * (1.0 + 0x1p-51) + margin_;
    const bool converged =
        vv_ - vw_ <= std::max(options.tolerance * vv_, 0.25 * margin_ * length) &&
        upper - lower <= std::max(1e-7, 2.0 * options.tolerance) * upper;
    const bool far = lower > beyond;
    const bool inside = weights_.x() >= 0.0 && weights_.y() >= 0.0 && weights_.z() >= 0.0;
    if (!(inside && (converged || far) && length <= 1e150)) return false;
    gap.distance = std::clamp(length, lower, upper);
    gap.lower = lower;
    gap.upper = upper;
    // Adding zero turns a negative zero into a positive one.
    gap.n_BA_W = (1.0 / length) * v_ + Vec<double>();
    gap.p_AQa_W = at_foot(a_);
    gap.p_AQb_W = gap.p_AQa_W - foot;
    gap.iterations = 1;
    gap.end = far ? QueryEnd::far_apart : QueryEnd::converged;
    return true;
  }

 private:
  void find_foot() noexcept {
    const auto& [p, q, r] = w_;
    v_ = p;
    if (size_ == 1) return;
    const Vec<double> e = q - p;
    if (size_ == 2) {
      const double t = -dot(e, p) / dot(e, e);
      v_ = p + t * e;
      weights_ = {1.0 - t, t, 0.0};
      return;
    }
    const Vec<double> n = cross(e, r - p);
    const Vec<double> areas = dots(cross(q, r), cross(r, p), cross(p, q), n);
    v_ = (dot(n, p) / dot(n, n)) * n;
    weights_ = (1.0 / sum(areas)) * areas;
  }

  [[nodiscard]] Vec<double> at_foot(const std::array<Vec<double>, 3>& x) const noexcept {
    if (size_ == 1) return x[0];
    const Vec<double> two = weights_.x() * x[0] + weights_.y() * x[1];
    return size_ == 2 ? two : two + weights_.z() * x[2];
  }

  int size_;
  Vec<double> p_AB_;                    ///< [m] from the origin of A to that of B, world axes
  std::array<Vec<double>, 3> a_;        ///< [m] from the origin of A, world axes
  std::array<Vec<double>, 3> w_;        ///< [m] p, q, r
  Vec<double> v_;                       ///< [m]
  Vec<double> weights_{1.0, 0.0, 0.0};  ///< of p, q and r; their sum is 1
  double vv_, vw_;                      ///< [m^2]
  double margin_;                       ///< [m]
};

}  // namespace repel::detail
