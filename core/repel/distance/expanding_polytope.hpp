/// @file
/// The penetration depth of two polytopes by the expanding polytope algorithm (EPA, van den Bergen
/// 2001): the point nearest to the origin on the boundary of their Minkowski difference.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <repel/distance/depth.hpp>
#include <repel/distance/feature.hpp>

namespace repel::detail {

/// A polytope inside A - B that contains the origin is expanded toward the boundary where it is
/// nearest: the support point along the normal of the nearest face is added, until it lies on that
/// face. The nearest face is a lower bound of the depth, the support value along any normal an
/// upper bound.
class ExpandingPolytope {
 public:
  static constexpr int cap = 120;  ///< limit of support-map pairs

  explicit ExpandingPolytope(const PosedPair& pair) noexcept : pair_(pair) {}

  /// @param warm names of four corners that enclose the origin; with fewer, the support points of
  /// four fixed directions are used
  [[nodiscard, gnu::noinline]] Depth run(const WarmStart& warm) noexcept {
    Depth depth;
    const double margin = pair_.margin();
    if (!begin(warm, margin)) return depth;
    while (depth.iterations < cap) {
      const std::size_t nearest = nearest_face();
      const Face& face = faces_[nearest];
      depth.value = std::max(0.0, face.offset);
      depth.lower = std::max(0.0, face.offset - margin);
      const Corner w = support(face.n);
      ++depth.iterations;
      const double reached = dot(face.n, w.w);
      if (reached + margin < depth.upper) {
        depth.upper = reached + margin;
        depth.n_W = face.n;
        depth.p_AQa_W = foot(face);
      }
      depth.closed = reached - face.offset <= margin;
      if (depth.closed || !grow(w, margin)) break;
    }
    return depth;
  }

 private:
  // Euler: with V corners there are 2 V - 4 faces, and each expansion adds as many faces as the rim
  // (horizon) has edges.
  static constexpr std::size_t most_corners = 4 + cap;
  static constexpr std::size_t most_faces = 2 * most_corners;

  struct Corner {
    Vec<double> a;  ///< [m] point of A, from the origin of A, world axes
    Vec<double> w;  ///< [m] a - b
  };
  struct Face {
    Vec<double> n;                        ///< unit, outward
    double offset;                        ///< [m]
    std::array<std::uint8_t, 3> corners;  ///< counter-clockwise seen from outside
  };
  struct Edge {
    std::uint8_t from, to;
  };

  [[nodiscard]] Corner corner(const Vec<double>& a, const Vec<double>& b) const noexcept {
    const Vec<double> turned = rotate(pair_.X_WA, a);
    return {turned, turned - (rotate(pair_.X_WB, b) + pair_.p_AB)};
  }
  /// The support point of A - B along d.
  [[nodiscard]] Corner support(const Vec<double>& d) const noexcept {
    return corner(pair_.A.support(rotate_transposed(pair_.X_WA, d)).p,
                  pair_.B.support(rotate_transposed(pair_.X_WB, -d)).p);
  }

  bool begin(const WarmStart& warm, double margin) noexcept {
    const Vec<double> around[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    for (std::size_t i = 0; i < 4; ++i) {
      corners_[i] = warm.size == 4 ? corner(pair_.A.place(warm.a[i]), pair_.B.place(warm.b[i]))
                                   : support(around[i]);
    }
    corner_count_ = 4;
    face_count_ = 0;
    const Vec<double> e = corners_[1].w - corners_[0].w;
    const double volume =
        dot(cross(e, corners_[2].w - corners_[0].w), corners_[3].w - corners_[0].w);
    static constexpr std::uint8_t outward[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    for (const auto& [i, j, k] : outward) {
      const bool made = volume > 0.0 ? add_face(i, j, k) : add_face(j, i, k);
      if (!made || faces_[face_count_ - 1].offset < -margin) return false;
    }
    return true;
  }

  bool add_face(std::uint8_t i, std::uint8_t j, std::uint8_t k) noexcept {
    if (face_count_ == most_faces) return false;
    const Vec<double>& p = corners_[i].w;
    const Vec<double> n = cross(corners_[j].w - p, corners_[k].w - p);
    const double length = std::sqrt(dot(n, n));
    if (!(length > 0.0)) return false;
    Face& face = faces_[face_count_++];
    face.n = (1.0 / length) * n;
    face.offset =
        std::max({dot(face.n, p), dot(face.n, corners_[j].w), dot(face.n, corners_[k].w)});
    face.corners = {i, j, k};
    return true;
  }

  [[nodiscard]] std::size_t nearest_face() const noexcept {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < face_count_; ++i) {
      if (faces_[i].offset < faces_[nearest].offset) nearest = i;
    }
    return nearest;
  }

  /// Replaces the faces that see the new corner by a cone over their rim. False when, by rounding,
  /// the rim is not a cycle or a face has no area, or when the origin would be outside.
  bool grow(const Corner& w, double margin) noexcept {
    if (corner_count_ == most_corners) return false;
    rim_count_ = 0;
    for (std::size_t i = 0; i < face_count_;) {
      const Face& face = faces_[i];
      if (dot(face.n, w.w) - face.offset <= 0.25 * margin) {
        ++i;
        continue;
      }
      const auto [p, q, r] = face.corners;
      if (!toggle({p, q}) || !toggle({q, r}) || !toggle({r, p})) return false;
      faces_[i] = faces_[--face_count_];
    }
    const auto tip = static_cast<std::uint8_t>(corner_count_);
    corners_[corner_count_++] = w;
    if (!rim_is_a_cycle()) return false;
    for (std::size_t i = 0; i < rim_count_; ++i) {
      const bool made = add_face(rim_[i].from, rim_[i].to, tip);
      if (!made || faces_[face_count_ - 1].offset < -margin) return false;
    }
    return true;
  }

  /// Adds an edge of a removed face to the rim; an edge shared by two removed faces is seen from
  /// both and drops out.
  bool toggle(Edge e) noexcept {
    for (std::size_t i = 0; i < rim_count_; ++i) {
      if (rim_[i].from != e.to || rim_[i].to != e.from) continue;
      rim_[i] = rim_[--rim_count_];
      return true;
    }
    if (rim_count_ == rim_.size()) return false;
    rim_[rim_count_++] = e;
    return true;
  }

  [[nodiscard]] bool rim_is_a_cycle() const noexcept {
    if (rim_count_ < 3) return false;
    std::uint8_t at = rim_[0].to;
    for (std::size_t steps = 1; steps < rim_count_; ++steps) {
      std::size_t next = 1;
      while (next < rim_count_ && rim_[next].from != at) ++next;
      if (next == rim_count_) return false;
      at = rim_[next].to;
      if (at == rim_[0].from) return steps + 1 == rim_count_;
    }
    return false;
  }

  /// The witness point on A: the combination of the corners of the face at the projection of the
  /// origin.
  [[nodiscard]] Vec<double> foot(const Face& face) const noexcept {
    const auto [i, j, k] = face.corners;
    const Vec<double>& p = corners_[i].w;
    const Vec<double>& q = corners_[j].w;
    const Vec<double>& r = corners_[k].w;
    Vec<double> areas = dots(cross(q, r), cross(r, p), cross(p, q), face.n);
    areas = {std::max(areas.x(), 0.0), std::max(areas.y(), 0.0), std::max(areas.z(), 0.0)};
    const double all = sum(areas);
    if (!(all > 0.0)) return corners_[i].a;
    return (1.0 / all) *
           (areas.x() * corners_[i].a + areas.y() * corners_[j].a + areas.z() * corners_[k].a);
  }

  PosedPair pair_;
  std::array<Corner, most_corners> corners_;
  std::size_t corner_count_ = 0;
  std::array<Face, most_faces> faces_;
  std::size_t face_count_ = 0;
  std::array<Edge, 3 * most_faces> rim_;
  std::size_t rim_count_ = 0;
};

}  // namespace repel::detail
