// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Pairs of shapes whose nearest features are nearly parallel, of every kind that meets.
#pragma once

#include <string>
#include <vector>

#include <repel/contact/patch.hpp>
#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape.hpp>
#include <support/families.hpp>

namespace repel::test {

/// The patch of a pair, or its nearest point.
struct Contact {
  double distance = 0.0;  ///< [m]
  Wrench gradient;        ///< [1], [m] about the origin of A
  bool has_patch = false;
};

/// A over B, which is fixed: the flat features of both face each other along z.
struct Contacts {
  Shape A, B;
  Pose X_WA = Pose::Identity();
  Pose X_WB = Pose::Identity();
  double tilt = 0.005;  ///< [rad]

  [[nodiscard]] Contact find() const {
    WarmStart cold;
    return find(cold);
  }
  [[nodiscard]] Contact find(WarmStart& warm, Measure measure = Measure::deepest_point) const {
    QueryOptions options;
    options.measure = measure;
    const Separation s = separation(A, X_WA, B, X_WB, options, warm);
    ContactPatch patch;
    patch.gradient.force = s.extraction_W;
    Contact found;
    found.has_patch = find_patch(s, {A, X_WA}, {B, X_WB}, tilt, patch);
    found.distance = s.distance - patch.nearer;
    found.gradient = patch.gradient;
    found.gradient.torque += (s.p_WA - origin(X_WA)).cross(patch.gradient.force);
    return found;
  }
  [[nodiscard]] Contacts swapped() const { return {B, A, X_WB, X_WA, tilt}; }
  /// A moved by `d` [m] and turned by `turn` [rad] around its own origin.
  [[nodiscard]] Contacts moved(const Vec3& d, const Vec3& turn) const {
    Contacts other = *this;
    other.X_WA.translation() += d;
    const double angle = turn.norm();
    if (angle > 0.0) {
      other.X_WA.linear() =
          Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() * X_WA.linear();
    }
    return other;
  }
};

/// What is up and the flat feature of a shape below it, in its own frame.
struct Lying {
  Shape shape;
  Mat3 R;         ///< turns it so that the feature faces -z
  double height;  ///< [m] of its origin above the feature
};

inline Lying lying(const std::string& kind, families::Rng& rng) {
  const auto length = [&](double low, double high) { return families::uniform(rng, low, high); };
  const Mat3 upright = Mat3::Identity();
  const Mat3 on_side = Eigen::AngleAxisd(M_PI / 2.0, Vec3::UnitY()).toRotationMatrix();
  if (kind == "box") {
    const Vec3 half(length(0.03, 0.08), length(0.03, 0.08), length(0.02, 0.05));
    return {Shape::box(half), upright, half.z()};
  }
  if (kind == "edge") {
    const Vec3 half(length(0.03, 0.08), length(0.03, 0.05), length(0.03, 0.05));
    const double angle = length(0.3, 1.2);
    return {Shape::box(half), Eigen::AngleAxisd(angle, Vec3::UnitX()).toRotationMatrix(),
            half.y() * std::sin(angle) + half.z() * std::cos(angle)};
  }
  if (kind == "hull") {
    const families::Solid solid =
        families::prism(families::count_between(rng, 3, 9), length(0.03, 0.08), 0.04);
    return {Shape::hull(solid.vertices), upright, 0.04};
  }
  if (kind == "cloud") {
    // Any of its faces or edges is down; those beside it may face nearly the same way.
    const Shape shape =
        Shape::hull(families::cloud(rng, families::count_between(rng, 6, 60), 0.06).vertices);
    const Convex& core = shape.level(0).core;
    const auto corners = core.faces().at(core.support(Vec<double>(families::direction(rng))).name);
    const double share = std::max(0.0, families::uniform(rng, -1.0, 1.0));
    const Vec<double> n = (1.0 - share) * core.faces().normal(corners[0].face) +
                          share * core.faces().normal(corners[1].face);
    const Vec3 down = to_vec3(n).normalized();
    const Mat3 R = Eigen::Quaterniond::FromTwoVectors(down, -Vec3::UnitZ()).toRotationMatrix();
    return {shape, R, core.support_value(Vec<double>(down))};
  }
  if (kind == "cap") {
    const double half = length(0.03, 0.08);
    return {Shape::cylinder(length(0.02, 0.06), half), upright, half};
  }
  if (kind == "side") {
    const double radius = length(0.02, 0.05);
    return {Shape::cylinder(radius, length(0.03, 0.1)), on_side, radius};
  }
  if (kind == "cone") {
    const double half = length(0.03, 0.08);
    return {Shape::cone(length(0.02, 0.06), half), upright, half};
  }
  const double radius = length(0.01, 0.04);
  return {Shape::capsule(radius, length(0.03, 0.1)), on_side, radius};
}

/// The kinds of features that meet: A's over B's.
inline const std::vector<std::pair<std::string, std::string>>& kinds_of_contacts() {
  static const std::vector<std::pair<std::string, std::string>> kinds{
      {"box", "box"},         {"edge", "box"},    {"hull", "box"},    {"hull", "hull"},
      {"cloud", "box"},       {"cloud", "cloud"}, {"cloud", "side"},  {"cap", "box"},
      {"cap", "cap"},         {"side", "box"},    {"side", "side"},   {"capsule", "box"},
      {"capsule", "capsule"}, {"cone", "box"},    {"capsule", "side"}};
  return kinds;
}

/// A pair of a kind, `gap` [m] apart or less, tilted by at most two tilts, overlapping sideways.
inline Contacts draw_contacts(const std::pair<std::string, std::string>& kinds, double gap,
                              families::Rng& rng) {
  const Lying above = lying(kinds.first, rng);
  const Lying below = lying(kinds.second, rng);
  const bool are_lines = kinds.second != "box" && kinds.second != "hull" && kinds.second != "cap";
  Contacts pair{above.shape, below.shape};
  // Lines are nearly parallel in the plane, too.
  const double yaw =
      are_lines ? families::uniform(rng, -0.05, 0.05) : families::uniform(rng, -M_PI, M_PI);
  const double side = are_lines ? 0.0 : 0.05;
  const auto tilt = [&] { return families::uniform(rng, -2.0, 2.0) * pair.tilt; };
  const Mat3 flipped = Eigen::AngleAxisd(M_PI, Vec3::UnitX()).toRotationMatrix();
  pair.X_WB.linear() = flipped * below.R;
  Pose X = Pose::Identity();
  X.linear() = (Eigen::AngleAxisd(tilt(), Vec3::UnitX()) *
                Eigen::AngleAxisd(tilt(), Vec3::UnitY()) * Eigen::AngleAxisd(yaw, Vec3::UnitZ()))
                   .toRotationMatrix() *
               above.R;
  X.translation() = Vec3(families::uniform(rng, -0.05, 0.05), families::uniform(rng, -side, side),
                         above.height + below.height + gap);
  pair.X_WA = X;
  const Pose X_WW = families::random_pose(rng, -1.0, 1.0);
  pair.X_WA = X_WW * pair.X_WA;
  pair.X_WB = X_WW * pair.X_WB;
  return pair;
}

}  // namespace repel::test
