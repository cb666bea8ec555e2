// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The geometry of virtual fixtures: how far the tool is from one, and which way it lies.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/base/types.hpp>
#include <repel/network/elements/attraction.hpp>
#include <repel/network/elements/fixture_path.hpp>
#include <repel/network/elements/robot_end.hpp>

namespace repel::network {

/// What a fixture attracts to. With a radius it is what is within it that attracts: a ball, a tube,
/// a slab.
enum class FixtureKind {
  point,  ///< the origin of F
  line,   ///< the z axis of F
  plane,  ///< x and y of F
  path,   ///< through the points
  cone,   ///< solid: its apex is the origin of F, it opens along z of F
};

/// Which turning of the tool a fixture holds.
enum class Alignment {
  free,  ///< none
  axis,  ///< z of the tool along z of F, or of the frame of the path; turning about it is free
  all,   ///< the orientation of F, or of the frame of the path
};

/// One virtual fixture. Stiffness and damping may be `automatic`: as stiff as the arm allows, and
/// critical (see `suited`).
struct FixtureOptions {
  std::string name{};                     ///< in reports and the log
  FixtureKind kind = FixtureKind::point;  ///< what attracts
  Pose X_WF = Pose::Identity();           ///< [m] not of a path
  std::vector<Vec3> points{};             ///< [m] of a path, world
  std::vector<Mat3> frames{};             ///< of a path: none, or R_WF at each point
  Course course = Course::spline;         ///< of a path
  double radius = 0.0;                    ///< [m] within which there is no force; not of a cone
  double half_angle = 0.5;                ///< [rad] of a cone
  double stiffness = 1000.0;              ///< [N/m]
  double damping = automatic;             ///< [N s/m]
  double most_force = 30.0;               ///< [N] of spring and damper together
  double range = 0.1;                     ///< [m] from its surface, within which it attracts
  double most_energy = 2.0;  ///< [J] stored in its position, and as much in its orientation
  Alignment alignment = Alignment::free;  ///< of turning, held by a spring of its own
  double angular_stiffness = 20.0;        ///< [N m/rad]
  double angular_damping = automatic;     ///< [N m s/rad]
  double most_torque = 3.0;               ///< [N m]
  double angular_range = 1.0;             ///< [rad] up to 2
  bool is_on = true;                      ///< unless HandInput::guides says otherwise

  /// Of the force along the way to the fixture, for the stiffness `k` [N/m].
  [[nodiscard]] AttractionLimits along(double k) const noexcept {
    return {k, most_force, range, most_energy};
  }
  /// Of the torque, for the stiffness `k` [N m/rad].
  [[nodiscard]] AttractionLimits about(double k) const noexcept {
    return {k, most_torque, angular_range, most_energy};
  }
  /// Whether the force begins at a surface around which there is none within.
  [[nodiscard]] bool has_inside() const noexcept {
    return radius > 0.0 || kind == FixtureKind::cone;
  }
};

/// Returns `fixture`; throws SetupError naming it and the first number that is out of range.
inline const FixtureOptions& checked_fixture(const FixtureOptions& fixture) {
  try {
    (void)detail::checked_gain("stiffness", fixture.stiffness, 0.0, 1e7, "N/m");
    (void)detail::checked_gain("damping", fixture.damping, 0.0, 1e6, "N s/m");
    (void)detail::checked_gain("angular stiffness", fixture.angular_stiffness, 0.0, 1e6, "N m/rad");
    (void)detail::checked_gain("angular damping", fixture.angular_damping, 0.0, 1e6, "N m s/rad");
    (void)Attraction(fixture.along(1.0)), (void)Attraction(fixture.about(1.0));
    checked("radius", fixture.radius, 0.0, 1e3, "m");
    checked("half angle", fixture.half_angle, 0.01, 1.56, "rad");
    checked("angular range", fixture.angular_range, 1e-6, 2.0, "rad");
    if (fixture.kind == FixtureKind::path) {
      (void)FixturePath(fixture.points, fixture.frames, fixture.course);
      if (fixture.frames.empty() && fixture.alignment != Alignment::free) {
        throw SetupError("a path that turns the tool has no frames; allowed: one for each point");
      }
    }
  } catch (const SetupError& error) {
    throw SetupError("fixture '" + fixture.name + "': " + error.what());
  }
  return fixture;
}

/// Where the tool is relative to a fixture.
struct FixtureView {
  double distance = 0.0;        ///< [m] from its surface; not above 0: it is inside
  Vec3 away_W{0, 0, 0};         ///< unit: gradient of the distance
  Mat3 across = Mat3::Zero();   ///< projection on the directions that it holds
  double angle = 0.0;           ///< [rad] from its orientation, 0 to pi
  Vec3 axis_W{0, 0, 0};         ///< unit: change of the angle by rates of the tool
  Vec3 turned_W{0, 0, 0};       ///< [rad/m] and by its motion along a path whose frames turn
  Mat3 turning = Mat3::Zero();  ///< projection on the rates that it holds
};

/// A fixture and, for a path, the place on it that attracts. That place follows the tool: it moves
/// to the place nearest by, downhill, at most `most_ahead` times as far as the tool does, and not
/// while that stands still. So where the nearest place jumps, the force does not.
class FixtureGeometry {
 public:
  /// How far the place on a path may go per motion of the tool.
  static constexpr double most_ahead = 2.0;

  FixtureGeometry() = default;
  /// @throws SetupError as `checked_fixture`
  explicit FixtureGeometry(const FixtureOptions& options)
      : kind_(checked_fixture(options).kind),
        alignment_(options.alignment),
        radius_(options.radius),
        sine_(std::sin(options.half_angle)),
        cosine_(std::cos(options.half_angle)),
        p_W_(origin(options.X_WF)),
        R_WF_(rotation(options.X_WF)) {
    if (kind_ == FixtureKind::path) {
      path_ = FixturePath(options.points, options.frames, options.course);
    }
  }

  /// Looks for the nearest place anew.
  void begin(const Vec3& x) noexcept {
    if (kind_ == FixtureKind::path) place_ = path_.nearest(x);
  }
  /// The place follows the tool to `x`, which is `motion` [m] from where it was.
  void follow(const Vec3& x, double motion) noexcept {
    if (kind_ == FixtureKind::path) place_ = path_.followed(place_, x, most_ahead * motion);
  }
  /// There is a place that follows the tool: on a path.
  [[nodiscard]] bool has_place() const noexcept { return kind_ == FixtureKind::path; }
  [[nodiscard]] const PathPlace& place() const noexcept { return place_; }  ///< where on the path
  /// The path; empty for another kind.
  [[nodiscard]] const FixturePath& path() const noexcept { return path_; }

  /// @param X_WT pose of the tool
  [[nodiscard]] FixtureView view(const Pose& X_WT) const noexcept {
    FixtureView view;
    const Vec3 x = origin(X_WT);
    if (kind_ == FixtureKind::cone) {
      view_cone(x - p_W_, view);
    } else {
      view_set(x, view);
    }
    if (alignment_ != Alignment::free) view_turn(X_WT, view);
    return view;
  }

 private:
  [[nodiscard]] static Mat3 along(const Vec3& unit) noexcept {
    Mat3 product;
    for (int i = 0; i < 9; ++i) product.data()[i] = unit[i % 3] * unit[i / 3];
    return product;
  }
  [[nodiscard]] Vec3 z() const noexcept { return {R_WF_(0, 2), R_WF_(1, 2), R_WF_(2, 2)}; }

  void view_set(const Vec3& x, FixtureView& view) const noexcept {
    Vec3 away = x - p_W_;
    view.across = Mat3::Identity();
    if (kind_ == FixtureKind::line) {
      away = away - dot(away, z()) * z();
      view.across -= along(z());
    } else if (kind_ == FixtureKind::plane) {
      away = dot(away, z()) * z();
      view.across = along(z());
    } else if (kind_ == FixtureKind::path) {
      const PathPoint point = path_.at(place_);
      away = x - point.p_W;
      view.across -= along(normalized(point.first_W));
    }
    const double length = norm(away);
    view.distance = length - radius_;
    if (length > 0.0) view.away_W = away / length;
  }

  // In the half plane of the axis and the tool, (r, z): outside of the solid cone the nearest place
  // is on its generator (sin, cos), or the apex.
  void view_cone(const Vec3& from_apex, FixtureView& view) const noexcept {
    const double height = dot(from_apex, z());
    const Vec3 out = from_apex - height * z();
    const double r = norm(out);
    const Vec3 out_unit = r > 0.0 ? Vec3(out / r) : Vec3(0, 0, 0);
    const double up_along = r * sine_ + height * cosine_;
    view.across = Mat3::Identity();
    if (up_along > 0.0) {
      view.distance = r * cosine_ - height * sine_;
      view.away_W = cosine_ * out_unit - sine_ * z();
      view.across -= along(Vec3(sine_ * out_unit + cosine_ * z()));
    } else {
      view.distance = norm(from_apex);
      view.away_W = normalized(from_apex);
    }
  }

  void view_turn(const Pose& X_WT, FixtureView& view) const noexcept {
    const Mat3 R_WT = rotation(X_WT);
    const Mat3 R_WF = has_place() ? path_.frame(place_) : R_WF_;
    view.turning = Mat3::Identity();
    if (alignment_ == Alignment::axis) {
      const Vec3 own = R_WT.col(2);
      const Vec3 wanted = R_WF.col(2);
      const Vec3 cross = wanted.cross(own);
      const double sine = norm(cross);
      view.angle = std::atan2(sine, dot(wanted, own));
      if (sine > 0.0) view.axis_W = cross / sine;
      view.turning -= along(own);
    } else {
      const Eigen::AngleAxisd turn(Mat3(R_WT * transposed(R_WF)));
      view.angle = turn.angle();
      view.axis_W = turn.axis();
    }
    if (has_place()) view.turned_W = -dot(view.axis_W, path_.turning(place_)) * per_motion(X_WT);
  }

  /// Change of the parameter of the path by motion of the tool.
  [[nodiscard]] Vec3 per_motion(const Pose& X_WT) const noexcept {
    const PathPoint point = path_.at(place_);
    const double square = squared_norm(point.first_W);
    const double bent = square + dot(Vec3(point.p_W - origin(X_WT)), point.second_W);
    return point.first_W / std::max(bent, square / most_ahead);
  }

  FixtureKind kind_ = FixtureKind::point;
  Alignment alignment_ = Alignment::free;
  double radius_ = 0.0, sine_ = 0.0, cosine_ = 1.0;
  Vec3 p_W_{0, 0, 0};
  Mat3 R_WF_ = Mat3::Identity();
  FixturePath path_;
  PathPlace place_;
};

}  // namespace repel::network
