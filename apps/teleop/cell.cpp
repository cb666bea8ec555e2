#include "cell.hpp"

#include <repel/loop/gain_check.hpp>

namespace repel::teleop {
namespace {

ArmModel load_model(const scene::RobotChoice& choice, bool with_gravity) {
  UrdfOptions options;
  options.tip = choice.tip_link;
  ArmModel model = load_arm(choice.urdf, options).arm;
  model.X_WB = choice.X_WB * model.X_WB;
  model.X_LT = model.X_LT * choice.X_LT;
  if (!with_gravity) model.gravity_W.setZero();
  return model;
}

std::vector<double> checked_start(const scene::Scene& scene, const ArmModel& model) {
  const std::vector<double>& start = scene.robot.start;
  if (start.size() != model.links.size()) {
    throw SetupError("robot start has " + std::to_string(start.size()) + " values; " +
                         scene.robot.urdf + " has " + std::to_string(model.links.size()) +
                         " moving joints",
                     scene.file);
  }
  for (std::size_t i = 0; i < start.size(); ++i) {
    const ArmLink& link = model.links[i];
    if (start[i] >= link.lower && start[i] <= link.upper) continue;
    throw SetupError("robot start of joint " + link.joint_name + " is " + to_text(start[i]) +
                         " rad; allowed: " + to_text(link.lower) + " to " + to_text(link.upper),
                     scene.file);
  }
  return start;
}

World build_world(const scene::Scene& scene, const Pose& X_WT, BodyId& tool) {
  World world;
  tool = world.add_body("tool", X_WT);
  std::vector<PartId> tool_parts;
  for (const scene::Part& part : scene.tool) {
    tool_parts.push_back(world.add_part(tool, part.name, part.shape, part.X_BP));
  }
  for (const scene::Obstacle& obstacle : scene.obstacles) {
    const PartId id = world.add_part(World::fixed, obstacle.name, obstacle.shape, obstacle.X_WP);
    for (const PartId part : tool_parts) world.add_pair(part, id, obstacle.law);
  }
  return world;
}

}  // namespace

Cell::Cell(const scene::Scene& scene, bool with_gravity)
    : model(load_model(scene.robot, with_gravity)),
      start(checked_start(scene, model)),
      kinematics(model),
      world([&] {
        kinematics.update(start);
        return build_world(scene, kinematics.X_WT(), tool);
      }()) {}

double Cell::device_damping() {
  kinematics.update(start);
  Eigen::Matrix<double, 6, Eigen::Dynamic> J(6, static_cast<Eigen::Index>(model.links.size()));
  kinematics.tool_jacobian(J);
  return repel::device_damping(model, J);
}

}  // namespace repel::teleop
