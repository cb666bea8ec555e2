// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A number stored as the unevaluated sum of two doubles: about 32 digits, for decisions that
/// double cannot make.
#pragma once

#include <cmath>

#ifdef __FAST_MATH__
#error "repel needs IEEE arithmetic: compile without -ffast-math"
#endif

namespace repel {

namespace detail {
/// A product as it was rounded. Without -ffp-contract=off GCC fuses products with the sums they go
/// into; then what is computed to be the rounding error of a sum is not.
[[nodiscard]] inline double as_rounded(double product) noexcept {
#if defined(__has_builtin)
#if __has_builtin(__builtin_assoc_barrier)
  return __builtin_assoc_barrier(product);
#endif
#endif
  return product;
}
}  // namespace detail

/// `hi + lo` with |lo| at most half an ulp of hi. Relative error of each operation: about 2^-102.
/// Error-free sum: Knuth, TAOCP 2, 4.2.2; error-free product: by fused multiply-add.
struct DoubleDouble {
  double hi = 0.0;  ///< the sum, rounded to double
  double lo = 0.0;  ///< what that rounding left

  DoubleDouble() = default;
  /// Exact.
  DoubleDouble(double value) noexcept : hi(value) {}
  /// By its parts, |low| at most half an ulp of `high`.
  DoubleDouble(double high, double low) noexcept : hi(high), lo(low) {}

  /// The nearest double.
  explicit operator double() const noexcept { return hi + lo; }

  /// A + b, exact.
  [[nodiscard]] static DoubleDouble sum(double a, double b) noexcept {
    const double s = a + b;
    const double b_part = s - a;
    return {s, (a - (s - b_part)) + (b - b_part)};
  }
  /// A b, exact unless it underflows.
  [[nodiscard]] static DoubleDouble product(double a, double b) noexcept {
    const double p = detail::as_rounded(a * b);
    return {p, std::fma(a, b, -p)};
  }
  /// As `sum`, for |a| >= |b|.
  [[nodiscard]] static DoubleDouble ordered_sum(double a, double b) noexcept {
    const double s = a + b;
    return {s, b - (s - a)};
  }

  /// Sum.
  friend DoubleDouble operator+(DoubleDouble a, DoubleDouble b) noexcept {
    DoubleDouble high = sum(a.hi, b.hi);
    const DoubleDouble low = sum(a.lo, b.lo);
    high = ordered_sum(high.hi, high.lo + low.hi);
    return ordered_sum(high.hi, high.lo + low.lo);
  }
  /// Negative, exact.
  friend DoubleDouble operator-(DoubleDouble a) noexcept { return {-a.hi, -a.lo}; }
  /// Difference.
  friend DoubleDouble operator-(DoubleDouble a, DoubleDouble b) noexcept { return a + (-b); }
  /// Product.
  friend DoubleDouble operator*(DoubleDouble a, DoubleDouble b) noexcept {
    const DoubleDouble p = product(a.hi, b.hi);
    return ordered_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
  }
  /// Quotient.
  friend DoubleDouble operator/(DoubleDouble a, DoubleDouble b) noexcept {
    const double first = a.hi / b.hi;
    const DoubleDouble rest = a - b * DoubleDouble(first);
    const double second = rest.hi / b.hi;
    const DoubleDouble last = rest - b * DoubleDouble(second);
    return ordered_sum(first, second) + DoubleDouble(last.hi / b.hi);
  }
  /// Adds in place.
  DoubleDouble& operator+=(DoubleDouble b) noexcept { return *this = *this + b; }

  /// Less.
  friend bool operator<(DoubleDouble a, DoubleDouble b) noexcept {
    return a.hi < b.hi || (a.hi == b.hi && a.lo < b.lo);
  }
  /// Greater.
  friend bool operator>(DoubleDouble a, DoubleDouble b) noexcept { return b < a; }
  /// Not greater.
  friend bool operator<=(DoubleDouble a, DoubleDouble b) noexcept { return !(b < a); }
  /// Not less.
  friend bool operator>=(DoubleDouble a, DoubleDouble b) noexcept { return !(a < b); }
};

/// Square root, relative error about 2^-100; 0 for a value that is not positive.
[[nodiscard]] inline DoubleDouble sqrt(DoubleDouble a) noexcept {
  if (!(a.hi > 0.0)) return 0.0;
  const double root = std::sqrt(a.hi);
  const DoubleDouble rest = a - DoubleDouble::product(root, root);
  return DoubleDouble::ordered_sum(root, rest.hi / (2.0 * root));
}

}  // namespace repel
