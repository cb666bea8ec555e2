// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/view/visuals_info.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include <repel/base/setup_error.hpp>
#include <repel/cell/layout.hpp>
#include <repel/robots/visuals.hpp>
#include <repel/world/kinematics.hpp>

namespace repel::runs {
namespace {

/// A frame that moves with a link: a body of the world, or where it has none the link itself.
struct Seat {
  BodyId body{};
  Pose X_BL = Pose::Identity();  ///< [m] the link in it
  int link = -1;                 ///< -1: there is a body
};

Seat seat_of(const Cell& cell, std::size_t arm, int link) {
  const ArmModel& model = cell.description().arms[arm].model;
  if (link < 0) return {.body = World::fixed, .X_BL = model.X_WB};
  for (const LinkBody& body : cell.layout(arm).links) {
    if (body.link == link) return {.body = body.body};
  }
  if (link + 1 == static_cast<int>(model.links.size())) {
    return {.body = cell.layout(arm).tool, .X_BL = model.X_LT.inverse()};
  }
  return {.link = link};
}

/// Whether it is collision geometry that the page has as a part.
bool is_part(const RobotVisual& visual, const ArmDescription& arm) {
  return !visual.collision.empty() &&
         std::any_of(arm.parts.begin(), arm.parts.end(), [&](const ArmPart& part) {
           return part.link == visual.link && part.name == visual.collision;
         });
}

void say(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return;
  const std::string more =
      warnings.size() == 1 ? "" : " (and " + std::to_string(warnings.size() - 1) + " more)";
  std::fprintf(stderr, "The live view does not show all of the robot: %s%s\n",
               warnings.front().c_str(), more.c_str());
}

}  // namespace

void add_visuals(const PreparedRun& prepared, visual::SceneInfo& info) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < prepared.robots.size(); ++i) {
    const scene::RobotChoice& choice = prepared.scene.arm_setup(i).robot;
    if (choice.is_mjcf) continue;  // its parts are shown
    RobotVisuals visuals;
    try {
      visuals = load_visuals(choice.urdf, prepared.robots[i], {.package_paths = choice.packages});
    } catch (const SetupError& error) {
      visuals.warnings.emplace_back(error.what());
    }
    warnings.insert(warnings.end(), visuals.warnings.begin(), visuals.warnings.end());
    for (RobotVisual& each : visuals.all) {
      const ArmDescription& arm = prepared.cell.description().arms[i];
      if (is_part(each, arm)) continue;
      const Seat seat = seat_of(prepared.cell, i, each.link);
      std::shared_ptr<ArmKinematics>& kinematics = info.arms[i].kinematics;
      if (seat.link >= 0 && !kinematics) kinematics = std::make_shared<Kinematics>(arm.model);
      info.visuals.push_back({.name = each.in_link,
                              .body = seat.body,
                              .arm = static_cast<int>(i),
                              .X_BV = seat.X_BL * each.X_LV,
                              .color = each.color,
                              .mesh = std::move(each.mesh),
                              .link = seat.link});
    }
  }
  say(warnings);
}

}  // namespace repel::runs
