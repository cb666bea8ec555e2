// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/arms/contact.hpp>

#include <repel/robots/parts.hpp>

namespace repel::runs {

std::vector<ContactPart> contact_parts(const scene::Scene& scene, const scene::ArmSetup& setup,
                                       const Robot& robot) {
  std::vector<ContactPart> parts;
  const int last = static_cast<int>(robot.arm.links.size()) - 1;
  for (const scene::Part& part : setup.tool) {
    parts.push_back({part.name, last, part.shape, robot.arm.X_LT * part.X_BP});
  }
  for (const RobotPart& part : robot.parts) {
    if (part.link < 0) continue;  // the base is fixed, as the obstacles are
    parts.push_back({part.name, part.link, shape_of(part, {.levels = 1}), part.X_LP});
  }
  for (const scene::Obstacle& obstacle : scene.obstacles) {
    if (obstacle.law.passable) continue;
    if (obstacle.motion) {
      throw SetupError("obstacle '" + obstacle.name +
                           "' has a motion; with --contact only obstacles that stand are allowed",
                       scene.file);
    }
    parts.push_back({obstacle.name, -1, obstacle.shape, obstacle.X_WP});
  }
  return parts;
}

}  // namespace repel::runs
