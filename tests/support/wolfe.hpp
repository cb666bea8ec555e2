// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The point of a convex set nearest to the origin by Wolfe's algorithm (1976) in 113-bit
/// arithmetic: from support points alone, with a self-certifying bracket.
#pragma once

#include <cstddef>
#include <vector>

#include <support/quad.hpp>

namespace repel::oracle {

/// A distance between proven bounds; both are 0 if the set contains the origin.
struct Bracket {
  Real lower = 0;   ///< [m]
  Real upper = 0;   ///< [m] length of a point of the set
  Point nearest{};  ///< [m] that point
};

/// Weights of the point nearest to the origin on the affine hull of the corral: w0 + E t with E =
/// QR and R t = -Q'w0, E the differences to the first point. Gram-Schmidt with reorthogonalization,
/// since normal equations would square the condition number. False if the corral is degenerate.
inline bool affine_weights(const std::vector<Point>& corral, std::vector<Real>& weights) {
  const std::size_t n = corral.size() - 1;
  Point q[3];
  Real r[3][4] = {};  // the last column is the right-hand side
  for (std::size_t j = 0; j < n; ++j) {
    q[j] = corral[j + 1] - corral[0];
    const Real length = square_root(dot(q[j], q[j]));
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t i = 0; i < j; ++i) {
        const Real along = dot(q[i], q[j]);
        r[i][j] += along;
        q[j] = q[j] - along * q[i];
      }
    }
    r[j][j] = square_root(dot(q[j], q[j]));
    if (r[j][j] <= Real(1e-28) * length) return false;
    q[j] = (1 / r[j][j]) * q[j];
    r[j][3] = -dot(q[j], corral[0]);
  }
  weights.assign(n + 1, 1);
  for (std::size_t i = n; i-- > 0;) {
    weights[i + 1] = r[i][3];
    for (std::size_t j = i + 1; j < n; ++j) weights[i + 1] -= r[i][j] * weights[j + 1];
    weights[i + 1] /= r[i][i];
    weights[0] -= weights[i + 1];
  }
  return true;
}

/// Points and weights of the corral, moved to the nearest point of its hull; false if no progress
/// is possible.
inline bool move_to_nearest(std::vector<Point>& corral, std::vector<Real>& weights) {
  std::vector<Real> target;
  for (int minor = 0; minor < 20; ++minor) {
    if (corral.size() > 4 || !affine_weights(corral, target)) return false;
    Real theta = 1;
    for (std::size_t i = 0; i < corral.size(); ++i) {
      if (target[i] <= 0 && weights[i] - target[i] > 0) {
        const Real t = weights[i] / (weights[i] - target[i]);
        theta = t < theta ? t : theta;
      }
    }
    std::vector<Point> kept;
    std::vector<Real> kept_weights;
    for (std::size_t i = 0; i < corral.size(); ++i) {
      const Real w = (1 - theta) * weights[i] + theta * target[i];
      if (theta < 1 && target[i] <= 0 && w <= Real(1e-32)) continue;
      kept.push_back(corral[i]);
      kept_weights.push_back(w);
    }
    const bool dropped = kept.size() < corral.size();
    corral = kept;
    weights = kept_weights;
    if (theta >= 1 || !dropped) break;
  }
  return true;
}

/// `support(x)` is the point of the set with the least dot product with x. Stops when the duality
/// gap is relatively below `tolerance`, or below 1e-32 of `size` [m] squared, or at the limit of
/// 113-bit precision.
template <class Support>
Bracket minimum_norm(Support&& support, const Point& start, Real size, Real tolerance = 1e-24) {
  std::vector<Point> corral{start};
  std::vector<Real> weights{1};
  Bracket best{0, square_root(dot(start, start)), start};
  Point x = start;
  for (int major = 0; major < 500; ++major) {
    const Real xx = dot(x, x);
    if (xx <= size * size * Real(1e-54)) return {};
    const Point w = support(x);
    const Real length = square_root(xx);
    const Real gap = xx - dot(x, w);
    if (length <= best.upper) {
      best.upper = length;
      best.nearest = x;
    }
    const Real below = length - gap / length;
    best.lower = below > best.lower ? below : best.lower;
    if (gap <= xx * tolerance || gap <= size * size * Real(1e-32)) break;
    corral.push_back(w);
    weights.push_back(0);
    if (!move_to_nearest(corral, weights)) break;
    x = {};
    for (std::size_t i = 0; i < corral.size(); ++i) x = x + weights[i] * corral[i];
  }
  return best;
}

}  // namespace repel::oracle
