// SPDX-License-Identifier: BSD-3-Clause
#include "paths.hpp"

#include <algorithm>
#include <cmath>

#include "truth.hpp"

namespace repel::bench {

namespace {

using families::Rng;

/// The path of A past or through B, which is at the origin.
struct Way {
  Solid A, B;
  Mat3 R_WA, R_WB;
  Vec3 along;             ///< unit
  Vec3 aside;             ///< [m] normal to it
  double whole_turn = 0;  ///< [rad] about the line `along` through the origin

  /// The pose `s` [m] before the middle of the path; `share` is the fraction of the path covered.
  [[nodiscard]] Pose X_WA(double s, double share) const {
    const Eigen::AngleAxisd turn(share * whole_turn, along);
    Pose X = Pose::Identity();
    X.linear() = turn * R_WA;
    X.translation() = turn * aside + s * along;
    return X;
  }
  [[nodiscard]] Pose X_WB() const { return Pose(Eigen::AngleAxisd(R_WB)); }
  [[nodiscard]] double depth(double s) const { return exact_depth(A, X_WA(s, 0.0), B, X_WB()); }
};

Way draw_way(Rng& rng, int vertices) {
  Way way;
  way.A = draw_solid(rng, vertices);
  way.B = draw_solid(rng, vertices);
  way.R_WA = families::rotation(rng);
  way.R_WB = families::rotation(rng);
  way.along = families::direction(rng);
  way.aside =
      families::uniform(rng, 0.0, 0.3) * way.along.cross(families::direction(rng)).normalized();
  return way;
}

/// [m] Distance before the middle of its path at which A comes into contact.
double contact(const Way& way) {
  double meets = 0.0;
  double apart = 2.0;
  while (apart - meets > 1e-9) {
    const double middle = 0.5 * (meets + apart);
    (way.depth(middle) > 0.0 ? meets : apart) = middle;
  }
  return apart;
}

/// Adds the pair; `X_WA(tick)` is the pose of A.
template <class Where>
void add_pair(Task& task, const Way& way, Where&& X_WA) {
  task.pairs.push_back({task.solids.size(), task.solids.size() + 1});
  task.solids.insert(task.solids.end(), {way.A, way.B});
  for (std::size_t tick = 0; tick < task.ticks(); ++tick) {
    task.X_W[tick].push_back(X_WA(static_cast<double>(tick)));
    task.X_W[tick].push_back(way.X_WB());
  }
}

}  // namespace

Task press_task(int vertices, int count) {
  constexpr double first = 1e-6;
  constexpr double growth = 1.1;
  constexpr double last = 0.3;
  Task task;
  task.overlap = true;
  task.X_W.resize(static_cast<std::size_t>(std::log(last / first) / std::log(growth)));
  Rng rng(600 + vertices);
  while (static_cast<int>(task.pairs.size()) < count) {
    const Way way = draw_way(rng, vertices);
    if (!(way.depth(0.0) > 0.05)) continue;
    const double start = contact(way);
    add_pair(task, way,
             [&](double tick) { return way.X_WA(start - first * std::pow(growth, tick), 0.0); });
  }
  return task;
}

Task sweep_task(int vertices, int count) {
  constexpr double apart = 1.5;  // [m]
  Task task;
  task.X_W.resize(200);
  Rng rng(700 + vertices);
  for (int i = 0; i < count; ++i) {
    Way way = draw_way(rng, vertices);
    if (i % 2 == 1) way.whole_turn = families::uniform(rng, 0.5 * M_PI, 2.0 * M_PI);
    const double last = static_cast<double>(task.ticks() - 1);
    add_pair(task, way,
             [&](double tick) { return way.X_WA(apart * (1.0 - 2.0 * tick / last), tick / last); });
  }
  return task;
}

double motion(const Task& task, const Ask& ask) {
  const std::size_t a = task.pairs[ask.pair].a;
  const Pose& before = task.X_W[ask.tick - 1][a];
  const Pose& after = task.X_W[ask.tick][a];
  double farthest = 0.0;
  for (const Vec3& v : task.solids[a].vertices) {
    farthest = std::max(farthest, (after * v - before * v).norm());
  }
  return farthest;
}

}  // namespace repel::bench
