// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/records/heading.hpp>

#include <repel/cell/layout.hpp>

namespace repel::runs {

std::string name_of(const World& world, PairId id) {
  const Pair& pair = world.pair(id);
  std::string name = world.part(pair.a).name;
  name += " - ";
  name += world.part(pair.b).name;
  return name;
}

Heading heading_of(const scene::Scene& scene, const Cell& cell) {
  Heading heading;
  for (std::size_t i = 0; i < cell.arms(); ++i) {
    const ArmDescription& described = cell.description().arms[i];
    ArmHeading& arm = heading.arms.emplace_back();
    arm.name = described.name;
    arm.tool = cell.layout(i).tool;
    for (const LinkBody& link : cell.layout(i).links) arm.links.push_back(link.body);
    for (const ArmLink& link : described.model.links) {
      arm.joints.push_back(link.type);
      arm.joint_names.push_back(link.joint_name);
    }
    for (const network::Node& node : cell.network(i).nodes()) {
      // A prediction is not one of those that the scene lists, and the last.
      if (node.module.as<network::Prediction>() == nullptr) arm.modules.push_back(node.name);
    }
    for (const network::Phase& phase : scene.arm_setup(i).script) arm.phases.push_back(phase.name);
  }
  const World& world = cell.world();
  for (int i = 0; i < world.body_count(); ++i) heading.bodies.push_back(world.body_name({i}));
  for (std::size_t i = 0; i < world.pairs().size(); ++i) {
    heading.pairs.push_back(name_of(world, {static_cast<std::int32_t>(i)}));
  }
  for (const scene::CameraChoice& camera : scene.cameras) {
    heading.cameras.push_back(camera.name.empty() ? "camera" : camera.name);
  }
  return heading;
}

}  // namespace repel::runs
