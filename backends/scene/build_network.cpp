#include <repel/scene/build_network.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace repel::scene {
namespace {

/// Line of the module whose name occurs first in `text`; 0 if none does.
int line_of_named(const std::vector<Module>& modules, const std::string& text) {
  std::size_t first = std::string::npos;
  int line = 0;
  for (const Module& module : modules) {
    const std::size_t at = text.find("'" + module.name + "'");
    if (at >= first) continue;
    first = at;
    line = module.line;
  }
  return line;
}

/// Whether the network has a module that applies these walls to the arm.
bool brings(const ArmSetup& setup, network::Walls walls) {
  const auto& modules = setup.network.modules;
  return std::any_of(modules.begin(), modules.end(),
                     [&](const Module& m) { return m.walls == walls; });
}

}  // namespace

bool feels_links(const ArmSetup& setup) {
  return brings(setup, network::Walls::links);
}

network::Plan plan_network(const Scene& scene, const ArmSetup& setup, const ArmModel& arm) {
  const auto& modules = setup.network.modules;
  if (!(scene.obstacles.empty() && scene.partners.empty()) &&
      !brings(setup, network::Walls::tool)) {
    throw SetupError("network: there are obstacles and no module 'obstacle' through which they act",
                     scene.file);
  }
  const auto& links = setup.robot.links;
  if (links && !links->empty() && !feels_links(setup)) {
    throw SetupError(
        "robot: there are links to keep off the obstacles and no module 'arm_obstacle' in the "
        "network through which they feel them",
        scene.file);
  }
  network::Plan plan;
  try {
    for (const Module& module : modules) {
      plan.add(module.name, module.make(arm), module.to);
    }
  } catch (const SetupError& error) {
    if (!error.file().empty()) throw;  // a value of the file that does not suit this arm
    throw located(scene, SetupError(std::string("network: ") + error.what()));
  }
  return plan;
}

network::Network build_network(const Scene& scene, const ArmSetup& setup, const ArmModel& arm,
                               double rate_hz) {
  const network::Plan plan = plan_network(scene, setup, arm);
  try {
    return plan.build(1.0 / rate_hz);
  } catch (const SetupError& error) {
    throw located(scene, SetupError(std::string("network: ") + error.what()));
  }
}

SetupError located(const Scene& scene, const SetupError& error) {
  const std::string what = error.what();
  if (!error.file().empty()) return error;
  int line = 0;
  for (std::size_t i = 0; i <= scene.partners.size() && line == 0; ++i) {
    if (what.starts_with("network: "))
      line = line_of_named(scene.arm_setup(i).network.modules, what);
  }
  return SetupError(what, scene.file, line);
}

}  // namespace repel::scene
