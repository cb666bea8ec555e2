/// @file
/// The exact distance of two small polytopes, by an algorithm that shares no code and no idea with
/// the one under test: Wolfe's minimum-norm point (1976) in 113-bit arithmetic, over all
/// differences of vertices, accepted only when its duality gap proves it.
#pragma once

#include <cfloat>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

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

struct Point {
  Real x[3];
};

inline Real dot(const Point& a, const Point& b) {
  return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2];
}

/// Vertex of the polytope in the world: the exact value of R v + p for the doubles given.
inline Point placed(const Pose& X, const Vec3& v) {
  Point p{};
  for (int i = 0; i < 3; ++i) {
    p.x[i] = X.translation()[i];
    for (int k = 0; k < 3; ++k) p.x[i] += Real(X.linear()(i, k)) * Real(v[k]);
  }
  return p;
}

struct Truth {
  Real distance = 0;             ///< [m] 0 when the polytopes meet
  double normal[3] = {0, 0, 0};  ///< unit, from B to A
};

/// Weights of the point nearest to the origin on the affine hull of the corral: w0 + E t with
/// E = QR and R t = -Q'w0, E the differences to the first point. Gram and Schmidt, each step twice:
/// normal equations would square the smallness of an angle. False when the corral is degenerate.
inline bool affine_weights(const std::vector<Point>& corral, std::vector<Real>& weights) {
  const std::size_t n = corral.size() - 1;
  Point q[3];
  Real r[3][4] = {};  // the last column is the right-hand side
  for (std::size_t j = 0; j < n; ++j) {
    for (int k = 0; k < 3; ++k) q[j].x[k] = corral[j + 1].x[k] - corral[0].x[k];
    const Real length = square_root(dot(q[j], q[j]));
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t i = 0; i < j; ++i) {
        const Real along = dot(q[i], q[j]);
        r[i][j] += along;
        for (int k = 0; k < 3; ++k) q[j].x[k] -= along * q[i].x[k];
      }
    }
    r[j][j] = square_root(dot(q[j], q[j]));
    if (r[j][j] <= Real(1e-28) * length) return false;
    for (int k = 0; k < 3; ++k) q[j].x[k] /= r[j][j];
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

/// The distance of the hulls of `a` under X_WA and `b` under X_WB; nothing when 113 bits could not
/// prove it, which a test must treat as its own failure.
inline std::optional<Truth> distance(const std::vector<Vec3>& a, const Pose& X_WA,
                                     const std::vector<Vec3>& b, const Pose& X_WB) {
  std::vector<Point> differences;
  for (const Vec3& va : a) {
    const Point pa = placed(X_WA, va);
    for (const Vec3& vb : b) {
      const Point pb = placed(X_WB, vb);
      differences.push_back({{pa.x[0] - pb.x[0], pa.x[1] - pb.x[1], pa.x[2] - pb.x[2]}});
    }
  }
  Real size2 = 0;
  std::size_t start = 0;
  for (std::size_t i = 0; i < differences.size(); ++i) {
    const Real d = dot(differences[i], differences[i]);
    size2 = d > size2 ? d : size2;
    if (d < dot(differences[start], differences[start])) start = i;
  }
  std::vector<Point> corral{differences[start]};
  std::vector<Real> weights{1};
  std::vector<Real> target;
  Point x = corral[0];
  for (int major = 0; major < 500; ++major) {
    const Real xx = dot(x, x);
    std::size_t best = 0;
    for (std::size_t i = 1; i < differences.size(); ++i) {
      if (dot(x, differences[i]) < dot(x, differences[best])) best = i;
    }
    const Real gap = xx - dot(x, differences[best]);
    const Real length = square_root(xx);
    if (xx <= size2 * Real(1e-54)) return Truth{};
    if (gap <= xx * Real(1e-24) || gap <= size2 * Real(1e-32)) {
      return Truth{length,
                   {double(x.x[0] / length), double(x.x[1] / length), double(x.x[2] / length)}};
    }
    corral.push_back(differences[best]);
    weights.push_back(0);
    for (int minor = 0; minor < 20; ++minor) {
      if (corral.size() > 4 || !affine_weights(corral, target)) return std::nullopt;
      Real theta = 1;
      for (std::size_t i = 0; i < corral.size(); ++i) {
        if (target[i] <= 0 && weights[i] - target[i] > 0) {
          const Real t = weights[i] / (weights[i] - target[i]);
          theta = t < theta ? t : theta;
        }
      }
      std::vector<Point> kept;
      std::vector<Real> kept_weights;
      bool dropped = false;
      for (std::size_t i = 0; i < corral.size(); ++i) {
        const Real w = (1 - theta) * weights[i] + theta * target[i];
        if (theta < 1 && target[i] <= 0 && w <= Real(1e-32)) {
          dropped = true;
          continue;
        }
        kept.push_back(corral[i]);
        kept_weights.push_back(w);
      }
      corral = kept;
      weights = kept_weights;
      if (theta >= 1 || !dropped) break;
    }
    x = {};
    for (std::size_t i = 0; i < corral.size(); ++i) {
      for (int k = 0; k < 3; ++k) x.x[k] += weights[i] * corral[i].x[k];
    }
  }
  return std::nullopt;
}

}  // namespace repel::oracle
