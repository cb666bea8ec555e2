/// @file
/// Boxes that are fixed to one body, seen from another.
#pragma once

#include <cmath>

#include <repel/base/vec.hpp>
#include <repel/geometry/box_tree.hpp>

namespace repel::detail {

/// The box around a box that is moved.
[[nodiscard]] inline Box moved(const Box& box, const Pose& X) noexcept {
  const Vec3 centre = X * box.center();
  const Vec3 half = X.linear().cwiseAbs() * (0.5 * box.sizes());
  return {centre - half, centre + half};
}

/// How boxes of one body look from the frame of another: grown by what that frame is short of a
/// rigid one, and by rounding.
class BodyView {
 public:
  BodyView(const Pose& X_WFrom, const Pose& X_WTo) noexcept {
    const auto seen = [&](const Vec<double>& v_W) { return rotate_transposed(X_WTo, v_W); };
    double squares = 0.0;
    for (int k = 0; k < 3; ++k) {
      set_column(X_, k, seen(column<double>(X_WFrom, k)));
      const Vec<double> of_itself = seen(column<double>(X_WTo, k)) - Vec<double>(Vec3::Unit(k));
      squares += dot(of_itself, of_itself);
    }
    set_column(X_, 3, seen(column<double>(X_WFrom, 3) - column<double>(X_WTo, 3)));
    skew_ = std::sqrt(squares) + 1e-14;
    far_ = X_WFrom.translation().norm() + X_WTo.translation().norm();
  }
  [[nodiscard]] Box box(const Box& of) const noexcept {
    Box box = moved(of, X_);
    const double far = far_ + box.center().norm() + box.sizes().norm();
    const Vec3 slack = Vec3::Constant(2.0 * skew_ * far);
    box.min() -= slack;
    box.max() += slack;
    return box;
  }
  /// What a distance in that frame is at least.
  [[nodiscard]] double sure(double distance) const noexcept { return (1.0 - skew_) * distance; }

 private:
  Pose X_ = Pose::Identity();  ///< [m] of the first body in the other
  double skew_;                ///< what the other frame's axes are short of orthonormal ones
  double far_;                 ///< [m] how far both are from the origin of the world
};

}  // namespace repel::detail
