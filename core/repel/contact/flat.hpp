// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The flat features of a convex set facing a direction.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

#include <repel/contact/plane.hpp>
#include <repel/contact/tilt_mean.hpp>
#include <repel/geometry/convex.hpp>

namespace repel::detail {

/// The flat feature of a set perpendicular to the normal of a contact within an angle.
class FlatSearch {
 public:
  /// @param X the pose of the set
  /// @param nearest [m] its nearest point, from its origin, world axes
  /// @param tilt [rad] of which features are asked for, small
  FlatSearch(const Convex& set, const Pose& X, const PlanarAxes& axes, Facing facing,
             const Vec<double>& nearest, double tilt) noexcept
      : set_(set),
        X_(X),
        axes_(axes),
        is_up_(facing == Facing::up),
        n_(rotate_transposed(X, is_up_ ? axes.n : -axes.n)),
        nearest_(nearest),
        tilt_(tilt),
        angle_(flat_within(tilt)) {}

  [[nodiscard]] Flat run() const noexcept {
    Flat flat = find();
    if (set_.kind() != Convex::Kind::polytope) flat.tilt = tilt_;
    return flat;
  }

 private:
  [[nodiscard]] Flat find() const noexcept {
    switch (set_.kind()) {
      case Convex::Kind::box:
        return of_box();
      case Convex::Kind::cylinder:
        return of_cylinder();
      case Convex::Kind::cone:
        return of_cone();
      case Convex::Kind::ellipsoid:
        return of_ellipsoid();
      case Convex::Kind::polytope:
        break;
    }
    return of_polytope();
  }

  [[nodiscard]] Planar in_plane(const Vec<double>& p) const noexcept {
    return axes_.in_plane(p - nearest_);
  }
  /// Adds a corner at `p` [m], from the origin of the set in its frame.
  void add(Flat& flat, const Vec<double>& p) const noexcept {
    flat.outline.add(in_plane(rotate(X_, p)), !is_up_);
  }
  void add_segment(Flat& flat, const Vec<double>& from, const Vec<double>& to) const noexcept {
    add(flat, from);
    add(flat, to);
    const Planar along = flat.outline.at(1).r - flat.outline.at(0).r;
    const double rise = (is_up_ ? 1.0 : -1.0) * dot(to - from, n_);
    flat.slope = (rise / dot(along, along)) * along;
  }
  void set_slope(Flat& flat, const Vec<double>& normal) const noexcept {
    flat.slope = (-1.0 / dot(normal, axes_.n)) * axes_.in_plane(normal);
  }

  [[nodiscard]] Flat of_box() const noexcept {
    const Vec<double> half = set_.half_extents();
    const double n[3] = {n_.x(), n_.y(), n_.z()};
    const double h[3] = {half.x(), half.y(), half.z()};
    Flat flat;
    Vec<double> middle{0.0, 0.0, 0.0};
    std::array<int, 2> free{};
    int count = 0;
    int fixed = 0;
    for (int k = 0; k < 3; ++k) {
      if (std::abs(n[k]) < angle_ && h[k] > 0.0 && count < 2) {
        free[static_cast<std::size_t>(count++)] = k;
      } else {
        fixed = k;
        const Vec<double> edge = h[k] * column<double>(X_, k);
        middle = n[k] > 0.0 ? middle + edge : middle - edge;
      }
    }
    const Planar centre = in_plane(middle);
    if (count == 0) flat.outline.add(centre, !is_up_);
    if (count == 0) return flat;
    const Planar u = h[free[0]] * axes_.in_plane(column<double>(X_, free[0]));
    if (count == 1) {
      flat.outline.add(centre - u, !is_up_);
      flat.outline.add(centre + u, !is_up_);
      flat.slope = ((is_up_ ? h[free[0]] : -h[free[0]]) * n[free[0]] / dot(u, u)) * u;
      return flat;
    }
    Planar v = h[free[1]] * axes_.in_plane(column<double>(X_, free[1]));
    if (cross(u, v) < 0.0) v = -1.0 * v;
    flat.outline.add(centre - u - v, !is_up_);
    flat.outline.add(centre + u - v, !is_up_);
    flat.outline.add(centre + u + v, !is_up_);
    flat.outline.add(centre - u + v, !is_up_);
    set_slope(flat, column<double>(X_, fixed));
    return flat;
  }

  /// A disc at `z` [m] as a polygon with a corner where it is farthest along the direction.
  [[nodiscard]] Flat of_disc(double radius, double z, double across) const noexcept {
    const double x = across > 0.0 ? n_.x() / across : 1.0;
    const double y = across > 0.0 ? n_.y() / across : 0.0;
    const Vec<double> axis = column<double>(X_, 2);
    const double hand = dot(axis, axes_.n) > 0.0 ? radius : -radius;
    const Planar centre = in_plane(z * axis);
    const Planar u = radius * axes_.in_plane(rotate(X_, Vec<double>(x, y, 0.0)));
    const Planar v = hand * axes_.in_plane(rotate(X_, Vec<double>(-y, x, 0.0)));
    Flat flat;
    for (std::size_t k = 0; k < disc_corners; ++k) {
      const Planar way = disc_corner(k);
      flat.outline.add(centre + way.x * u + way.y * v, !is_up_);
    }
    set_slope(flat, axis);
    flat.is_disc = true;
    return flat;
  }

  [[nodiscard]] Flat of_cylinder() const noexcept {
    const Vec<double> size = set_.round_size();
    const double across = std::sqrt(n_.x() * n_.x() + n_.y() * n_.y());
    const double z = n_.z() > 0.0 ? size.z() : -size.z();
    if (across < angle_ && size.x() > 0.0) return of_disc(size.x(), z, across);
    const double scale = across > 0.0 ? size.x() / across : 0.0;
    const Vec<double> rim{scale * n_.x(), scale * n_.y(), 0.0};
    const Vec<double> half{0.0, 0.0, size.z()};
    Flat flat;
    if (std::abs(n_.z()) < angle_ && size.z() > 0.0) {
      add_segment(flat, rim - half, rim + half);
      flat.radius = size.x();
    } else {
      add(flat, rim + (n_.z() > 0.0 ? half : -half));
    }
    return flat;
  }

  [[nodiscard]] Flat of_cone() const noexcept {
    const double radius = set_.round_size().x();
    const double base = set_.round_size().y();
    const double apex = set_.round_size().z();
    const double across = std::sqrt(n_.x() * n_.x() + n_.y() * n_.y());
    if (across < angle_ && n_.z() < 0.0 && radius > 0.0) return of_disc(radius, base, across);
    const double scale = across > 0.0 ? radius / across : 0.0;
    const Vec<double> rim{scale * n_.x(), scale * n_.y(), base};
    const Vec<double> tip{0.0, 0.0, apex};
    const double slant = std::hypot(radius, apex - base);
    const double off = across * radius - n_.z() * (apex - base);
    Flat flat;
    if (std::abs(off) < angle_ * slant && slant > 0.0) {
      add_segment(flat, rim, tip);
      flat.radius = 0.5 * radius;
    } else {
      add(flat, off > 0.0 ? rim : tip);
    }
    return flat;
  }

  /// Curved everywhere: a single point.
  [[nodiscard]] Flat of_ellipsoid() const noexcept {
    Flat flat;
    add(flat, set_.support(n_).p);
    return flat;
  }

  /// The flattest face at the farthest vertex, or the flattest edge.
  ///
  /// Between nearly parallel faces the tilt is less, so that its disc around any n meets one face
  /// or one edge only. It is the least over the faces of their room, plus a share of the angle from
  /// the normal to n. It changes continuously with n.
  [[nodiscard]] Flat of_polytope() const noexcept {
    const Faces& faces = set_.faces();
    const std::uint32_t farthest = set_.support(n_).name;
    Flat flat;
    flat.tilt = tilt_;
    double least = std::numeric_limits<double>::infinity();
    Edge edge;
    std::uint32_t face = none;
    const auto corners = faces.at(farthest);
    const auto edges = faces.edges_to(farthest);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const double square = lower_tilt(corners[k].face, flat);
      if (square < least) {
        least = square;
        face = corners[k].face;
      }
      const double slope = dot(n_, edges[k]);
      if (slope < edge.slope) edge = {corners[k].next, slope};
    }
    const double within = flat_within(flat.tilt);
    if (least < within * within) return of_face(face, farthest, flat);
    if (!(edge.slope < flat.tilt)) {
      add(flat, set_.place(farthest));
      return flat;
    }
    for (const Faces::Corner& corner : faces.at(edge.to)) (void)lower_tilt(corner.face, flat);
    flat.tilt = std::min(flat.tilt, std::min(faces.room_at(farthest), faces.room_at(edge.to)));
    // At a sharp corner, the disc also meets the other edge of a face that is farther off.
    double least_slope = flat.tilt;
    face = none;
    const auto look_at = [&](std::uint32_t vertex, std::uint32_t other) {
      for (const Faces::Corner& corner : faces.at(vertex)) {
        if (corner.next != other && corner.previous != other) continue;
        const double slope =
            slope_along(vertex, corner.next == other ? corner.previous : corner.next);
        if (!(slope < least_slope)) continue;
        least_slope = slope;
        face = corner.face;
      }
    };
    look_at(farthest, edge.to);
    look_at(edge.to, farthest);
    if (face != none) return of_face(face, farthest, flat);
    add_segment(flat, set_.place(farthest), set_.place(edge.to));
    return flat;
  }

  /// An edge of the farthest vertex.
  struct Edge {
    std::uint32_t to = none;
    double slope = std::numeric_limits<double>::infinity();  ///< along it, against the plane
  };
  [[nodiscard]] double slope_along(std::uint32_t from, std::uint32_t to) const noexcept {
    const Vec<double> away = set_.place(from) - set_.place(to);
    return dot(n_, away) / std::sqrt(dot(away, away));
  }

  /// Lowers the tilt to the bound by a face; returns the squared angle to its normal [rad^2].
  double lower_tilt(std::uint32_t face, Flat& flat) const noexcept {
    const Vec<double> between = set_.faces().normal(face) - n_;
    const double square = dot(between, between);
    const double room = set_.faces().room_of(face);
    if (room < flat.tilt) flat.tilt = std::min(flat.tilt, tilt_beside(room, std::sqrt(square)));
    return square;
  }

  /// A face; with many corners, by those farthest along a few directions. The first direction leads
  /// to the corner `farthest`.
  [[nodiscard]] Flat of_face(std::uint32_t face, std::uint32_t farthest, Flat flat) const noexcept {
    const Vec<double>& normal = set_.faces().normal(face);
    const auto corners = set_.faces().corners(face);
    set_slope(flat, rotate(X_, normal));
    flat.face = face;
    if (corners.size() <= Flat::most) {
      const std::size_t last = corners.size() - 1;
      for (std::size_t k = 0; k <= last; ++k) {
        add(flat, set_.place(corners[is_up_ ? k : last - k]));
      }
      return flat;
    }
    const PlanarAxes axes(is_up_ ? normal : -normal);
    Planar sum{};
    for (const std::uint32_t name : corners) sum = sum + axes.in_plane(set_.place(name));
    const Planar middle = (1.0 / static_cast<double>(corners.size())) * sum;
    const Planar to_farthest = axes.in_plane(set_.place(farthest)) - middle;
    std::uint32_t last = none;
    for (std::size_t k = 0; k < disc_corners; ++k) {
      const Planar way = disc_corner(k);
      const Planar d = way.x * to_farthest + way.y * Planar{-to_farthest.y, to_farthest.x};
      std::uint32_t best = farthest;
      double most = -std::numeric_limits<double>::infinity();
      for (const std::uint32_t name : corners) {
        const double along = dot(d, axes.in_plane(set_.place(name)));
        if (k == 0 || along <= most) continue;
        most = along;
        best = name;
      }
      if (best != last) add(flat, set_.place(best));
      last = best;
    }
    return flat;
  }

  static constexpr std::uint32_t none = 0xFFFFFFFFU;
  /// The directions of the corners of a disc, a twelfth of a turn apart, from the x axis. The
  /// corner nearest to the other set is a point of the disc itself.
  static constexpr std::size_t disc_corners = 12;
  [[nodiscard]] static Planar disc_corner(std::size_t k) noexcept {
    constexpr double c = 0.5 * std::numbers::sqrt3;
    constexpr std::array<double, disc_corners> cosines{1.0,  c,  0.5,  0.0, -0.5, -c,
                                                       -1.0, -c, -0.5, 0.0, 0.5,  c};
    return {cosines[k], cosines[(k + 9) % disc_corners]};
  }

  const Convex& set_;
  const Pose& X_;
  const PlanarAxes& axes_;
  bool is_up_;
  Vec<double> n_;  ///< outward, in the frame of the set
  Vec<double> nearest_;
  double tilt_, angle_;  ///< [rad]
};

}  // namespace repel::detail
