/// @file
/// Three numbers of a chosen precision: the vector type of code that runs both in double and in
/// DoubleDouble.
#pragma once

#include <repel/base/double_double.hpp>
#include <repel/base/types.hpp>

namespace repel {

template <class T>
struct Vec {
  T x{}, y{}, z{};

  Vec() = default;
  Vec(T x_, T y_, T z_) noexcept : x(x_), y(y_), z(z_) {}
  explicit Vec(const Vec3& v) noexcept : x(v.x()), y(v.y()), z(v.z()) {}

  friend Vec operator+(const Vec& a, const Vec& b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend Vec operator-(const Vec& a, const Vec& b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend Vec operator-(const Vec& a) noexcept { return {-a.x, -a.y, -a.z}; }
  friend Vec operator*(T s, const Vec& a) noexcept { return {s * a.x, s * a.y, s * a.z}; }
};

template <class T>
[[nodiscard]] T dot(const Vec<T>& a, const Vec<T>& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
[[nodiscard]] Vec<T> cross(const Vec<T>& a, const Vec<T>& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

[[nodiscard]] inline Vec3 to_vec3(const Vec<double>& v) noexcept {
  return {v.x, v.y, v.z};
}
[[nodiscard]] inline Vec3 to_vec3(const Vec<DoubleDouble>& v) noexcept {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// The rotation of `X` applied to `v` and its transpose applied to `v`: nine products each, in the
/// precision of T. The transpose carries a direction into the body without assuming that the nine
/// numbers are exactly orthonormal.
template <class T>
[[nodiscard]] Vec<T> rotate(const Pose& X, const Vec<T>& v) noexcept {
  const auto& R = X.matrix();
  return {T(R(0, 0)) * v.x + T(R(0, 1)) * v.y + T(R(0, 2)) * v.z,
          T(R(1, 0)) * v.x + T(R(1, 1)) * v.y + T(R(1, 2)) * v.z,
          T(R(2, 0)) * v.x + T(R(2, 1)) * v.y + T(R(2, 2)) * v.z};
}
template <class T>
[[nodiscard]] Vec<T> rotate_transposed(const Pose& X, const Vec<T>& v) noexcept {
  const auto& R = X.matrix();
  return {T(R(0, 0)) * v.x + T(R(1, 0)) * v.y + T(R(2, 0)) * v.z,
          T(R(0, 1)) * v.x + T(R(1, 1)) * v.y + T(R(2, 1)) * v.z,
          T(R(0, 2)) * v.x + T(R(1, 2)) * v.y + T(R(2, 2)) * v.z};
}

}  // namespace repel
