// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The geometry of virtual fixtures: how far the tool is from one, and which way it lies.
#pragma once

#include <string>
#include <vector>

#include <repel/base/field.hpp>
#include <repel/base/types.hpp>
#include <repel/network/elements/attraction.hpp>
#include <repel/network/elements/fixture_path.hpp>
#include <repel/network/elements/robot_end.hpp>

namespace repel::network {

/// The target of a fixture. With a radius, all points within it: a ball, a tube, a slab.
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
  [[nodiscard]] AttractionLimits along(double k) const noexcept;
  /// Of the torque, for the stiffness `k` [N m/rad].
  [[nodiscard]] AttractionLimits about(double k) const noexcept;
  /// Whether the force is zero inside the surface.
  [[nodiscard]] bool has_inside() const noexcept;

  /// Calls visit(Field, x) for the numbers that every shape has.
  template <class Visit, class Options>
  static constexpr void for_each_field(const Visit& visit, Options& o) {
    visit(Field{"stiffness", "N/m", 0.0, 1e7, true}, o.stiffness);
    visit(Field{"damping", "N s/m", 0.0, 1e6, true}, o.damping);
    visit(Field{"most_force", "N", 1e-9, 1e6}, o.most_force);
    visit(Field{"range", "m", 1e-6, 1e3}, o.range);
    visit(Field{"most_energy", "J", 1e-9, 1e6}, o.most_energy);
    visit(Choice{"alignment", {"free", "axis", "all"}}, o.alignment);
    visit(Field{"angular_stiffness", "N m/rad", 0.0, 1e6, true}, o.angular_stiffness);
    visit(Field{"angular_damping", "N m s/rad", 0.0, 1e6, true}, o.angular_damping);
    visit(Field{"most_torque", "N m", 1e-9, 1e6}, o.most_torque);
    visit(Field{"angular_range", "rad", 1e-6, 2.0}, o.angular_range);
  }
};

/// Returns `fixture`; throws SetupError naming it and the first number that is out of range.
const FixtureOptions& checked_fixture(const FixtureOptions& fixture);

/// Where the tool is relative to a fixture.
struct FixtureView {
  double distance = 0.0;        ///< [m] from its surface; not above 0: it is inside
  Vec3 away_W{0, 0, 0};         ///< unit: gradient of the distance
  Mat3 across = Mat3::Zero();   ///< projection on the directions that it holds
  double angle = 0.0;           ///< [rad] from its orientation, 0 to pi
  Vec3 axis_W{0, 0, 0};         ///< unit: change of the angle by rates of the tool
  Vec3 turned_W{0, 0, 0};       ///< [rad/m] and by its motion along a path with turning frames
  Mat3 turning = Mat3::Zero();  ///< projection on the rates that it holds
};

/// A fixture and, for a path, the attracting place on it. That place follows the tool downhill to
/// the local nearest, at most `most_ahead` times as far as the tool moves, and rests when the tool
/// does. So the force does not jump with the nearest place.
class FixtureGeometry {
 public:
  /// How far the place on a path may go per motion of the tool.
  static constexpr double most_ahead = 2.0;

  FixtureGeometry() = default;
  /// @throws SetupError as `checked_fixture`
  explicit FixtureGeometry(const FixtureOptions& options);

  /// Looks for the nearest place anew.
  void begin(const Vec3& x) noexcept;
  /// The place follows the tool to `x`, after a motion of `motion` [m].
  void follow(const Vec3& x, double motion) noexcept;
  /// There is a place following the tool: on a path.
  [[nodiscard]] bool has_place() const noexcept { return kind_ == FixtureKind::path; }
  [[nodiscard]] const PathPlace& place() const noexcept { return place_; }  ///< where on the path
  /// The path; empty for another kind.
  [[nodiscard]] const FixturePath& path() const noexcept { return path_; }

  /// @param X_WT pose of the tool
  [[nodiscard]] FixtureView view(const Pose& X_WT) const noexcept;

 private:
  [[nodiscard]] static Mat3 along(const Vec3& unit) noexcept;
  [[nodiscard]] Vec3 z() const noexcept { return {R_WF_(0, 2), R_WF_(1, 2), R_WF_(2, 2)}; }

  void view_set(const Vec3& x, FixtureView& view) const noexcept;

  // In the half plane of the axis and the tool, (r, z): outside of the solid cone the nearest place
  // is on its generator (sin, cos), or the apex.
  void view_cone(const Vec3& from_apex, FixtureView& view) const noexcept;

  void view_turn(const Pose& X_WT, FixtureView& view) const noexcept;

  /// Change of the parameter of the path by motion of the tool.
  [[nodiscard]] Vec3 per_motion(const Pose& X_WT) const noexcept;

  FixtureKind kind_ = FixtureKind::point;
  Alignment alignment_ = Alignment::free;
  double radius_ = 0.0, sine_ = 0.0, cosine_ = 1.0;
  Vec3 p_W_{0, 0, 0};
  Mat3 R_WF_ = Mat3::Identity();
  FixturePath path_;
  PathPlace place_;
};

}  // namespace repel::network
