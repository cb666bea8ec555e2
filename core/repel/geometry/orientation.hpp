// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Orientation predicate: on which side of the plane through three points a fourth one lies,
/// decided exactly. Set-up only: it allocates.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include <repel/base/vec.hpp>

namespace repel {

namespace detail {

/// An exact sum of doubles: nonoverlapping components, the largest last (Shewchuk 1997,
/// grow-expansion). Exact unless a product underflows.
class ExactSum {
 public:
  void add(double x) {
    std::size_t kept = 0;
    for (const double part : parts_) {
      const DoubleDouble s = DoubleDouble::sum(x, part);
      if (s.lo != 0.0) parts_[kept++] = s.lo;
      x = s.hi;
    }
    while (parts_.size() > kept) parts_.pop_back();
    if (x != 0.0) parts_.push_back(x);
  }
  void add_product(double x, double y) {
    const DoubleDouble p = DoubleDouble::product(x, y);
    add(p.lo);
    add(p.hi);
  }
  void add_product(double x, double y, double z) {
    const DoubleDouble p = DoubleDouble::product(x, y);
    add_product(p.lo, z);
    add_product(p.hi, z);
  }
  /// The products of each component of x with each of y, and of z.
  void add_product(DoubleDouble x, DoubleDouble y) {
    for (const double a : {x.hi, x.lo}) {
      for (const double b : {y.hi, y.lo}) add_product(a, b);
    }
  }
  void add_product(DoubleDouble x, DoubleDouble y, DoubleDouble z) {
    for (const double a : {x.hi, x.lo}) {
      for (const double b : {y.hi, y.lo}) {
        for (const double c : {z.hi, z.lo}) add_product(a, b, c);
      }
    }
  }

  [[nodiscard]] int sign() const {
    if (parts_.empty()) return 0;
    return parts_.back() > 0.0 ? 1 : -1;
  }
  [[nodiscard]] DoubleDouble value() const {
    DoubleDouble sum;
    for (const double part : parts_) sum += part;
    return sum;
  }

 private:
  std::vector<double> parts_;
};

/// The exact difference of two points: one double-double per coordinate.
using ExactVector = std::array<DoubleDouble, 3>;

/// a - b.
inline ExactVector exact_difference(const Vec3& a, const Vec3& b) {
  return {DoubleDouble::sum(a.x(), -b.x()), DoubleDouble::sum(a.y(), -b.y()),
          DoubleDouble::sum(a.z(), -b.z())};
}

inline Vec<DoubleDouble> finer(const ExactVector& v) {
  return {v[0], v[1], v[2]};
}

inline int exact_sign_of_determinant(const ExactVector& u, const ExactVector& v,
                                     const ExactVector& w) {
  ExactSum sum;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t after = (k + 1) % 3;
    const std::size_t last = (k + 2) % 3;
    sum.add_product(u[k], v[after], w[last]);
    sum.add_product(-u[k], v[last], w[after]);
  }
  return sum.sign();
}

/// The cross product, each component rounded once.
inline Vec<DoubleDouble> exact_cross(const ExactVector& u, const ExactVector& v) {
  ExactVector n;
  for (std::size_t k = 0; k < 3; ++k) {
    ExactSum sum;
    sum.add_product(u[(k + 1) % 3], v[(k + 2) % 3]);
    sum.add_product(-u[(k + 2) % 3], v[(k + 1) % 3]);
    n[k] = sum.value();
  }
  return finer(n);
}

}  // namespace detail

/// The sign of the volume spanned by b - a, c - a and p - a: 1 when p lies on the side of the plane
/// from which a, b, c appear counter-clockwise, -1 on the other, 0 in the plane. Correct for any
/// doubles without underflow of triple products: computed in double within its error bound, then in
/// DoubleDouble within its own, then with exact sums.
[[nodiscard]] inline int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 u = b - a;
  const Vec3 v = c - a;
  const Vec3 w = p - a;
  const double determinant = dot(u.cross(v), w);
  const Vec3 products = {std::abs(u.y() * v.z()) + std::abs(u.z() * v.y()),
                         std::abs(u.z() * v.x()) + std::abs(u.x() * v.z()),
                         std::abs(u.x() * v.y()) + std::abs(u.y() * v.x())};
  const double magnitude = dot(products, Vec3(std::abs(w.x()), std::abs(w.y()), std::abs(w.z())));
  if (std::abs(determinant) > 1e-15 * magnitude) return determinant > 0.0 ? 1 : -1;
  const detail::ExactVector exact_u = detail::exact_difference(b, a);
  const detail::ExactVector exact_v = detail::exact_difference(c, a);
  const detail::ExactVector exact_w = detail::exact_difference(p, a);
  const double finer =
      dot(cross(detail::finer(exact_u), detail::finer(exact_v)), detail::finer(exact_w)).hi;
  if (std::abs(finer) > 1e-29 * magnitude) return finer > 0.0 ? 1 : -1;
  return detail::exact_sign_of_determinant(exact_u, exact_v, exact_w);
}

/// The unit normal of the plane through a, b, c, on the side from which they appear
/// counter-clockwise, with an error of about half an ulp per coordinate however thin the triangle;
/// zero when they are exactly collinear.
[[nodiscard]] inline Vec3 plane_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const detail::ExactVector u = detail::exact_difference(b, a);
  const detail::ExactVector v = detail::exact_difference(c, a);
  Vec<DoubleDouble> n = cross(detail::finer(u), detail::finer(v));
  if (!(norm(to_vec3(n)) > 1e-12 * norm(b - a) * norm(c - a))) n = detail::exact_cross(u, v);
  // Scaled first: the squared normal of a thin triangle might underflow.
  const double scale = largest_entry(to_vec3(n));
  if (!(scale > 0.0)) return {0, 0, 0};
  n = DoubleDouble(std::exp2(-std::ilogb(scale))) * n;
  return to_vec3((DoubleDouble(1.0) / sqrt(dot(n, n))) * n);
}

}  // namespace repel
