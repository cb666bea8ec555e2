#include "heading.hpp"

#include "cell.hpp"

namespace repel::teleop {

std::string name_of(const World& world, PairId id) {
  const Pair& pair = world.pair(id);
  std::string name = world.part(pair.a).name;
  name += " - ";
  name += world.part(pair.b).name;
  return name;
}

Heading heading_of(const scene::Scene& scene, const Cell& cell, double rate_hz) {
  Heading heading;
  for (std::size_t i = 0; i < cell.arms.size(); ++i) {
    const Manipulator& each = cell.arms[i];
    const scene::Station& station = scene.station(i);
    ArmHeading& arm = heading.arms.emplace_back();
    if (i > 0) arm.name = scene.partners[i - 1].name;
    arm.tool = each.tool;
    for (const LinkBody& link : each.links) arm.links.push_back(link.body);
    for (const ArmLink& link : each.robot.arm.links) arm.joints.push_back(link.type);
    const network::Network network = scene::build_network(scene, station, each.robot.arm, rate_hz);
    for (const network::Node& node : network.nodes()) arm.modules.push_back(node.name);
    for (const network::Phase& phase : station.script) arm.phases.push_back(phase.name);
  }
  const World& world = cell.world;
  for (int i = 0; i < world.body_count(); ++i) heading.bodies.push_back(world.body_name({i}));
  for (std::size_t i = 0; i < world.pairs().size(); ++i) {
    heading.pairs.push_back(name_of(world, {static_cast<std::int32_t>(i)}));
  }
  return heading;
}

}  // namespace repel::teleop
