// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A 3-vector of a chosen precision: the vector type of code that runs both in double and in
/// DoubleDouble.
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include <repel/base/double_double.hpp>
#include <repel/base/types.hpp>

namespace repel {

namespace detail {
template <class T>
struct Coordinates {
  T x, y, z;
};
/// As in a register of four, so all units read the same layout at any register width.
template <>
struct alignas(32) Coordinates<double> {
  double x, y, z;
  double none = 0.0;
};
}  // namespace detail

/// `Vec<T> v;` leaves the coordinates uninitialized, `Vec<T>()` is zero.
template <class T>
class Vec {
 public:
  Vec() = default;
  /// By entries.
  Vec(T x, T y, T z) noexcept : at_{x, y, z} {}
  /// Exact.
  explicit Vec(const Vec3& v) noexcept : at_{v.x(), v.y(), v.z()} {}
  /// Converts entry by entry; rounds where T is narrower.
  template <class U>
  requires(!std::same_as<U, T>) explicit Vec(const Vec<U>& v) noexcept
      : at_{static_cast<T>(v.x()), static_cast<T>(v.y()), static_cast<T>(v.z())} {}

  [[nodiscard]] T x() const noexcept { return at_.x; }  ///< first entry
  [[nodiscard]] T y() const noexcept { return at_.y; }  ///< second entry
  [[nodiscard]] T z() const noexcept { return at_.z; }  ///< third entry

  /// Sum.
  friend Vec operator+(const Vec& a, const Vec& b) noexcept {
    return {a.at_.x + b.at_.x, a.at_.y + b.at_.y, a.at_.z + b.at_.z};
  }
  /// Difference.
  friend Vec operator-(const Vec& a, const Vec& b) noexcept {
    return {a.at_.x - b.at_.x, a.at_.y - b.at_.y, a.at_.z - b.at_.z};
  }
  /// Negative.
  friend Vec operator-(const Vec& a) noexcept { return {-a.at_.x, -a.at_.y, -a.at_.z}; }
  /// Multiple.
  friend Vec operator*(T s, const Vec& a) noexcept {
    return {s * a.at_.x, s * a.at_.y, s * a.at_.z};
  }

  /// Scalar product.
  friend T dot(const Vec& a, const Vec& b) noexcept {
    return a.at_.x * b.at_.x + a.at_.y * b.at_.y + a.at_.z * b.at_.z;
  }
  /// Vector product.
  friend Vec cross(const Vec& a, const Vec& b) noexcept {
    return {a.at_.y * b.at_.z - a.at_.z * b.at_.y, a.at_.z * b.at_.x - a.at_.x * b.at_.z,
            a.at_.x * b.at_.y - a.at_.y * b.at_.x};
  }
  /// The dot products of `d` with `a`, `b` and `c`.
  friend Vec dots(const Vec& a, const Vec& b, const Vec& c, const Vec& d) noexcept {
    return {dot(a, d), dot(b, d), dot(c, d)};
  }
  /// The absolute value of each entry.
  friend Vec magnitudes(const Vec& a) noexcept {
    return {std::abs(a.at_.x), std::abs(a.at_.y), std::abs(a.at_.z)};
  }
  /// Sum of the entries.
  friend T sum(const Vec& a) noexcept { return a.at_.x + a.at_.y + a.at_.z; }
  /// The elementwise product.
  friend Vec product(const Vec& a, const Vec& b) noexcept {
    return {a.at_.x * b.at_.x, a.at_.y * b.at_.y, a.at_.z * b.at_.z};
  }
  /// Bit k is set when coordinate k has its sign bit set, also for a negative zero.
  friend unsigned minus_signs(const Vec& a) noexcept {
    return (is_minus(a.at_.x) ? 1U : 0U) | (is_minus(a.at_.y) ? 2U : 0U) |
           (is_minus(a.at_.z) ? 4U : 0U);
  }
  /// The sum of `a`, `b` and `c`, each negated where the corresponding coordinate of `d` has its
  /// sign bit set: `a` by x, `b` by y, `c` by z.
  friend Vec sum_along(const Vec& a, const Vec& b, const Vec& c, const Vec& d) noexcept {
    return (is_minus(d.at_.x) ? -a : a) + (is_minus(d.at_.y) ? -b : b) +
           (is_minus(d.at_.z) ? -c : c);
  }

 private:
  static bool is_minus(double x) noexcept { return std::signbit(x); }
  static bool is_minus(DoubleDouble x) noexcept { return std::signbit(x.hi); }

  detail::Coordinates<T> at_;
};

#ifdef __AVX__
/// In double, the coordinates share one register with a fourth lane that is 0. The same sums in the
/// same order as above.
template <>
class Vec<double> {
  using Bits = std::int64_t __attribute__((vector_size(32)));

 public:
  using Lanes = double __attribute__((vector_size(32)));

  Vec() = default;
  explicit Vec(const Lanes& lanes) noexcept : lanes_(lanes) {}
  Vec(double x, double y, double z) noexcept : lanes_{x, y, z, 0.0} {}
  explicit Vec(const Vec3& v) noexcept : lanes_{v.x(), v.y(), v.z(), 0.0} {}
  explicit Vec(const Vec<DoubleDouble>& v) noexcept
      : Vec(static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())) {}
  /// From four numbers in memory; the last one is ignored.
  static Vec from_four(const double* numbers) noexcept {
    Bits bits;
    std::memcpy(&bits, numbers, sizeof bits);
    return Vec((Lanes)(bits & Bits{-1, -1, -1, 0}));
  }

  [[nodiscard]] double x() const noexcept { return lanes_[0]; }
  [[nodiscard]] double y() const noexcept { return lanes_[1]; }
  [[nodiscard]] double z() const noexcept { return lanes_[2]; }
  [[nodiscard]] const Lanes& lanes() const noexcept { return lanes_; }

  friend Vec operator+(const Vec& a, const Vec& b) noexcept { return Vec(a.lanes_ + b.lanes_); }
  friend Vec operator-(const Vec& a, const Vec& b) noexcept { return Vec(a.lanes_ - b.lanes_); }
  friend Vec operator-(const Vec& a) noexcept { return Vec(-a.lanes_); }
  friend Vec operator*(double s, const Vec& a) noexcept { return Vec(s * a.lanes_); }

  friend double dot(const Vec& a, const Vec& b) noexcept {
    const Lanes m = a.lanes_ * b.lanes_;
    return m[0] + m[1] + m[2];
  }
  friend Vec cross(const Vec& a, const Vec& b) noexcept {
    const Lanes m = a.lanes_ * b.turned() - a.turned() * b.lanes_;
    return Vec(__builtin_shufflevector(m, m, 1, 2, 0, 3));
  }
  friend Vec dots(const Vec& a, const Vec& b, const Vec& c, const Vec& d) noexcept {
    const Lanes p = a.lanes_ * d.lanes_;
    const Lanes q = b.lanes_ * d.lanes_;
    const Lanes r = c.lanes_ * d.lanes_;
    const Lanes xz = __builtin_shufflevector(p, q, 0, 4, 2, 6);
    const Lanes pq = xz + __builtin_shufflevector(p, q, 1, 5, 3, 7);
    const Lanes rr = r + __builtin_shufflevector(r, r, 1, 3, 3, 3);
    // Without the fourth products, which are 0 and would take its sign from a sum of -0.
    return Vec(__builtin_shufflevector(pq, rr, 0, 1, 4, 7) +
               __builtin_shufflevector(xz, r, 2, 3, 6, 7));
  }
  friend double sum(const Vec& a) noexcept { return a.lanes_[0] + a.lanes_[1] + a.lanes_[2]; }
  friend Vec magnitudes(const Vec& a) noexcept {
    return Vec((Lanes)((Bits)a.lanes_ & std::int64_t{0x7FFFFFFFFFFFFFFF}));
  }
  friend Vec product(const Vec& a, const Vec& b) noexcept { return Vec(a.lanes_ * b.lanes_); }
  friend unsigned minus_signs(const Vec& a) noexcept {
    return static_cast<unsigned>(__builtin_ia32_movmskpd256(a.lanes_)) & 7U;
  }
  friend Vec sum_along(const Vec& a, const Vec& b, const Vec& c, const Vec& d) noexcept {
    const Bits minus = (Bits)d.lanes_ & std::numeric_limits<std::int64_t>::min();
    const Bits x = (Bits)a.lanes_ ^ __builtin_shufflevector(minus, minus, 0, 0, 0, 0);
    const Bits y = (Bits)b.lanes_ ^ __builtin_shufflevector(minus, minus, 1, 1, 1, 1);
    const Bits z = (Bits)c.lanes_ ^ __builtin_shufflevector(minus, minus, 2, 2, 2, 2);
    return Vec((Lanes)x + (Lanes)y + (Lanes)z);
  }

 private:
  [[nodiscard]] Lanes turned() const noexcept {
    return __builtin_shufflevector(lanes_, lanes_, 1, 2, 0, 3);
  }

  Lanes lanes_;
};
#endif

/// The same entries.
[[nodiscard]] inline Vec3 to_vec3(const Vec<double>& v) noexcept {
  return {v.x(), v.y(), v.z()};
}
/// Each entry rounded to double.
[[nodiscard]] inline Vec3 to_vec3(const Vec<DoubleDouble>& v) noexcept {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

/// From four consecutive numbers; the last one is ignored.
template <class T>
[[nodiscard]] Vec<T> from_four(const double* c) noexcept {
  return {T(c[0]), T(c[1]), T(c[2])};
}
#ifdef __AVX__
template <>
[[nodiscard]] inline Vec<double> from_four(const double* c) noexcept {
  return Vec<double>::from_four(c);
}
#endif

/// Column `k` of the matrix of `X`: 0 to 2 the rotation, 3 the translation [m].
template <class T>
[[nodiscard]] Vec<T> column(const Pose& X, int k) noexcept {
  return from_four<T>(X.data() + std::ptrdiff_t{4} * k);
}

/// Sets column `k` of the matrix of `X` to `v`. Written with one store, because it may be read next
/// with one load.
inline void set_column(Pose& X, int k, const Vec<double>& v) noexcept {
  double* c = X.data() + std::ptrdiff_t{4} * k;
  const double last = k == 3 ? 1.0 : 0.0;
#ifdef __AVX__
  // Not by a sum, which would take its sign from a -0.
  const Vec<double>::Lanes four =
      __builtin_shufflevector(v.lanes(), Vec<double>::Lanes{last}, 0, 1, 2, 4);
#else
  const double four[4] = {v.x(), v.y(), v.z(), last};
#endif
  std::memcpy(c, &four, sizeof four);
}

/// The rotation of `X` applied to `v`, in the precision of T.
template <class T>
[[nodiscard]] Vec<T> rotate(const Pose& X, const Vec<T>& v) noexcept {
  return v.x() * column<T>(X, 0) + v.y() * column<T>(X, 1) + v.z() * column<T>(X, 2);
}
/// The transpose of the rotation applied to `v`: transforms a direction into the body frame without
/// assuming that the nine entries are exactly orthonormal.
template <class T>
[[nodiscard]] Vec<T> rotate_transposed(const Pose& X, const Vec<T>& v) noexcept {
  return dots(column<T>(X, 0), column<T>(X, 1), column<T>(X, 2), v);
}

}  // namespace repel
