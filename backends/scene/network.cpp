#include "network.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel::scene {
namespace {

/// The modules of the paper's Figure 9, with their defaults, for the tool and the links of an arm.
constexpr std::string_view default_modules[] = {
    "torque_arm", "multiplex",    "spaceball", "relief", "kbb2",       "obstacle",
    "puma_kin",   "arm_obstacle", "limits",    "visual", "puma_joints"};

Module module_of(const Value& value, const ModuleKinds& kinds) {
  const Map map(value);
  const Value& kind = map.at("module");
  const std::vector<std::string_view> words(kinds.words().begin(), kinds.words().end());
  Module module;
  module.kind = module.name = kind.word_of(words);
  static_cast<ReadModule&>(module) = kinds.at(module.kind)(ModuleEntry(map));
  module.line = value.line();
  map.read("name", module.name);
  if (const Value* to = map.find("to")) {
    module.to.next = false;
    if (to->is_list()) {
      for (const Value& name : to->list(input_limits.modules))
        module.to.names.push_back(name.text());
    } else {
      module.to.names.push_back(to->text());
    }
  }
  return module;
}

/// Reads the reaction to walls that are too stiff, given with the obstacle module.
void read_gain_check(const Value& module, Network& network) {
  const Map map(module);
  if (const Value* check = map.find("gain_check")) {
    const bool warn = check->word_of({"error", "warning"}) == "warning";
    network.gain_check = warn ? network::GainCheck::warning : network::GainCheck::error;
  }
}

Network listed_in(const Value& list, const ModuleKinds& kinds) {
  Network network;
  for (const Value& entry : list.list(input_limits.modules)) {
    network.modules.push_back(module_of(entry, kinds));
    if (network.modules.back().kind == "obstacle") read_gain_check(entry, network);
  }
  return network;
}

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

Network detail::network_of(const Value* value, const ModuleKinds& kinds) {
  if (value != nullptr) {
    Network network = listed_in(*value, kinds);
    if (network.modules.empty()) value->fail("'network' has no module; allowed: 1 or more");
    return network;
  }
  std::string text;
  for (const std::string_view word : default_modules) {
    text += "- module: " + std::string(word) + "\n";
  }
  Network network = listed_in(Value::document(text, ""), kinds);
  for (Module& module : network.modules) module.line = 0;
  return network;
}

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
