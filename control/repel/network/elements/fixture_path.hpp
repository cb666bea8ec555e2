// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A path through points in space, and a point that follows it.
#pragma once

#include <cstddef>
#include <vector>

#include <repel/base/types.hpp>

namespace repel::network {

/// How a path runs from point to point.
enum class Course {
  straight,  ///< a polyline
  spline,    ///< the natural cubic spline over the lengths of the chords
};

/// A point of a path: that of the local parameter `along` [m] of a piece.
struct PathPlace {
  std::size_t piece = 0;  ///< its index: between two points
  double along = 0.0;     ///< [m] 0 to the length of its chord

  /// The same piece and parameter.
  friend bool operator==(const PathPlace&, const PathPlace&) = default;
};

/// What a path is at a place.
struct PathPoint {
  Vec3 p_W{0, 0, 0};       ///< [m]
  Vec3 first_W{0, 0, 0};   ///< derivative by the parameter: of length 1 on a polyline, about 1 else
  Vec3 second_W{0, 0, 0};  ///< [1/m] second derivative
};

/// A polyline or a cubic spline, with a frame at each point if it is given any. All allocation is
/// at construction.
class FixturePath {
 public:
  static constexpr std::size_t most_points = 256;  ///< of one path

  FixturePath() = default;
  /// @param points [m] at least two, each at least 0.1 mm from the one before
  /// @param frames none, or one for each point; between two points it turns about one axis
  /// @throws SetupError otherwise
  FixturePath(const std::vector<Vec3>& points, const std::vector<Mat3>& frames, Course course);

  /// One fewer than points.
  [[nodiscard]] std::size_t pieces() const noexcept { return pieces_.size(); }

  /// Of the chord of a piece [m].
  [[nodiscard]] double length(std::size_t piece) const noexcept { return pieces_[piece].length; }

  /// The path at a place. Cost: a polynomial of the third degree.
  [[nodiscard]] PathPoint at(const PathPlace& place) const noexcept;
  /// The orientation of the frame there. At each point of the path it stands still, so that its
  /// rate does not jump from piece to piece.
  [[nodiscard]] Mat3 frame(const PathPlace& place) const noexcept;
  /// The rate at which the frame turns along the parameter [rad/m], world axes.
  [[nodiscard]] Vec3 turning(const PathPlace& place) const noexcept;
  /// Whether it is an end of the path, or a corner of a polyline between two pieces.
  [[nodiscard]] bool is_at_corner(const PathPlace& place) const noexcept;

  /// The place nearest to `x` [m], looking at every piece. Points alone could pick the wrong one of
  /// two nearly equal minima, so the descent starts in each candidate piece. Cost: nine points of
  /// each, and eight steps from the nearest ones.
  [[nodiscard]] PathPlace nearest(const Vec3& x) const noexcept;

  /// The place from `from` on down to the local nearest to `x`, at most `most` [m] from it. It
  /// never moves away from `x`.
  [[nodiscard]] PathPlace followed(const PathPlace& from, const Vec3& x,
                                   double most) const noexcept;

 private:
  /// p + first u + second u^2 + third u^3
  struct Piece {
    Vec3 p{0, 0, 0}, first{0, 0, 0}, second{0, 0, 0}, third{0, 0, 0};
    double length = 0.0;
    Mat3 R = Mat3::Identity();
    Vec3 turn{0, 0, 0};  // [rad] of the frame to the next point
  };

  // Natural spline: its second derivatives m at the points solve a tridiagonal system.
  void bend();

  // One Newton step towards the local nearest, shortened until it does not move away. At the end of
  // a piece it goes on to the next if that leads nearer still.
  [[nodiscard]] PathPlace descended(const PathPlace& from, const Vec3& x) const noexcept;
  [[nodiscard]] PathPlace turned_to(const PathPlace& place, const Vec3& x) const noexcept;

  // Between two places, the second too far from `start`.
  [[nodiscard]] PathPlace part_way(const PathPlace& place, const PathPlace& next, const Vec3& start,
                                   double most, const Vec3& x) const noexcept;

  std::vector<Piece> pieces_;
  bool has_frames_ = false;
};

}  // namespace repel::network
