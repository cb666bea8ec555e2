// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The exact distance of two small polytopes, by algorithms that share no code and no method with
/// the one under test: all pairs of features are ranked in double and the best are recomputed with
/// 113 bits. An answer is accepted only if its duality gap, with 113 bits, proves it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include <support/nearest.hpp>
#include <support/placed.hpp>
#include <support/polytope.hpp>
#include <support/wolfe.hpp>

namespace repel::oracle {

struct Truth {
  Real distance = 0;             ///< [m] 0 if the polytopes intersect
  double normal[3] = {0, 0, 0};  ///< unit, from B to A
};

inline Truth truth_at(const Point& v, Real size) {
  const Real length = square_root(dot(v, v));
  if (length <= size * Real(1e-27)) return {};
  const Rough n = rough((1 / length) * v);
  return {length, {n.x[0], n.x[1], n.x[2]}};
}

/// By Wolfe's minimum-norm point over all differences of vertices. Nothing if 113-bit arithmetic
/// could not prove it, which a test must treat as its own failure.
inline std::optional<Truth> distance_by_wolfe(PlacedPair& pair) {
  const Point start = pair.support(pair.A.exact(0) - pair.B.exact(0));
  const Real size = pair.size();
  const Bracket found = minimum_norm([&](const Point& x) { return pair.support(x); }, start, size);
  const Real unsure = found.upper - found.lower;
  const bool proven =
      unsure <= found.upper * Real(1e-23) || found.upper * unsure <= size * size * Real(1e-31);
  return proven ? std::optional(truth_at(found.nearest, size)) : std::nullopt;
}

/// Pairs of features of two posed polytopes: a vertex and a triangle of a face, or two edges.
class Features {
 public:
  Features(const Polytope& A, const Pose& X_WA, const Polytope& B, const Pose& X_WB)
      : A_(A),
        B_(B),
        pair_(A.vertices(), X_WA, B.vertices(), X_WB),
        R_WA_(X_WA.linear()),
        R_WB_(X_WB.linear()) {}

  /// The exact distance of disjoint polytopes; nothing if no pair of features is proven nearest.
  std::optional<Truth> nearest_of_best() {
    rank();
    const std::size_t tried = std::min<std::size_t>(candidates_.size(), 12);
    for (std::size_t i = 0; i < tried; ++i) {
      const Point v = nearest(candidates_[i]);
      if (proven(v)) return truth_at(v, pair_.size());
    }
    return std::nullopt;
  }

  [[nodiscard]] PlacedPair& pair() { return pair_; }

 private:
  struct Candidate {
    double vv = 0.0;          ///< [m^2]
    int a[3] = {-1, -1, -1};  ///< vertices of A: one, two or three
    int b[3] = {-1, -1, -1};
  };

  /// The difference of two vertices.
  Point exact(int a, int b) { return pair_.A.exact(a) - pair_.B.exact(b); }
  Rough rough(int a, int b) { return pair_.A.rough(a) - pair_.B.rough(b); }

  void offer(const Candidate& c) {
    if (c.vv > limit_) return;
    const double rounding = 1e-14 * pair_.size();
    const double length = std::sqrt(c.vv) + rounding;
    limit_ = std::min(limit_, length * length);
    candidates_.push_back(c);
  }

  /// All pairs of features that can be nearest within double precision, the best first. Parallel
  /// features and those that share a vertex tie; any of them gives the same point.
  void rank() {
    vertices_and_faces(B_, R_WB_, pair_.B, pair_.A, false);
    vertices_and_faces(A_, R_WA_, pair_.A, pair_.B, true);
    edges_and_edges();
    vertices_and_edges(A_, B_, false);
    vertices_and_edges(B_, A_, true);
    std::stable_sort(candidates_.begin(), candidates_.end(),
                     [](const Candidate& x, const Candidate& y) { return x.vv < y.vv; });
  }

  void vertices_and_faces(const Polytope& faced, const Mat3& R, const Placed& placed,
                          const Placed& points, bool faces_of_a) {
    for (const Face& face : faced.faces()) {
      const Rough n = oracle::rough(Vec3(R * face.n));
      const double offset = dot(n, placed.rough(face.corners[0]));
      for (int i = 0; i < points.count(); ++i) {
        const double height = dot(n, points.rough(i)) - offset;
        const double doubt = 1e-12 * pair_.size();
        if (height < -doubt || (height > doubt && height * height > limit_ + doubt)) continue;
        for (std::size_t k = 2; k < face.corners.size(); ++k) {
          offer(vertex_and_triangle(i, face, k, faces_of_a));
        }
      }
    }
  }

  Candidate vertex_and_triangle(int i, const Face& face, std::size_t k, bool faces_of_a) {
    Candidate c;
    int* const one = faces_of_a ? c.b : c.a;
    int* const three = faces_of_a ? c.a : c.b;
    one[0] = i;
    three[0] = face.corners[0];
    three[1] = face.corners[k - 1];
    three[2] = face.corners[k];
    const Rough v = faces_of_a
                        ? nearest_on_triangle(rough(c.a[0], i), rough(c.a[1], i), rough(c.a[2], i))
                        : nearest_on_triangle(rough(i, c.b[0]), rough(i, c.b[1]), rough(i, c.b[2]));
    c.vv = dot(v, v);
    return c;
  }

  void edges_and_edges() {
    for (const auto& a : A_.edges()) {
      const Rough e = pair_.A.rough(a[1]) - pair_.A.rough(a[0]);
      for (const auto& b : B_.edges()) {
        const Rough f = pair_.B.rough(b[0]) - pair_.B.rough(b[1]);
        const Rough p = rough(a[0], b[0]);
        const Rough n = cross(e, f);
        const double across = dot(n, p);
        if (across * across > limit_ * 1.000001 * dot(n, n)) continue;
        const Rough v = nearest_inside_parallelogram(p, e, f);
        offer({dot(v, v), {a[0], a[1], -1}, {b[0], b[1], -1}});
      }
    }
  }

  /// Needed if one of the two has no face: a segment or a point.
  void vertices_and_edges(const Polytope& pointed, const Polytope& edged, bool edges_of_a) {
    if (!edged.faces().empty()) return;
    for (int i = 0; i < static_cast<int>(pointed.vertices().size()); ++i) {
      for (const auto& e : edged.edges()) {
        Candidate c;
        (edges_of_a ? c.b : c.a)[0] = i;
        std::copy(e.begin(), e.end(), edges_of_a ? c.a : c.b);
        const Rough v = edges_of_a ? nearest_on_segment(rough(e[0], i), rough(e[1], i))
                                   : nearest_on_segment(rough(i, e[0]), rough(i, e[1]));
        c.vv = dot(v, v);
        offer(c);
      }
      if (edged.edges().empty()) {
        const Rough v = edges_of_a ? rough(0, i) : rough(i, 0);
        offer(edges_of_a ? Candidate{dot(v, v), {0, -1, -1}, {i, -1, -1}}
                         : Candidate{dot(v, v), {i, -1, -1}, {0, -1, -1}});
      }
    }
  }

  Point nearest(const Candidate& c) {
    const Point p = exact(c.a[0], c.b[0]);
    if (c.a[2] >= 0) return nearest_on_triangle(p, exact(c.a[1], c.b[0]), exact(c.a[2], c.b[0]));
    if (c.b[2] >= 0) return nearest_on_triangle(p, exact(c.a[0], c.b[1]), exact(c.a[0], c.b[2]));
    if (c.a[1] >= 0 && c.b[1] >= 0) {
      return nearest_inside_parallelogram(p, exact(c.a[1], c.b[0]) - p, exact(c.a[0], c.b[1]) - p);
    }
    if (c.a[1] >= 0) return nearest_on_segment(p, exact(c.a[1], c.b[0]));
    if (c.b[1] >= 0) return nearest_on_segment(p, exact(c.a[0], c.b[1]));
    return p;
  }

  /// The duality gap: v is a point of A - B, and no other point is farther along -v.
  bool proven(const Point& v) {
    const Real vv = dot(v, v);
    const Real gap = vv - (pair_.A.least(v) - pair_.B.most(v));
    const Real size = pair_.size();
    // The error of the distance is at most gap / |v|.
    return gap <= size * size * Real(1e-33) || gap * gap <= vv * size * size * Real(1e-48);
  }

  const Polytope& A_;
  const Polytope& B_;
  PlacedPair pair_;
  Mat3 R_WA_, R_WB_;
  double limit_ = 1e300;  ///< [m^2] candidates beyond are not the nearest
  std::vector<Candidate> candidates_;
};

/// The distance of two polytopes; nothing if 113-bit arithmetic could not prove it, which a test
/// must treat as its own failure.
inline std::optional<Truth> distance(const Polytope& A, const Pose& X_WA, const Polytope& B,
                                     const Pose& X_WB) {
  Features features(A, X_WA, B, X_WB);
  const bool small = std::max(A.vertices().size(), B.vertices().size()) <= Polytope::most;
  const auto found = small ? features.nearest_of_best() : std::nullopt;
  return found ? found : distance_by_wolfe(features.pair());
}

/// The distance of the hulls of `a` under X_WA and `b` under X_WB.
inline std::optional<Truth> distance(const std::vector<Vec3>& a, const Pose& X_WA,
                                     const std::vector<Vec3>& b, const Pose& X_WB) {
  return distance(Polytope(a), X_WA, Polytope(b), X_WB);
}

}  // namespace repel::oracle
