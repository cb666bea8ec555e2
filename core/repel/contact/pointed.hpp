// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Directions without a contact patch: the set faces them with a single corner or edge.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <repel/base/lanes.hpp>
#include <repel/contact/plane.hpp>
#include <repel/contact/tilt_mean.hpp>
#include <repel/geometry/convex.hpp>

namespace repel::detail {

/// A direction n of a polytope, around which `FlatSearch` finds nothing flat but one edge.
struct Pointed {
  Vec<double> n{0.0, 0.0, 0.0};      ///< unit, outward, in the frame of the set
  Vec<double> along{0.0, 0.0, 0.0};  ///< unit, the edge; 0: not even that, a corner
  double below = 0.0;                ///< [1] the edge is flat only below this slope
  double within = -1.0;              ///< [1] it holds for unit vectors within this distance of n;
                                     ///< negative: there may be a face, or several edges

  /// It still holds for another unit vector.
  [[nodiscard]] bool holds(const Vec<double>& other) const noexcept {
    const Vec<double> off = other - n;
    return within > 0.0 && dot(off, off) < within * within;
  }
  /// The edge may be flat for another unit vector, provided that it `holds`.
  [[nodiscard]] bool has_edge(const Vec<double>& other) const noexcept {
    return std::abs(dot(other, along)) < below;
  }
};

/// The feature of a set around n; unknown for curved sides. Cost: about that of one support map.
class PointedSearch {
 public:
  /// @param n unit, outward, in the frame of the set
  /// @param tilt [rad] of the law
  PointedSearch(const Convex& set, const Vec<double>& n, double tilt) noexcept
      : set_(set), n_(n), tilt_(tilt) {}

  [[nodiscard]] Pointed run() const noexcept {
    Pointed pointed;
    if (set_.kind() == Convex::Kind::box) pointed = of_box();
    if (set_.kind() == Convex::Kind::polytope) pointed = of_polytope();
    pointed.n = n_;
    pointed.within -= rounding;
    if (pointed.below > 0.0) pointed.below += rounding;
    return pointed;
  }

 private:
  /// The two edges with the smallest abs(edge . n).
  struct TwoLeast {
    Vec<double> along{0.0, 0.0, 0.0};
    double least = std::numeric_limits<double>::infinity();
    double second = std::numeric_limits<double>::infinity();
    std::uint32_t to = 0;

    void add(double slope, const Vec<double>& edge, std::uint32_t vertex) noexcept {
      if (slope < least) {
        second = least;
        least = slope;
        along = edge;
        to = vertex;
      } else {
        second = std::min(second, slope);
      }
    }
  };

  [[nodiscard]] Pointed of_box() const noexcept {
    const Vec<double> half = set_.half_extents();
    TwoLeast edges;
    if (half.x() > 0.0) edges.add(std::abs(n_.x()), {1.0, 0.0, 0.0}, 0);
    if (half.y() > 0.0) edges.add(std::abs(n_.y()), {0.0, 1.0, 0.0}, 0);
    if (half.z() > 0.0) edges.add(std::abs(n_.z()), {0.0, 0.0, 1.0}, 0);
    const double angle = flat_within(tilt_);
    const bool is_point = dot(half, half) == 0.0;
    return {.along = edges.along, .below = is_point ? 0.0 : angle, .within = edges.second - angle};
  }

  [[nodiscard]] Pointed of_polytope() const noexcept {
    const std::uint32_t corner = set_.support(n_).name;
    const FacesAt here = faces_at(corner);
    TwoLeast edges;
    add_edges(corner, edges);
    Pointed alone;
    if (edges.least > here.tilt) {
      alone.within = std::min(before(edges.least, here.tilt), here.within);
      // Far from all edges, the corner behind the least one knows nothing more.
      if (edges.least > 0.5 * edges.second) return alone;
    }
    const FacesAt there = faces_at(edges.to);
    TwoLeast others;
    add_edges(edges.to, others, corner);
    const double within = std::min({before(edges.second, here.tilt),
                                    before(others.least, there.tilt), here.within, there.within});
    if (within < alone.within) return alone;
    return {.along = edges.along, .below = tilt_, .within = within};
  }

  void add_edges(std::uint32_t from, TwoLeast& edges,
                 std::uint32_t without = std::numeric_limits<std::uint32_t>::max()) const noexcept {
    const auto corners = set_.faces().at(from);
    const auto unit = set_.faces().edges_to(from);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      if (corners[k].next != without) edges.add(dot(n_, unit[k]), unit[k], corners[k].next);
    }
  }

  /// Of the faces at a corner.
  struct FacesAt {
    double tilt;    ///< [rad] bound by them
    double within;  ///< [1] as Pointed: up to where none is flat
  };
  [[nodiscard]] FacesAt faces_at(std::uint32_t corner) const noexcept {
    const Faces& faces = set_.faces();
    double least = std::numeric_limits<double>::infinity();
    double tilt = tilt_;
    for (const Faces::Corner& at : faces.at(corner)) {
      const Vec<double> between = faces.normal(at.face) - n_;
      const double square = dot(between, between);
      least = std::min(least, square);
      const double room = faces.room_of(at.face);
      if (room < tilt) tilt = std::min(tilt, tilt_beside(room, std::sqrt(square)));
    }
    // The tilt, too, changes with n.
    constexpr double growth = TiltMean::faded * tilt_growth;
    return {tilt, (std::sqrt(least) - flat_within(tilt)) / (1.0 + growth)};
  }
  /// [1] How far n may turn before the slope of an edge is that tilt [rad].
  [[nodiscard]] static double before(double slope, double tilt) noexcept {
    return (slope - tilt) / (1.0 + tilt_growth);
  }

  static constexpr double rounding = 1e-9;

  const Convex& set_;
  Vec<double> n_;
  double tilt_;  ///< [rad]
};

/// One side of several pairs, one lane per pair: the feature of its set around a direction.
class PointedLanes {
 public:
  void set(int k, const Pointed& pointed) noexcept {
    n_.set(k, pointed.n);
    along_.set(k, pointed.along);
    within_[k] = pointed.within;
    below_[k] = pointed.below;
  }
  [[nodiscard]] Pointed at(int k) const noexcept {
    return {Vec<double>(n_.at(k)), Vec<double>(along_.at(k)), below_[k], within_[k]};
  }
  /// True in lanes where it still holds for the unit vector n.
  [[nodiscard]] LaneMask holds(const LaneVec& n) const noexcept {
    const LaneVec off = n - n_;
    const Lanes none{};
    return (within_ > none) & (dot(off, off) < within_ * within_);
  }
  /// As Pointed::has_edge.
  [[nodiscard]] LaneMask has_edge(const LaneVec& n) const noexcept {
    return magnitudes(dot(n, along_)) < below_;
  }
  [[nodiscard]] const LaneVec& along() const noexcept { return along_; }

 private:
  LaneVec n_{}, along_{};
  Lanes within_ = all_of(-1.0);
  Lanes below_{};
};

}  // namespace repel::detail
