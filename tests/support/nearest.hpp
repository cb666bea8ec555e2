// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The point nearest to the origin on a segment, a triangle and a parallelogram, in double or with
/// 113 bits. The result is always a convex combination of the corners, regardless of rounding.
#pragma once

#include <support/quad.hpp>

namespace repel::oracle {

template <class T>
T clamped(T t) {
  return t < T(0) ? T(0) : (t > T(1) ? T(1) : t);
}

template <class T>
const Triple<T>& nearer(const Triple<T>& a, const Triple<T>& b) {
  return dot(b, b) < dot(a, a) ? b : a;
}

template <class T>
Triple<T> nearest_on_segment(const Triple<T>& p, const Triple<T>& q) {
  const Triple<T> e = q - p;
  const T ee = dot(e, e);
  return ee > T(0) ? p + clamped(T(-dot(p, e) / ee)) * e : p;
}

template <class T>
Triple<T> nearest_on_triangle(const Triple<T>& p, const Triple<T>& q, const Triple<T>& r) {
  const Triple<T> n = cross(q - p, r - p);
  const T in_p = dot(n, cross(q, r));
  const T in_q = dot(n, cross(r, p));
  const T in_r = dot(n, cross(p, q));
  if (in_p > T(0) && in_q > T(0) && in_r > T(0)) {
    const T share = T(1) / (in_p + in_q + in_r);
    return p + (share * in_q) * (q - p) + (share * in_r) * (r - p);
  }
  return nearer(nearest_on_segment(p, q),
                nearer(nearest_on_segment(q, r), nearest_on_segment(r, p)));
}

/// On p + s e + t f, s and t from 0 to 1, if the nearest point is inside; otherwise some point of
/// it.
template <class T>
Triple<T> nearest_inside_parallelogram(const Triple<T>& p, const Triple<T>& e, const Triple<T>& f) {
  const Triple<T> n = cross(e, f);
  const T nn = dot(n, n);
  if (!(nn > T(0))) return p;
  const T s = dot(cross(f, p), n) / nn;
  const T t = dot(cross(p, e), n) / nn;
  return p + clamped(s) * e + clamped(t) * f;
}

}  // namespace repel::oracle
