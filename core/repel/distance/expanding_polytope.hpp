// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The penetration depth of two polytopes by the expanding polytope algorithm (EPA, van den Bergen
/// 2001): the point nearest to the origin on the boundary of their Minkowski difference.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <repel/distance/closed_surface.hpp>
#include <repel/distance/depth.hpp>
#include <repel/distance/feature.hpp>
#include <repel/distance/planes_of_faces.hpp>

namespace repel::detail {

/// A polytope inside A - B containing the origin is expanded toward the nearest boundary: the
/// support point along the normal of the nearest face is added, until it lies on that face. The
/// nearest face is a lower bound of the depth, the support value along any normal an upper bound.
class ExpandingPolytope {
 public:
  static constexpr int cap = 120;  ///< limit of support-map pairs

  explicit ExpandingPolytope(const PosedPair& pair) noexcept : pair_(pair) {}

  /// @param warm the polytope of the last result, or names of four corners that enclose the origin;
  /// without either, the support points of four fixed directions are used. Receives the polytope,
  /// if it is small enough
  [[nodiscard, gnu::noinline]] Depth run(WarmStart& warm) noexcept {
    const double margin = pair_.margin();
    Depth depth;
    if (std::size_t nearest = 0; restore(warm, margin, nearest)) {
      expand(margin, nearest, depth);
      // Mostly, nothing had to be added.
      if (depth.closed && corner_count_ == warm.size) return depth;
    }
    if (!depth.closed) {
      const int spent = depth.iterations;
      depth = Depth();
      if (begin(warm, margin)) expand(margin, nearest_face(), depth);
      depth.iterations += spent;
    }
    if (depth.closed) save(warm);
    return depth;
  }

 private:
  // Euler: with V corners there are 2 V - 4 faces, and each expansion adds as many faces as the rim
  // (horizon) has edges.
  static constexpr std::size_t most_corners = 4 + cap;
  static constexpr std::size_t most_faces = 2 * most_corners;

  struct Corner {
    Vec<double> a;         ///< [m] point of A, from the origin of A, world axes
    Vec<double> w;         ///< [m] a - b
    std::uint32_t name_a;  ///< Convex::Point::name
    std::uint32_t name_b;
  };
  struct Face {
    Vec<double> n;  ///< unit, outward
    double offset;  ///< [m]
    Triangle corners;
  };
  struct Edge {
    std::uint8_t from, to;
  };

  /// Adds corners until the nearest face is on the boundary of A - B.
  void expand(double margin, std::size_t nearest, Depth& depth) noexcept {
    while (depth.iterations < cap) {
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
      nearest = nearest_face();
    }
  }

  [[nodiscard]] Corner corner(const Convex::Point<double>& a,
                              const Convex::Point<double>& b) const noexcept {
    const Vec<double> turned = rotate(pair_.X_WA, a.p);
    return {turned, turned - (rotate(pair_.X_WB, b.p) + pair_.p_AB), a.name, b.name};
  }
  /// The support point of A - B along d.
  [[nodiscard]] Corner support(const Vec<double>& d) const noexcept {
    return corner(pair_.A.support(rotate_transposed(pair_.X_WA, d)),
                  pair_.B.support(rotate_transposed(pair_.X_WB, -d)));
  }
  // In place: a copy by the widest registers would wait for the narrower stores.
  void set_named(std::size_t i, std::uint32_t name_a, std::uint32_t name_b) noexcept {
    Corner& corner = corners_[i];
    corner.a = rotate(pair_.X_WA, pair_.A.place(name_a));
    corner.w = corner.a - (rotate(pair_.X_WB, pair_.B.place(name_b)) + pair_.p_AB);
    corner.name_a = name_a;
    corner.name_b = name_b;
  }

  /// The names of corner i of the polytope kept in a warm start.
  template <class Warm>
  [[nodiscard]] static auto& word(Warm& warm, std::size_t i) noexcept {
    const std::array words{&warm.a, &warm.b, &warm.met_a, &warm.met_b};
    return (*words[i / 4])[i % 4];
  }
  /// The polytope of the last result at the poses of now. False when there is none, or when it no
  /// longer encloses the origin. A closed surface with the origin on the inner side of all faces
  /// surrounds it at least once. So it surrounds every point nearer than the nearest face, and that
  /// point is in A - B, even if the surface is not convex.
  [[gnu::flatten]] bool restore(const WarmStart& warm, double margin,
                                std::size_t& nearest) noexcept {
    if (warm.level_a != WarmStart::exact_depth) return false;
    corner_count_ = std::clamp<std::size_t>(warm.size, 4, WarmStart::most_corners);
    face_count_ = 2 * corner_count_ - 4;
    const std::span kept(warm.faces.data(), face_count_);
    if (!read_closed_surface(kept, corner_count_, faces_.data())) return false;
    for (std::size_t i = 0; i < corner_count_; ++i) {
      const std::uint32_t names = word(warm, i);
      set_named(i, names & 0xFFFFU, names >> 16U);
    }
    Lanes least = all_of(std::numeric_limits<double>::infinity());
    Lanes first{};  // the first faces with these offsets, less their lanes
    bool inside = true;
    for (std::size_t f = 0; f < face_count_; f += lane_count) {
      std::array<LaneVec, 3> w;
      for (std::size_t k = 0; k < 3; ++k) {
        w[k] = LaneVec::of([&](int lane) {
          return corners_[faces_[std::min(f + lane, face_count_ - 1)].corners[k]].w;
        });
      }
      const LanePlanes planes = planes_through(w[0], w[1], w[2], margin);
      inside = inside && bits_of(planes.offset > margin) == 15U;
      const auto normals = planes.n.each();
      for (std::size_t lane = 0; lane < lane_count; ++lane) {
        faces_[f + lane].n = normals[lane];
        faces_[f + lane].offset = planes.offset[static_cast<int>(lane)];
      }
      first = either(planes.offset < least, all_of(static_cast<double>(f)), first);
      least = smaller(planes.offset, least);
    }
    nearest = face_count_ - 1;
    for (int k = 0; k < lane_count; ++k) {
      const std::size_t f = static_cast<std::size_t>(first[k]) + k;
      if (least[k] == least_of(least)) nearest = std::min(nearest, f);
    }
    return inside;
  }

  /// Keeps the used corners and the faces, if they are few enough.
  void save(WarmStart& warm) const noexcept {
    WarmStart kept;
    kept.level_a = kept.level_b = WarmStart::exact_depth;
    std::array<std::uint8_t, most_corners> number{};  // from 1; 0 for a corner not in use
    if (face_count_ > kept.faces.size()) return;
    for (std::size_t f = 0; f < face_count_; ++f) {
      Triangle face;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint8_t i = faces_[f].corners[k];
        const auto [p, w, name_a, name_b] = corners_[i];
        if (number[i] == 0) {
          if (kept.size == WarmStart::most_corners || std::max(name_a, name_b) > 0xFFFFU) return;
          word(kept, kept.size) = name_a | name_b << 16U;
          number[i] = ++kept.size;
        }
        face[k] = static_cast<std::uint8_t>(number[i] - 1U);
      }
      kept.faces[f] = packed(face);
    }
    warm = kept;
  }

  bool begin(const WarmStart& warm, double margin) noexcept {
    const Vec<double> around[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    for (std::size_t i = 0; i < 4; ++i) {
      if (warm.size == 4 && warm.level_a == 0) {
        set_named(i, warm.a[i], warm.b[i]);
      } else {
        corners_[i] = support(around[i]);
      }
    }
    corner_count_ = 4;
    face_count_ = 0;
    const Vec<double> e = corners_[1].w - corners_[0].w;
    const double volume =
        dot(cross(e, corners_[2].w - corners_[0].w), corners_[3].w - corners_[0].w);
    static constexpr std::uint8_t outward[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    for (const auto& [i, j, k] : outward) {
      const bool made = volume > 0.0 ? add_face({i, j, k}, margin) : add_face({j, i, k}, margin);
      if (!made || faces_[face_count_ - 1].offset < -margin) return false;
    }
    return true;
  }

  [[nodiscard]] FacePlane plane(const Triangle& at, double margin) const noexcept {
    return plane_through(corners_[at[0]].w, corners_[at[1]].w, corners_[at[2]].w, margin);
  }

  bool add_face(const Triangle& corners, double margin) noexcept {
    if (face_count_ == most_faces) return false;
    const auto [n, offset] = plane(corners, margin);
    if (!(dot(n, n) > 0.0)) return false;
    const double per_length = 1.0 / std::sqrt(dot(n, n));
    faces_[face_count_++] = {per_length * n, per_length * offset, corners};
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
      const bool made = add_face({rim_[i].from, rim_[i].to, tip}, margin);
      if (!made || faces_[face_count_ - 1].offset < -margin) return false;
    }
    return true;
  }

  /// Adds an edge of a removed face to the rim; shared by two, it is seen twice and drops out.
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
