// SPDX-License-Identifier: BSD-3-Clause
#include "scene.hpp"
#include <repel/reduction/shape.hpp>

#include <algorithm>
#include <cmath>

#include <support/families.hpp>

namespace repel::scale {

namespace {

using families::Rng;

constexpr int riders = 64;  // maximum number of obstacles on a moving body
const BodyId tool{1};

/// [m] Radius of a tool with that many parts.
double tool_radius(int parts) {
  return 0.06 * std::cbrt(parts);
}

Vec3 in_ball(Rng& rng) {
  return std::cbrt(families::uniform(rng, 0.0, 1.0)) * families::direction(rng);
}

/// A box, or the hull of 16 points on its inscribed ellipsoid.
Shape draw_shape(Rng& rng, bool box, double largest) {
  Vec3 half;
  for (double& h : half) h = families::log_uniform(rng, 0.005, largest);
  if (box) return Shape::box(half);
  std::vector<Vec3> points;
  for (int i = 0; i < 16; ++i) points.push_back(half.cwiseProduct(families::direction(rng)));
  return Shape::hull(points);
}

Pose placed(Rng& rng, const Vec3& position) {
  Pose X = Pose::Identity();
  X.linear() = families::rotation(rng);
  X.translation() = position;
  return X;
}

int tool_parts_for(int pairs) {
  return std::clamp(static_cast<int>(std::sqrt(0.5 * pairs)), 1, 100);
}

}  // namespace

Path::Path(const Vec3& centre, double region, double speed, std::uint64_t seed) : centre_(centre) {
  Rng rng(seed);
  constexpr double turn = 0.5;  // [rad] largest angle about each axis
  const double amplitude = region / waves;
  // Root mean square over three axes of that many waves.
  const double rate = speed / (amplitude * std::sqrt(1.5 * waves));
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < waves; ++i) {
      const double pace = families::uniform(rng, 0.3, 1.5);
      position_[axis][i] = {amplitude, rate * pace, families::uniform(rng, 0.0, 2.0 * M_PI)};
      rotation_[axis][i] = {turn / waves, 10.0 * speed * families::uniform(rng, 0.5, 1.5),
                            families::uniform(rng, 0.0, 2.0 * M_PI)};
    }
  }
}

Vec3 Path::sum(const Wave (&of)[3][waves], double seconds) {
  Vec3 total = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    for (const Wave& wave : of[axis]) {
      total[axis] += wave.amplitude * std::sin(wave.rate * seconds + wave.phase);
    }
  }
  return total;
}

Pose Path::at(double seconds) const {
  const Vec3 turn = sum(rotation_, seconds);
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  X.translation() = centre_ + sum(position_, seconds);
  return X;
}

Scene::Scene(const Setting& setting)
    : setting_(setting), tool_parts_(tool_parts_for(setting.pairs)) {
  Rng rng(setting.seed);
  for (int i = 0; i < tool_parts_; ++i) {
    const Shape shape = draw_shape(rng, i % 2 == 0, 0.02);
    tool_places_.push_back(in_ball(rng));
    parts_.push_back({"tool part", tool, shape, placed(rng, Vec3::Zero())});
  }
  const int obstacles = (setting.pairs + tool_parts_ - 1) / tool_parts_;
  riding_ = std::min(riders, obstacles / 8);
  for (int i = 0; i < obstacles; ++i) {
    const int other = riding_ > 0 ? 2 + i / riding_ : setting.bodies + 1;
    const BodyId body = other <= setting.bodies ? BodyId{other} : World::fixed;
    places_.push_back(in_ball(rng));
    parts_.push_back(
        {"obstacle", body, draw_shape(rng, i % 2 == 0, 0.03), placed(rng, Vec3::Zero())});
  }
}

void Scene::spread(double radius) {
  // Where the obstacles cannot come any closer, the parts of the tool do.
  const double shrunk = std::min(1.0, radius / closest);
  for (int i = 0; i < tool_parts_; ++i) {
    parts_[i].X_BP.translation() = shrunk * tool_radius(tool_parts_) * tool_places_[i];
  }
  for (int i = 0; i < obstacles(); ++i) {
    Part& part = parts_[tool_parts_ + i];
    const double share = part.body == World::fixed ? 1.0 : 1.0 * riding_ / obstacles();
    part.X_BP.translation() = std::cbrt(share) * radius * places_[i];
  }
  const double region = std::clamp(0.4 * radius, 0.08 * shrunk, 0.4);
  Rng rng(setting_.seed);
  paths_.clear();
  paths_.emplace_back(Vec3::Zero(), region, setting_.speed, rng());
  for (int i = 1; i < setting_.bodies; ++i) {
    const Vec3 centre = std::min(radius, 0.4) * families::direction(rng);
    paths_.emplace_back(centre, 0.5 * region, 0.4 * setting_.speed, rng());
  }
}

World Scene::world() const {
  World world({.bodies = setting_.bodies + 1,
               .parts = static_cast<int>(parts_.size()),
               .pairs = setting_.pairs,
               .threads = setting_.most_threads});
  for (const Placement& p : placements(0)) world.add_body("body", p.X_WB);
  for (const Part& part : parts_) world.add_part(part.body, part.name, part.shape, part.X_BP);
  for (std::int32_t i = 0; i < setting_.pairs; ++i) {
    world.add_pair({i / obstacles()}, {tool_parts_ + i % obstacles()}, law_);
  }
  return world;
}

std::span<const Placement> Scene::placements(std::int64_t tick) const {
  placements_.resize(paths_.size());
  const double now = period * static_cast<double>(tick);
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    const Pose X = paths_[i].at(now);
    const Pose before = paths_[i].at(now - period);
    const Eigen::AngleAxisd turn(Mat3(X.linear() * before.linear().transpose()));
    placements_[i] = {
        {static_cast<std::int32_t>(i) + 1},
        X,
        {(X.translation() - before.translation()) / period, turn.angle() / period * turn.axis()}};
  }
  return placements_;
}

Speed Scene::speed() const {
  Speed speed;
  for (int tick = 0; tick < setting_.ticks; ++tick) {
    const Twist V = placements(tick).front().V_WB;
    speed.mean += V.linear.norm() / setting_.ticks;
    speed.most = std::max(speed.most, V.linear.norm());
    speed.most_turn = std::max(speed.most_turn, period * V.angular.norm());
  }
  return speed;
}

}  // namespace repel::scale
