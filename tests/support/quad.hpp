// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// 113-bit arithmetic for reference values of tests.
#pragma once

#include <cfloat>
#include <cmath>

#include <repel/base/types.hpp>

namespace repel::oracle {

#if LDBL_MANT_DIG == 113
using Real = long double;
#else
__extension__ typedef __float128 Real;
#endif

inline Real magnitude(Real x) {
  return x < 0 ? -x : x;
}

/// To 113 bits, by Newton's iteration from the root in double; 0 below 1e-300.
inline Real square_root(Real x) {
  if (!(x > Real(1e-300))) return 0;
  Real root = std::sqrt(static_cast<double>(x));
  for (int i = 0; i < 3; ++i) root = (root + x / root) / 2;
  return root;
}

/// A 3-vector in double or with 113 bits.
template <class T>
struct Triple {
  T x[3];

  friend Triple operator+(const Triple& a, const Triple& b) {
    return {{a.x[0] + b.x[0], a.x[1] + b.x[1], a.x[2] + b.x[2]}};
  }
  friend Triple operator-(const Triple& a, const Triple& b) {
    return {{a.x[0] - b.x[0], a.x[1] - b.x[1], a.x[2] - b.x[2]}};
  }
  friend Triple operator*(T s, const Triple& a) { return {{s * a.x[0], s * a.x[1], s * a.x[2]}}; }
};

using Point = Triple<Real>;
using Rough = Triple<double>;

template <class T>
T dot(const Triple<T>& a, const Triple<T>& b) {
  return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2];
}

template <class T>
Triple<T> cross(const Triple<T>& a, const Triple<T>& b) {
  return {{a.x[1] * b.x[2] - a.x[2] * b.x[1], a.x[2] * b.x[0] - a.x[0] * b.x[2],
           a.x[0] * b.x[1] - a.x[1] * b.x[0]}};
}

inline Rough rough(const Point& p) {
  return {{static_cast<double>(p.x[0]), static_cast<double>(p.x[1]), static_cast<double>(p.x[2])}};
}
inline Rough rough(const Vec3& p) {
  return {{p.x(), p.y(), p.z()}};
}
inline Point exact(const Vec3& p) {
  return {{p.x(), p.y(), p.z()}};
}

/// R v: the exact value for the doubles of `X`.
inline Point rotated(const Pose& X, const Point& v) {
  Point p{};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) p.x[i] += Real(X.linear()(i, k)) * v.x[k];
  }
  return p;
}

/// R'v: a direction transformed to the frame of the body.
inline Point rotated_back(const Pose& X, const Point& v) {
  Point p{};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) p.x[i] += Real(X.linear()(k, i)) * v.x[k];
  }
  return p;
}

/// Vertex of the polytope in the world: the exact value of R v + p for the doubles given.
inline Point placed(const Pose& X, const Vec3& v) {
  return rotated(X, exact(v)) + exact(X.translation());
}

}  // namespace repel::oracle
