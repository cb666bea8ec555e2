// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Conservative transform of body-fixed boxes into the frame of another body.
#pragma once

#include <repel/base/vec.hpp>
#include <repel/geometry/box_tree.hpp>

namespace repel::detail {

/// The smallest axis-aligned box that contains `box` transformed by X.
[[nodiscard]] inline Box moved(const Box& box, const Pose& X) noexcept {
  const Vec<double> middle = rotate(X, Vec<double>(centre(box))) + column<double>(X, 3);
  const Vec3 half = 0.5 * extents(box);
  const auto reach = [&](int k) { return half[k] * magnitudes(column<double>(X, k)); };
  const Vec<double> around = reach(0) + reach(1) + reach(2);
  return {to_vec3(middle - around), to_vec3(middle + around)};
}

/// Transforms boxes from the frame of one body to that of another. Since poses are rigid only up to
/// a tolerance, boxes are enlarged and distances reduced by the worst-case error of that tolerance
/// and of rounding.
class BodyView {
 public:
  BodyView(const Pose& X_WFrom, const Pose& X_WTo) noexcept {
    const auto in_to = [&](const Vec<double>& v_W) { return rotate_transposed(X_WTo, v_W); };
    Vec<double> off(0.0, 0.0, 0.0);
    for (int k = 0; k < 3; ++k) {
      set_column(X_, k, in_to(column<double>(X_WFrom, k)));
      off = off + magnitudes(in_to(column<double>(X_WTo, k)) - Vec<double>(unit(k)));
    }
    set_column(X_, 3, in_to(column<double>(X_WFrom, 3) - column<double>(X_WTo, 3)));
    skew_ = sum(off) + 1e-14;
    far_ = sum(magnitudes(column<double>(X_WFrom, 3))) + sum(magnitudes(column<double>(X_WTo, 3)));
  }
  /// A box in the frame of the other body that contains `original`.
  [[nodiscard]] Box box(const Box& original) const noexcept {
    Box box = moved(original, X_);
    const double far =
        far_ + sum(magnitudes(Vec<double>(box.min()))) + sum(magnitudes(Vec<double>(box.max())));
    const double slack = 2.0 * skew_ * far;
    const Vec3 more(slack, slack, slack);
    return {box.min() - more, box.max() + more};
  }
  /// A lower bound [m] of the world-frame distance whose value in that frame is `distance`.
  [[nodiscard]] double lower_bound(double distance) const noexcept {
    return (1.0 - skew_) * distance;
  }

 private:
  Pose X_ = Pose::Identity();  ///< [m] of the first body in the frame of the other
  double skew_;  ///< bound of the deviation of the other frame's axes from orthonormal
  double far_;   ///< [m] bound of both bodies' distances from the world origin, summed
};

}  // namespace repel::detail
