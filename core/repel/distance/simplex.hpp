// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The simplex of GJK and the projection of the origin onto it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include <repel/base/vec.hpp>

namespace repel::detail {

/// A point of the Minkowski difference A - B with the point of A and the names of both points it
/// came from.
template <class T>
struct DifferencePoint {
  Vec<T> w;                  ///< [m] a - b
  Vec<T> a;                  ///< [m] point of A, from the origin of A, world axes
  T ww{};                    ///< [m^2] w.w
  std::uint32_t name_a = 0;  ///< Convex::Point::name
  std::uint32_t name_b = 0;
};

enum class Projection : std::uint8_t {
  nearer,     ///< the simplex now is the feature nearest to the origin
  encloses,   ///< the origin is inside all four faces by more than the margin
  no_nearer,  ///< no feature is nearer than before: the simplex is unchanged
};

/// Up to four difference points and the point v of their convex hull nearest to the origin.
///
/// The projection takes the minimum over all features that could contain v instead of testing
/// Voronoi regions: for needles and near-parallel faces, rounding makes the region tests contradict
/// each other, but not the minimum. The projection on a face starts from its nearest vertex along
/// the normal. On an edge it starts from the nearer end, orthogonalized twice to the edge. So
/// the error of v scales with the short vectors and not with the long ones.
template <class T>
class Simplex {
 public:
  [[nodiscard]] int size() const noexcept { return size_; }
  [[nodiscard]] const DifferencePoint<T>& point(int i) const noexcept { return points_[i]; }
  [[nodiscard]] T weight(int i) const noexcept { return weights_[i]; }
  [[nodiscard]] const Vec<T>& v() const noexcept { return v_; }  ///< [m]
  [[nodiscard]] T vv() const noexcept { return vv_; }            ///< [m^2]

  [[nodiscard]] bool holds(std::uint32_t name_a, std::uint32_t name_b) const noexcept {
    for (int i = 0; i < size_; ++i) {
      if (points_[i].name_a == name_a && points_[i].name_b == name_b) return true;
    }
    return false;
  }

  /// Resets the simplex to one point.
  void restart(const DifferencePoint<T>& p) noexcept {
    points_[0] = p;
    size_ = 1;
    weights_[0] = T(1.0);
    v_ = p.w;
    vv_ = p.ww;
  }

  /// Adds a point without projecting, for a warm start. At most four points.
  void append(const DifferencePoint<T>& p) noexcept { points_[size_++] = p; }

  /// Projects the origin onto the convex hull of all points. `margin` [m].
  Projection project_all(T margin) noexcept {
    vv_ = T(std::numeric_limits<double>::infinity());
    return project(-1, margin);
  }

  /// Adds `p` (at most four points in total) and moves to the nearest feature containing `p`: only
  /// these can be nearer than the present v. If none is nearer, or if the four points enclose the
  /// origin, the simplex is unchanged.
  Projection add(const DifferencePoint<T>& p, T margin) noexcept {
    if (size_ == 4) return Projection::no_nearer;
    points_[size_++] = p;
    const Projection result = project(size_ - 1, margin);
    if (result != Projection::nearer) --size_;
    return result;
  }

 private:
  struct Feature {
    T vv{};
    Vec<T> v;
    int size = 0;
    std::array<int, 3> index{};
    std::array<T, 3> weight{};
  };

  Projection project(int newest, T margin) noexcept {
    Feature best;
    best.vv = vv_;
    unsigned tried = 0;
    if (size_ == 4) {
      if (project_tetrahedron(newest, margin, tried, best)) return Projection::encloses;
    } else if (size_ == 3) {
      project_triangle({0, 1, 2}, newest, tried, best);
    } else if (size_ == 2) {
      project_edge(0, 1, newest, best);
    } else {
      consider_vertex(0, best);
    }
    if (best.size == 0) return Projection::no_nearer;
    keep(best);
    return Projection::nearer;
  }

  void keep(const Feature& f) noexcept {
    const std::array<DifferencePoint<T>, 3> kept{points_[f.index[0]], points_[f.index[1]],
                                                 points_[f.index[2]]};
    for (int i = 0; i < 3; ++i) {
      points_[i] = kept[i];
      weights_[i] = f.weight[i];
    }
    size_ = f.size;
    v_ = f.v;
    vv_ = f.vv;
  }

  void consider_vertex(int i, Feature& best) const noexcept {
    const DifferencePoint<T>& p = points_[i];
    if (p.ww < best.vv) best = {p.ww, p.w, 1, {i, i, i}, {T(1.0), T(0.0), T(0.0)}};
  }

  // v = p + t e, e = q - p, t = -p.e / e.e, evaluated from the end nearer to the origin.
  void project_edge(int i, int j, int newest, Feature& best) const noexcept {
    if (points_[j].ww < points_[i].ww) std::swap(i, j);
    const Vec<T>& p = points_[i].w;
    const Vec<T> e = points_[j].w - p;
    const T ee = dot(e, e);
    const T along = -dot(p, e);
    const T zero(0.0);
    if (along > zero && along < ee) {
      const T scale = T(1.0) / ee;
      const T t = scale * along;
      const Vec<T> slanted = p + t * e;
      const Vec<T> v = slanted - (scale * dot(slanted, e)) * e;
      const T vv = dot(v, v);
      if (vv < best.vv) best = {vv, v, 2, {i, j, i}, {T(1.0) - t, t, zero}};
      return;
    }
    if (newest < 0 || newest == i) consider_vertex(i, best);
    if (newest < 0 || newest == j) consider_vertex(j, best);
  }

  // v = n (n.p) / n.n, n the normal, p the nearest vertex; the weights are the areas of the three
  // triangles of v and the sides. `tried` is the set of edges already projected on, as bits.
  void project_triangle(std::array<int, 3> f, int newest, unsigned& tried,
                        Feature& best) const noexcept {
    const Vec<T>& p = points_[f[0]].w;
    const Vec<T>& q = points_[f[1]].w;
    const Vec<T>& r = points_[f[2]].w;
    const Vec<T> n = cross(q - p, r - p);
    const T nn = dot(n, n);
    const T zero(0.0);
    if (nn > zero) {
      int nearest = points_[f[1]].ww < points_[f[0]].ww ? f[1] : f[0];
      if (points_[f[2]].ww < points_[nearest].ww) nearest = f[2];
      const Vec<T> v = (dot(n, points_[nearest].w) / nn) * n;
      const Vec<T> vp = p - v;
      const Vec<T> vq = q - v;
      const Vec<T> vr = r - v;
      const Vec<T> areas = dots(cross(vq, vr), cross(vr, vp), cross(vp, vq), n);
      if (areas.x() > zero && areas.y() > zero && areas.z() > zero) {
        const T vv = dot(v, v);
        const T scale = T(1.0) / sum(areas);
        if (vv < best.vv) {
          best = {vv, v, 3, f, {scale * areas.x(), scale * areas.y(), scale * areas.z()}};
        }
        return;
      }
    }
    for (const auto& [i, j] : {std::pair{f[0], f[1]}, {f[1], f[2]}, {f[2], f[0]}}) {
      const unsigned edge = 1U << static_cast<unsigned>(i < j ? 4 * i + j : 4 * j + i);
      if ((tried & edge) != 0U || (newest >= 0 && newest != i && newest != j)) continue;
      tried |= edge;
      project_edge(i, j, newest, best);
    }
  }

  // True when the origin is certainly inside; otherwise the faces it is not certainly inside of are
  // projected on. With n the normal of a face and e1, e2 its edges, the volume n.p is known only to
  // within margin (|n| + (|e1| + |e2|) |p|): every difference point may be off by the margin. For a
  // thin face, or one whose opposite vertex is too close to its plane, the inner side is undefined.
  bool project_tetrahedron(int newest, T margin, unsigned& tried, Feature& best) const noexcept {
    constexpr std::array<std::array<int, 4>, 4> faces{
        {{0, 1, 3, 2}, {1, 2, 3, 0}, {2, 0, 3, 1}, {0, 1, 2, 3}}};
    bool inside = true;
    const T zero(0.0);
    const T unsure = T(4.0) * margin * margin;
    for (const auto& [i, j, k, opposite] : faces) {
      const Vec<T>& p = points_[i].w;
      const Vec<T> e1 = points_[j].w - p;
      const Vec<T> e2 = points_[k].w - p;
      const Vec<T> to_opposite = points_[opposite].w - p;
      const Vec<T> n = cross(e1, e2);
      const T nn = dot(n, n);
      const T edges = dot(e1, e1) + dot(e2, e2);
      const T height = dot(n, to_opposite);
      const T depth = height > zero ? -dot(n, p) : dot(n, p);
      const bool inner = depth > zero && depth * depth > unsure * (nn + edges * points_[i].ww) &&
                         height * height > unsure * (nn + edges * dot(to_opposite, to_opposite));
      if (inner) continue;
      inside = false;
      if (newest < 0 || newest == i || newest == j || newest == k) {
        project_triangle({i, j, k}, newest, tried, best);
      }
    }
    return inside;
  }

  std::array<DifferencePoint<T>, 4> points_;
  std::array<T, 4> weights_{};
  int size_ = 0;
  Vec<T> v_;
  T vv_{};
};

}  // namespace repel::detail
