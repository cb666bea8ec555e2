// SPDX-License-Identifier: BSD-3-Clause
#include "task.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <stdexcept>

#include <repel/geometry/facets.hpp>
#include <support/gaps.hpp>

#include "truth.hpp"

namespace repel::bench {

namespace {

using families::random_pose;
using families::Rng;

/// [m] and [rad] Motion of a tool in one tick of a millisecond.
constexpr double tick_travel = 5e-4;
constexpr double tick_turn = 0.1 * M_PI / 180.0;

/// Rounds the vertices to floats, as MuJoCo stores those of meshes, so that no library is charged
/// with the rounding error.
Solid in_floats(Solid s) {
  if (s.box) return s;
  for (Vec3& v : s.vertices) v = v.cast<float>().cast<double>();
  return s;
}

/// Adds a pair whose B moves by tick_travel until the second tick; redraws that motion until
/// `holds` accepts it.
void add_pair(Task& task, Rng& rng, const families::Pair& p,
              const std::function<bool(const Pose&)>& holds) {
  Pose X_WB = p.X_WB;
  do {
    X_WB = p.X_WB;
    X_WB.translation() += tick_travel * families::direction(rng);
    X_WB.linear() = families::small_rotation(rng, tick_turn) * p.X_WB.linear();
  } while (!holds(X_WB));
  task.X_W.resize(2);
  task.pairs.push_back({task.solids.size(), task.solids.size() + 1});
  task.solids.push_back(p.A);
  task.solids.push_back(p.B);
  task.X_W[0].insert(task.X_W[0].end(), {p.X_WA, p.X_WB});
  task.X_W[1].insert(task.X_W[1].end(), {p.X_WA, X_WB});
}

bool is_apart(const families::Pair& p, const Pose& X_WB) {
  return exact_gap(p.A, p.X_WA, p.B, X_WB) > 1e-5;
}

/// Pairs drawn by `draw`, until `count` of them are more than `least` [m] apart.
Task apart_task(int count, std::uint64_t seed, double least,
                const std::function<families::Pair(Rng&)>& draw) {
  Task task;
  Rng rng(seed);
  while (static_cast<int>(task.pairs.size()) < count) {
    const families::Pair p = draw(rng);
    if (!(exact_gap(p.A, p.X_WA, p.B, p.X_WB) > least)) continue;
    add_pair(task, rng, p, [&](const Pose& X_WB) { return is_apart(p, X_WB); });
  }
  return task;
}

/// Pairs at random poses, about one size apart.
Task size_task(int vertices, int count) {
  return apart_task(count, 100 + vertices, 1e-3, [=](Rng& rng) {
    families::Pair p;
    p.A = draw_solid(rng, vertices);
    p.B = draw_solid(rng, vertices);
    p.X_WA.linear() = families::rotation(rng);
    p.X_WB = random_pose(rng, 0.6, 1.6);
    return p;
  });
}

/// Pairs of a family that is difficult for distance algorithms, 0.1 mm to 1 m apart.
Task family_task(const std::string& family, int count) {
  return apart_task(count, 200, 5e-5, [=](Rng& rng) {
    return families::draw_apart(family, rng, families::log_uniform(rng, 1e-4, 1.0));
  });
}

/// True if all pairs of the task are apart at these poses of tool and obstacles.
bool all_apart(const Task& task, const std::vector<Pose>& X_W) {
  return std::all_of(task.pairs.begin(), task.pairs.end(), [&](const Pair& p) {
    return exact_gap(task.solids[p.a], X_W[p.a], task.solids[p.b], X_W[p.b]) > 1e-3;
  });
}

/// A tool of rigidly joined parts (the first solids) drifts, and turns away where it would collide.
void wander(Task& task, Rng& rng, std::size_t parts, std::size_t ticks) {
  Vec3 heading = families::direction(rng);
  Vec3 axis = families::direction(rng);
  while (task.ticks() < ticks) {
    std::vector<Pose> next = task.X_W.back();
    const Eigen::AngleAxisd turn(tick_turn, axis);
    const Vec3 centre = next[0].translation();
    for (std::size_t i = 0; i < parts; ++i) {
      const Vec3 arm = next[i].translation() - centre;
      next[i].translation() = centre + turn * arm + tick_travel * heading;
      next[i].linear() = turn * next[i].linear();
    }
    if (all_apart(task, next)) {
      task.X_W.push_back(std::move(next));
    } else {
      heading = families::direction(rng);
      axis = families::direction(rng);
    }
  }
}

/// 4 tool parts and 8 obstacles, boxes and hulls of 8 to 16 vertices, all pairs.
Task tick_task(std::size_t ticks) {
  constexpr std::size_t parts = 4;
  constexpr std::size_t obstacles = 8;
  Rng rng(400);
  Task task;
  const auto draw = [&](std::size_t i) {
    return draw_solid(rng, i % 2 == 0 ? 0 : families::count_between(rng, 8, 16));
  };
  for (std::size_t i = 0; i < parts + obstacles; ++i) task.solids.push_back(draw(i));
  for (std::size_t a = 0; a < parts; ++a) {
    for (std::size_t b = 0; b < obstacles; ++b) task.pairs.push_back({a, parts + b});
  }
  do {
    task.X_W.assign(1, {});
    for (std::size_t i = 0; i < parts; ++i) task.X_W[0].push_back(random_pose(rng, 0.0, 0.5));
    for (std::size_t i = 0; i < obstacles; ++i) task.X_W[0].push_back(random_pose(rng, 1.2, 2.0));
  } while (!all_apart(task, task.X_W[0]));
  wander(task, rng, parts, ticks);
  return task;
}

/// One tool slides along 8 obstacles, a few millimetres to a metre away.
Task trajectory_task(std::size_t ticks) {
  constexpr std::size_t obstacles = 8;
  Rng rng(500);
  Task task;
  task.batch = obstacles;
  task.solids.push_back(draw_solid(rng, 16));
  task.X_W.assign(1, {random_pose(rng, 0.0, 0.1)});
  for (std::size_t i = 1; i <= obstacles; ++i) {
    families::Pair p;
    p.A = task.solids[0];
    p.X_WA = task.X_W[0][0];
    do {
      p.B = draw_solid(rng, i % 2 == 0 ? 0 : 12);
      p.X_WB = random_pose(rng, 0.5, 1.5);
    } while (!is_apart(p, p.X_WB) || exact_gap(p.A, p.X_WA, p.B, p.X_WB) > 0.05);
    task.pairs.push_back({0, i});
    task.solids.push_back(p.B);
    task.X_W[0].push_back(p.X_WB);
  }
  wander(task, rng, 1, ticks);
  return task;
}

using Draw = std::function<Task(bool quick)>;

/// Every task by name, in the order of the table.
const std::vector<std::pair<std::string, Draw>>& recipes() {
  static const auto all = [] {
    std::vector<std::pair<std::string, Draw>> list;
    const auto count = [](int n, bool quick) { return quick ? std::max(32, n / 8) : n; };
    list.emplace_back("tick", [](bool quick) { return tick_task(quick ? 8 : 64); });
    list.emplace_back("box", [=](bool quick) { return size_task(0, count(256, quick)); });
    for (const int n : {8, 16, 32, 64, 256, 1000}) {
      const int pairs = n > 64 ? 64 : 256;
      list.emplace_back(std::to_string(n) + "v",
                        [=](bool quick) { return size_task(n, count(pairs, quick)); });
    }
    list.emplace_back("trajectory", [](bool quick) { return trajectory_task(quick ? 16 : 256); });
    for (const auto* family : {"parallel faces", "nearly parallel faces", "parallel edges",
                               "needles", "plates", "vertex on vertex", "scales 1e-3:1e3"}) {
      std::string name = family;
      std::replace(name.begin(), name.end(), ' ', '_');
      list.emplace_back(name, [=](bool quick) { return family_task(family, count(128, quick)); });
    }
    list.emplace_back("overlap_box",
                      [=](bool quick) { return overlap_task(0, count(128, quick)); });
    list.emplace_back("overlap_32v",
                      [=](bool quick) { return overlap_task(32, count(64, quick)); });
    return list;
  }();
  return all;
}

}  // namespace

Solid draw_solid(Rng& rng, int vertices) {
  if (vertices == 0) return families::random_box(rng, 0.1, 0.5);
  return in_floats(families::cloud(rng, vertices, 0.5));
}

Task overlap_task(int vertices, int count) {
  Task task;
  task.overlap = true;
  Rng rng(300 + vertices);
  while (static_cast<int>(task.pairs.size()) < count) {
    families::Pair p;
    p.A = draw_solid(rng, vertices);
    p.B = draw_solid(rng, vertices);
    p.X_WA.linear() = families::rotation(rng);
    p.X_WB = random_pose(rng, 0.1, 0.9);
    const auto depth = [&](const Pose& X_WB) { return exact_depth(p.A, p.X_WA, p.B, X_WB); };
    if (!(depth(p.X_WB) > 1e-3)) continue;
    add_pair(task, rng, p, [&](const Pose& X_WB) { return depth(X_WB) > 1e-4; });
  }
  return task;
}

std::vector<Ask> Task::asks() const {
  std::vector<Ask> all;
  const auto visit = [&](std::size_t tick) {
    for (std::size_t pair = 0; pair < pairs.size(); ++pair) all.push_back({pair, tick});
  };
  for (std::size_t tick = 0; tick < ticks(); ++tick) visit(tick);
  for (std::size_t tick = ticks() - 1; tick-- > 1;) visit(tick);
  return all;
}

const std::vector<std::string>& task_names() {
  static const auto names = [] {
    std::vector<std::string> list;
    for (const auto& [name, draw] : recipes()) list.push_back(name);
    return list;
  }();
  return names;
}

Task make_task(std::string_view name, bool quick) {
  for (const auto& [known, draw] : recipes()) {
    if (known != name) continue;
    Task task = draw(quick);
    task.name = known;
    return task;
  }
  throw std::invalid_argument("there is no task " + std::string(name));
}

std::vector<Truth> exact_answers(const Task& task) {
  const auto reach = [&](std::size_t i) {
    double farthest = 0.0;
    for (const Vec3& v : task.solids[i].vertices) farthest = std::max(farthest, v.norm());
    return farthest;
  };
  std::vector<Truth> answers;
  for (const std::vector<Pose>& X_W : task.X_W) {
    for (const auto& [a, b] : task.pairs) {
      const auto exact = task.overlap ? exact_depth : exact_gap;
      const double value = exact(task.solids[a], X_W[a], task.solids[b], X_W[b]);
      answers.push_back({task.overlap ? -value : value, std::max(reach(a), reach(b))});
    }
  }
  return answers;
}

Vec3 centre(const Solid& solid) {
  const auto faces = triangles(solid);
  const bool origin_inside = std::all_of(faces.begin(), faces.end(), [&](const auto& face) {
    const Vec3& v = solid.vertices[face[0]];
    return (solid.vertices[face[1]] - v).cross(solid.vertices[face[2]] - v).dot(v) > 0.0;
  });
  if (origin_inside) return Vec3::Zero();
  Vec3 sum = Vec3::Zero();
  for (const Vec3& v : solid.vertices) sum += v;
  return sum / static_cast<double>(solid.vertices.size());
}

std::vector<std::array<int, 3>> triangles(const Solid& solid) {
  std::vector<std::array<int, 3>> faces;
  for (const Facet& f : hull_facets(solid.vertices)) {
    faces.push_back({static_cast<int>(f.vertices[0]), static_cast<int>(f.vertices[1]),
                     static_cast<int>(f.vertices[2])});
  }
  return faces;
}

}  // namespace repel::bench
