// SPDX-License-Identifier: BSD-3-Clause
#include "network_reader.hpp"

#include <string>
#include <string_view>
#include <vector>

#include <repel/common/input_limits.hpp>

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
    for (const Value& name : to->one_or_list(input_limits.modules)) {
      module.to.names.push_back(name.text());
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
  bool has_guide = false;
  for (const Value& entry : list.list(input_limits.modules)) {
    network.modules.push_back(module_of(entry, kinds));
    if (network.modules.back().kind == "obstacle") read_gain_check(entry, network);
    if (network.modules.back().kind != "guide") continue;
    if (has_guide) entry.fail("a second module 'guide'; allowed: one, with all fixtures");
    has_guide = true;
  }
  return network;
}

}  // namespace

Network detail::network_of(const Value* value, const ModuleKinds& kinds) {
  if (value != nullptr) {
    Network network = listed_in(*value, kinds);
    if (network.modules.empty()) value->fail("'network' has no module; allowed: 1 or more");
    network.line = value->line();
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

}  // namespace repel::scene
