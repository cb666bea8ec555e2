// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/fixture.hpp>

#include <algorithm>
#include <cmath>

#include <repel/base/setup_error.hpp>

namespace repel::network {

AttractionLimits FixtureOptions::along(double k) const noexcept {
  return {k, most_force, range, most_energy};
}

AttractionLimits FixtureOptions::about(double k) const noexcept {
  return {k, most_torque, angular_range, most_energy};
}

bool FixtureOptions::has_inside() const noexcept {
  return radius > 0.0 || kind == FixtureKind::cone;
}

const FixtureOptions& checked_fixture(const FixtureOptions& fixture) {
  try {
    checked_fields(fixture);
    checked("radius", fixture.radius, 0.0, 1e3, "m");
    checked("half angle", fixture.half_angle, 0.01, 1.56, "rad");
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

FixtureGeometry::FixtureGeometry(const FixtureOptions& options)
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

void FixtureGeometry::begin(const Vec3& x) noexcept {
  if (kind_ == FixtureKind::path) place_ = path_.nearest(x);
}

void FixtureGeometry::follow(const Vec3& x, double motion) noexcept {
  if (kind_ == FixtureKind::path) place_ = path_.followed(place_, x, most_ahead * motion);
}

FixtureView FixtureGeometry::view(const Pose& X_WT) const noexcept {
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

Mat3 FixtureGeometry::along(const Vec3& unit) noexcept {
  Mat3 product;
  for (int i = 0; i < 9; ++i) product.data()[i] = unit[i % 3] * unit[i / 3];
  return product;
}

void FixtureGeometry::view_set(const Vec3& x, FixtureView& view) const noexcept {
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

void FixtureGeometry::view_cone(const Vec3& from_apex, FixtureView& view) const noexcept {
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

void FixtureGeometry::view_turn(const Pose& X_WT, FixtureView& view) const noexcept {
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

Vec3 FixtureGeometry::per_motion(const Pose& X_WT) const noexcept {
  const PathPoint point = path_.at(place_);
  const double square = squared_norm(point.first_W);
  const double bent = square + dot(Vec3(point.p_W - origin(X_WT)), point.second_W);
  return point.first_W / std::max(bent, square / most_ahead);
}

}  // namespace repel::network
