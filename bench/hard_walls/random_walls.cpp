// SPDX-License-Identifier: BSD-3-Clause
#include "random_walls.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/cell/cell.hpp>
#include <repel/cell/layout.hpp>
#include <repel/reduction/shape.hpp>

namespace repel::hard_walls {
namespace {

/// A shape and where it is.
struct Posed {
  Shape shape;
  Pose X_W;
  /// [m] How far it reaches along the unit `d`, from the origin of the world.
  [[nodiscard]] double extent(const Vec3& d) const {
    const Level& level = shape.level(0);
    return d.dot(X_W * to_vec3(level.core.support(rotate_transposed(X_W, Vec<double>(d))).p)) +
           level.depth;
  }
};

// A wall with its z axis along `z`, so far from all parts of the tool along `d`.
ObstacleDescription before(std::span<const Posed> tool, Shape shape, const Vec3& d, const Vec3& z,
                           double gap) {
  Posed wall{shape, Pose::Identity()};
  wall.X_W.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3(0, 0, 1), z).toRotationMatrix();
  Vec3 middle(0, 0, 0);
  double most = -1e9;
  for (const Posed& part : tool) {
    most = std::max(most, part.extent(d));
    middle += origin(part.X_W) / static_cast<double>(tool.size());
  }
  const double along = most + wall.extent(-d) + gap;
  wall.X_W.translation() = middle + (along - d.dot(middle)) * d;
  ForceLaw law;
  law.range = 0.02;
  law.surface_force = 2.0;
  law.damping_may_rise = true;
  law.hold = HoldKind::hard;
  return {"", std::move(shape), wall.X_W, law};
}

Shape random_shape(std::size_t which, Draws& draws) {
  switch (which) {
    case 0:
      return Shape::box(
          {draws.between(0.02, 0.1), draws.between(0.02, 0.1), draws.between(0.02, 0.1)});
    case 1: {
      std::vector<Vec3> points;
      const Vec3 axes(draws.between(0.03, 0.12), draws.between(0.03, 0.12),
                      draws.between(0.03, 0.12));
      for (int k = 0; k < 150; ++k) points.emplace_back(axes.cwiseProduct(draws.direction()));
      return Shape::hull(points);
    }
    case 3:
      return Shape::box({draws.between(0.05, 0.2), draws.between(0.05, 0.2), 0.001});
    default:
      return Shape::cylinder(draws.between(0.003, 0.02), draws.between(0.05, 0.2));
  }
}

/// @param tool its parts at the start @param kind receives the name of the kind
std::vector<ObstacleDescription> walls_around(std::span<const Posed> tool, std::string& kind,
                                              Draws& draws) {
  constexpr const char* kinds[] = {"boxes", "hulls", "slot", "blades", "pegs", "crates"};
  const auto which = static_cast<std::size_t>(draws.pick(6));
  kind = kinds[which];
  std::vector<ObstacleDescription> walls;
  if (which == 2 || which == 5) {  // the tool is between two walls
    const Vec3 d = draws.direction();
    const double half = which == 2 ? 0.2 : 0.05;
    const double gap = which == 2 ? draws.between(1e-3, 6e-3) : draws.between(0.03, 0.1);
    const double way = which == 2 ? 0.0 : gap - draws.between(2e-3, 2e-2);
    for (const double side : {1.0, -1.0}) {
      walls.push_back(before(tool, Shape::box({half, half, 0.01}), side * d, d, gap));
      if (which == 5) walls.back().motion = ReciprocatingMotion{-side * way * d, way / 0.05};
    }
    return walls;
  }
  for (int i = 0; i < 4; ++i) {
    walls.push_back(before(tool, random_shape(which, draws), draws.direction(), draws.direction(),
                           draws.between(5e-3, 0.1)));
  }
  return walls;
}

std::vector<Posed> tool_at_the_start(const Setting& setting, const scene::Scene& scene) {
  const Cell cell(std::move(described(setting, scene).cell));
  std::vector<Posed> tool;
  for (const Part& part : cell.world().parts()) {
    if (part.body != cell.layout(0).tool) continue;
    tool.push_back({part.shape, detail::pose_of(cell.world(), part)});
  }
  return tool;
}

}  // namespace

bool add_free_walls(Setting& setting, Draws& draws) {
  const scene::Scene scene = load(setting.scene);
  const std::vector<Posed> tool = tool_at_the_start(setting, scene);
  for (int attempt = 0; attempt < 50; ++attempt) {
    setting.obstacles = walls_around(tool, setting.kind, draws);
    for (std::size_t i = 0; i < setting.obstacles.size(); ++i) {
      setting.obstacles[i].name = setting.kind + std::to_string(i);
    }
    try {
      const Cell with(std::move(described(setting, scene).cell));
      return true;
    } catch (const SetupError&) {
      continue;  // the arm starts in one of them
    }
  }
  return false;
}

}  // namespace repel::hard_walls
