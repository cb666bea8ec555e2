// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/cameras/sights.hpp>

#include <algorithm>

#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape_mesh.hpp>
#include <repel/robots/parts.hpp>

namespace repel::runs {
namespace {

Pose nowhere() {
  Pose X = Pose::Identity();
  X.translation().setConstant(std::numeric_limits<double>::quiet_NaN());
  return X;
}

}  // namespace

Sights::Sights(const scene::Scene& scene, const std::vector<Robot>& robots, const Cell& cell)
    : cell_(cell) {
  for (std::size_t arm = 0; arm < robots.size(); ++arm) {
    const scene::ArmSetup& setup = scene.arm_setup(arm);
    kinematics_.emplace_back(cell.description().arms[arm].model);
    joints_.push_back(cell.description().arms[arm].model.links.size());
    const int index = static_cast<int>(arm);
    for (const scene::Part& part : setup.tool) {
      sights_.push_back(
          {.name = part.name, .shape = part.shape, .X = part.X_BP, .arm = index, .is_tool = true});
    }
    for (const RobotPart& part : robots[arm].parts) {
      sights_.push_back({.name = part.name,
                         .shape = shape_of(part, {.levels = 1}),
                         .X = part.X_LP,
                         .arm = index,
                         .link = part.link});
    }
  }
  for (const ObstacleDescription& each : cell.description().obstacles) {
    sights_.push_back(
        {.name = each.name, .shape = each.shape, .X = each.X_WP, .motion = each.motion});
  }
  for (std::size_t i = 0; i < scene.loose.size(); ++i) {
    const scene::LoosePart& part = scene.loose[i];
    sights_.push_back({.name = part.name, .shape = part.shape, .loose = cell.loose()[i]});
  }
  for (const scene::HiddenPart& part : scene.hidden) {
    sights_.push_back({.name = part.name,
                       .shape = part.shape,
                       .X = part.X_WP,
                       .is_hidden = true,
                       .motion = part.motion});
  }
}

Pose Sights::pose_of(const Sight& sight, double time) const noexcept {
  if (sight.arm >= 0) {
    const Kinematics& arm = kinematics_[static_cast<std::size_t>(sight.arm)];
    return composed(sight.is_tool ? arm.X_WT() : arm.X_WL(sight.link), sight.X);
  }
  if (sight.loose.valid()) {
    const World& world = cell_.world();
    const auto body = static_cast<std::size_t>(world.part(sight.loose).body.index);
    return world.is_there(sight.loose) ? world.motion().bodies[body].X_WB : nowhere();
  }
  Pose X = sight.X;
  if (sight.motion) X.translation() += sight.motion->offset(time);
  return X;
}

void Sights::place(std::span<const TickRecord* const> records, std::vector<Pose>& X_W) noexcept {
  for (std::size_t i = 0; i < std::min(records.size(), kinematics_.size()); ++i) {
    kinematics_[i].update(std::span(records[i]->q).first(joints_[i]));
  }
  for (std::size_t i = 0; i < std::min(sights_.size(), X_W.size()); ++i) {
    X_W[i] = pose_of(sights_[i], records.front()->time);
  }
}

std::vector<TriangleMesh> Sights::meshes() const {
  std::vector<TriangleMesh> meshes;
  for (const Sight& sight : sights_) meshes.push_back(mesh_of(sight.shape));
  return meshes;
}

std::vector<Shape> Sights::known() const {
  std::vector<Shape> shapes;
  for (const Sight& sight : sights_) {
    if (!sight.is_hidden) shapes.push_back(sight.shape);
  }
  return shapes;
}

void Sights::measure(const std::vector<Pose>& X_W, Clearance& clearance) const {
  for (std::size_t i = 0; i < sights_.size(); ++i) {
    const Sight& of_arm = sights_[i];
    if (of_arm.arm < 0 || of_arm.link < 0) continue;
    for (std::size_t k = 0; k < sights_.size(); ++k) {
      if (!sights_[k].is_hidden) continue;
      const Separation s = separation(of_arm.shape, X_W[i], sights_[k].shape, X_W[k],
                                      {.ignore_beyond = clearance.least});
      if (!(s.distance < clearance.least)) continue;
      clearance.least = s.distance;
      clearance.pair = of_arm.name + " - " + sights_[k].name;
    }
  }
}

}  // namespace repel::runs
