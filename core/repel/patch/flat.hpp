/// @file
/// The flat features of a convex set that face a direction.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>

#include <repel/geometry/convex.hpp>
#include <repel/patch/plane.hpp>
#include <repel/patch/tilt_mean.hpp>

namespace repel::detail {

/// A flat feature: a point, a segment, or a convex polygon.
struct Flat {
  static constexpr int most = 16;

  std::array<Vec<double>, most> corners;  ///< [m] from the origin of the set, world axes
  int size = 0;
  Vec<double> normal{};  ///< of a polygon, outward
  bool is_disc = false;  ///< the polygon stands for a disc
  double radius = 0.0;   ///< [m] of a segment: of curvature across it
  double tilt = 0.0;     ///< [rad] up to which no other feature of the set is nearest

  void add(const Vec<double>& p) noexcept { corners[static_cast<std::size_t>(size++)] = p; }
  [[nodiscard]] const Vec<double>& at(int i) const noexcept {
    return corners[static_cast<std::size_t>(i)];
  }
};

/// [rad] Features count as flat within this angle of the tangent plane. It is more than the tilt,
/// so that they come and go with weight zero.
[[nodiscard]] inline double flat_within(double tilt) noexcept {
  return TiltMean::faded * tilt;
}

/// False if a box has no edge, and a cylinder neither cap nor side, that is perpendicular to a
/// direction within `angle` [rad].
[[nodiscard]] inline bool may_be_flat(const Convex& set, const Pose& X, const Vec<double>& n_W,
                                      double angle) noexcept {
  if (set.kind() != Convex::Kind::box && set.kind() != Convex::Kind::cylinder) return true;
  const Vec<double> n = magnitudes(rotate_transposed(X, n_W));
  if (set.kind() == Convex::Kind::box) return std::min(std::min(n.x(), n.y()), n.z()) < angle;
  return n.z() < angle || n.x() * n.x() + n.y() * n.y() < angle * angle;
}

/// The flat feature of a set that is perpendicular to a direction within an angle.
class FlatSearch {
 public:
  /// @param X the pose of the set
  /// @param n_W unit
  /// @param tilt [rad] of which features are asked for, small
  FlatSearch(const Convex& set, const Pose& X, const Vec<double>& n_W, double tilt) noexcept
      : set_(set), X_(X), n_(rotate_transposed(X, n_W)), tilt_(tilt), angle_(flat_within(tilt)) {}

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
      case Convex::Kind::polytope:
        break;
    }
    return of_polytope();
  }

  [[nodiscard]] Flat of_box() const noexcept {
    const Vec<double> half = set_.half_extents();
    const double n[3] = {n_.x(), n_.y(), n_.z()};
    const double h[3] = {half.x(), half.y(), half.z()};
    Flat flat;
    Vec<double> middle{0.0, 0.0, 0.0};
    std::array<Vec<double>, 2> free;
    int count = 0;
    int fixed = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec<double> edge = h[k] * column<double>(X_, k);
      if (std::abs(n[k]) < angle_ && h[k] > 0.0 && count < 2) {
        free[static_cast<std::size_t>(count++)] = edge;
      } else {
        fixed = k;
        middle = n[k] > 0.0 ? middle + edge : middle - edge;
      }
    }
    if (count == 0) {
      flat.add(middle);
    } else if (count == 1) {
      flat.add(middle - free[0]);
      flat.add(middle + free[0]);
    } else {
      flat.add(middle - free[0] - free[1]);
      flat.add(middle + free[0] - free[1]);
      flat.add(middle + free[0] + free[1]);
      flat.add(middle - free[0] + free[1]);
      flat.normal = (n[fixed] > 0.0 ? 1.0 : -1.0) * column<double>(X_, fixed);
    }
    return flat;
  }

  /// A disc at `z` [m] as a polygon with a corner where it is farthest along the direction.
  [[nodiscard]] Flat of_disc(double radius, double z, double across) const noexcept {
    const double x = across > 0.0 ? n_.x() / across : 1.0;
    const double y = across > 0.0 ? n_.y() / across : 0.0;
    Flat flat;
    for (int i = 0; i < disc_corners; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / disc_corners;
      const double c = radius * std::cos(angle);
      const double s = radius * std::sin(angle);
      flat.add(rotate(X_, Vec<double>(c * x - s * y, c * y + s * x, z)));
    }
    flat.normal = (n_.z() > 0.0 ? 1.0 : -1.0) * column<double>(X_, 2);
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
      flat.add(rotate(X_, rim - half));
      flat.add(rotate(X_, rim + half));
      flat.radius = size.x();
    } else {
      flat.add(rotate(X_, rim + (n_.z() > 0.0 ? half : -half)));
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
      flat.add(rotate(X_, rim));
      flat.add(rotate(X_, tip));
      flat.radius = 0.5 * radius;
    } else {
      flat.add(rotate(X_, off > 0.0 ? rim : tip));
    }
    return flat;
  }

  /// The flattest face at the farthest vertex, or the flattest edge.
  ///
  /// Where faces differ by little, the tilt is less, by so much that its disc around n meets one
  /// face, or one edge, wherever n is: the least of what each face has room for, plus a share of
  /// the angle from its normal to n. It changes continuously with n.
  [[nodiscard]] Flat of_polytope() const noexcept {
    const Faces& faces = set_.faces();
    const std::uint32_t farthest = set_.support(n_).name;
    Flat flat;
    flat.tilt = tilt_;
    double least = std::numeric_limits<double>::infinity();
    Edge edge;
    Edge second;
    std::uint32_t face = none;
    for (const Faces::Corner& corner : faces.at(farthest)) {
      const double off = lower_tilt(corner.face, flat);
      if (off < least) {
        least = off;
        face = corner.face;
      }
      const Edge next{corner.next, slope_along(farthest, corner.next)};
      if (next.slope < edge.slope) {
        second = edge;
        edge = next;
      } else if (next.slope < second.slope) {
        second = next;
      }
    }
    if (least < flat_within(flat.tilt)) return of_face(face, farthest, flat);
    // The disc also meets both edges of a sharp corner of a face that is farther off.
    if (second.slope < flat.tilt) {
      for (const Faces::Corner& corner : faces.at(farthest)) {
        if ((corner.next == edge.to && corner.previous == second.to) ||
            (corner.next == second.to && corner.previous == edge.to)) {
          return of_face(corner.face, farthest, flat);
        }
      }
    }
    flat.add(rotate(X_, set_.place(farthest)));
    if (!(edge.slope < flat.tilt)) return flat;
    for (const Faces::Corner& corner : faces.at(edge.to)) (void)lower_tilt(corner.face, flat);
    flat.tilt = std::min(flat.tilt, std::min(faces.room_at(farthest), faces.room_at(edge.to)));
    flat.add(rotate(X_, set_.place(edge.to)));
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

  /// Lowers the tilt to what a face leaves, and returns how far its normal is off [rad].
  double lower_tilt(std::uint32_t face, Flat& flat) const noexcept {
    constexpr double growth = 0.045;
    const Vec<double> between = set_.faces().normal(face) - n_;
    const double off = std::sqrt(dot(between, between));
    flat.tilt = std::min(flat.tilt, set_.faces().room_of(face) + growth * off);
    return off;
  }

  /// A face; with many corners, those farthest along a few directions stand for it, the first of
  /// which leads to the corner `farthest`.
  [[nodiscard]] Flat of_face(std::uint32_t face, std::uint32_t farthest, Flat flat) const noexcept {
    const Vec<double>& normal = set_.faces().normal(face);
    const auto corners = set_.faces().corners(face);
    flat.normal = rotate(X_, normal);
    if (corners.size() <= Flat::most) {
      for (const std::uint32_t name : corners) flat.add(rotate(X_, set_.place(name)));
      return flat;
    }
    const PlanarAxes axes(normal);
    Planar middle{};
    for (const std::uint32_t name : corners) {
      middle =
          middle + (1.0 / static_cast<double>(corners.size())) * axes.in_plane(set_.place(name));
    }
    const Planar to_farthest = axes.in_plane(set_.place(farthest)) - middle;
    std::uint32_t last = none;
    for (int k = 0; k < disc_corners; ++k) {
      const double turn = 2.0 * std::numbers::pi * k / disc_corners;
      const Planar d =
          std::cos(turn) * to_farthest + std::sin(turn) * Planar{-to_farthest.y, to_farthest.x};
      std::uint32_t best = farthest;
      double most = -std::numeric_limits<double>::infinity();
      for (const std::uint32_t name : corners) {
        const double along = dot(d, axes.in_plane(set_.place(name)));
        if (k == 0 || along <= most) continue;
        most = along;
        best = name;
      }
      if (best != last) flat.add(rotate(X_, set_.place(best)));
      last = best;
    }
    return flat;
  }

  static constexpr std::uint32_t none = 0xFFFFFFFFU;
  /// Corners that stand for a disc. The one nearest to the other set is a point of the disc itself.
  static constexpr int disc_corners = 12;

  const Convex& set_;
  const Pose& X_;
  Vec<double> n_;        ///< in the frame of the set
  double tilt_, angle_;  ///< [rad]
};

}  // namespace repel::detail
