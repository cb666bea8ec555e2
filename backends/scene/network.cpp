#include "network.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel::scene {
namespace {

/// Those of the paper's Figure 9, with their defaults, for the tool and the links of an arm.
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

/// What is to be done about walls that are too stiff, which the obstacle module says.
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

/// Line of the module that is named first in `text`; 0 when none is.
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

/// True when the network has a module that brings these walls to the arm.
bool brings(const Station& station, network::Walls walls) {
  const auto& modules = station.network.modules;
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

bool feels_links(const Station& station) {
  return brings(station, network::Walls::links);
}

network::Network build_network(const Scene& scene, const Station& station, const ArmModel& arm,
                               double rate_hz) {
  const auto& modules = station.network.modules;
  if (!(scene.obstacles.empty() && scene.partners.empty()) &&
      !brings(station, network::Walls::tool)) {
    throw SetupError("network: there are obstacles and no module 'obstacle' through which they act",
                     scene.file);
  }
  const auto& links = station.robot.links;
  if (links && !links->empty() && !feels_links(station)) {
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
    return plan.build(1.0 / rate_hz);
  } catch (const SetupError& error) {
    const std::string what = std::string("network: ") + error.what();
    throw SetupError(what, scene.file, line_of_named(modules, what));
  }
}

}  // namespace repel::scene
