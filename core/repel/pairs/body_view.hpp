/// @file
/// Conservative transform of body-fixed boxes into the frame of another body.
#pragma once

#include <cmath>

#include <repel/base/vec.hpp>
#include <repel/geometry/box_tree.hpp>

namespace repel::detail {

/// The smallest axis-aligned box that contains `box` transformed by X.
[[nodiscard]] inline Box moved(const Box& box, const Pose& X) noexcept {
  const Vec3 middle = X * centre(box);
  Mat3 magnitudes = rotation(X);
  for (int k = 0; k < 9; ++k) magnitudes.data()[k] = std::abs(magnitudes.data()[k]);
  const Vec3 half = magnitudes * (0.5 * extents(box));
  return {middle - half, middle + half};
}

/// Transforms boxes from the frame of one body to that of another. Since poses are rigid only up to
/// a tolerance, boxes are enlarged and distances reduced by the worst-case error of that tolerance
/// and of rounding.
class BodyView {
 public:
  BodyView(const Pose& X_WFrom, const Pose& X_WTo) noexcept {
    const auto in_to = [&](const Vec<double>& v_W) { return rotate_transposed(X_WTo, v_W); };
    double squares = 0.0;
    for (int k = 0; k < 3; ++k) {
      set_column(X_, k, in_to(column<double>(X_WFrom, k)));
      const Vec<double> off = in_to(column<double>(X_WTo, k)) - Vec<double>(unit(k));
      squares += dot(off, off);
    }
    set_column(X_, 3, in_to(column<double>(X_WFrom, 3) - column<double>(X_WTo, 3)));
    skew_ = std::sqrt(squares) + 1e-14;
    far_ = norm(origin(X_WFrom)) + norm(origin(X_WTo));
  }
  /// A box in the frame of the other body that contains `original`.
  [[nodiscard]] Box box(const Box& original) const noexcept {
    Box box = moved(original, X_);
    const double far = far_ + norm(centre(box)) + norm(extents(box));
    const double slack = 2.0 * skew_ * far;
    for (int axis = 0; axis < 3; ++axis) {
      box.min()[axis] -= slack;
      box.max()[axis] += slack;
    }
    return box;
  }
  /// A lower bound [m] of the world-frame distance whose value in that frame is `distance`.
  [[nodiscard]] double lower_bound(double distance) const noexcept {
    return (1.0 - skew_) * distance;
  }

 private:
  Pose X_ = Pose::Identity();  ///< [m] of the first body in the frame of the other
  double skew_;                ///< deviation of the other frame's axes from orthonormality
  double far_;                 ///< [m] sum of both bodies' distances from the world origin
};

}  // namespace repel::detail
