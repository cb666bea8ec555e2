// SPDX-License-Identifier: BSD-3-Clause
#include <repel/base/setup_error.hpp>
#include <repel/scene/build_network.hpp>

#include <algorithm>
#include <any>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <repel/network/elements/line.hpp>
#include <repel/network/modules/kbb2.hpp>
#include <repel/network/modules/multiplex.hpp>
#include <repel/network/modules/six_axes.hpp>
#include <repel/network/modules/torque_arm.hpp>

#include "network_reader.hpp"
#include "yaml.hpp"

namespace repel::scene {
namespace {

/// [rad/s] at which a line turns a tool at most: the damper of a coupling is chosen for it.
constexpr double fastest_turning = 1.0;

/// Line of the entry whose name occurs first in `text`; 0 if none does.
template <class Entry>
int line_of_named(const std::vector<Entry>& entries, const std::string& text) {
  std::size_t first = std::string::npos;
  int line = 0;
  for (const Entry& entry : entries) {
    const std::size_t at = text.find("'" + entry.name + "'");
    if (at >= first) continue;
    first = at;
    line = entry.line;
  }
  return line;
}

/// Whether the network has a module that applies these walls to the arm.
bool brings(const ArmSetup& setup, network::Walls walls) {
  const auto& modules = setup.network.modules;
  return std::any_of(modules.begin(), modules.end(),
                     [&](const Module& m) { return m.walls == walls; });
}

/// The names of the modules at the right port of module `i`.
std::vector<std::string> right_of(const std::vector<Module>& modules, std::size_t i) {
  if (!modules[i].to.next) return modules[i].to.names;
  if (i + 1 == modules.size()) return {};
  return {modules[i + 1].name};
}

/// The names of all modules that are joined to `from` without passing `line`; without `line`.
std::set<std::string> joined_to(const std::vector<Module>& modules, const std::string& from,
                                const std::string& line) {
  std::set<std::string> found{from};
  for (std::size_t before = 0; before != found.size();) {
    before = found.size();
    for (std::size_t i = 0; i < modules.size(); ++i) {
      for (const std::string& name : right_of(modules, i)) {
        if (name == line || modules[i].name == line) continue;
        if (found.contains(name)) found.insert(modules[i].name);
        if (found.contains(modules[i].name)) found.insert(name);
      }
    }
  }
  return found;
}

/// The module at which a network is cut. @throws SetupError if there is not exactly one line of
/// waves
const Module& line_of(const Scene& scene, const ArmSetup& setup) {
  const auto& modules = setup.network.modules;
  const auto is_line = [](const Module& module) { return module.kind == "line"; };
  const auto count = std::count_if(modules.begin(), modules.end(), is_line);
  if (count != 1) {
    throw SetupError("network: it has " + std::to_string(count) +
                         " modules 'line'; allowed for two programs: one, where it is cut",
                     scene.file);
  }
  const Module& line = *std::find_if(modules.begin(), modules.end(), is_line);
  const auto* options = std::any_cast<network::LineOptions>(&line.options);
  if (options == nullptr || options->kind != network::LineKind::waves) {
    throw SetupError("network: the line '" + line.name +
                         "' sends force and velocity, which is not passive; allowed for two "
                         "programs: waves",
                     scene.file, line.line);
  }
  return line;
}

/// What the operator of the scene can ask of the robot over its line: with the motors of the master
/// and through the coupling. Where there is no coupling, that of its defaults stands for it.
network::LineBounds bounds_of(const Scene& scene, const ArmSetup& setup) {
  network::LineBounds bounds;
  bounds.speed = scene.tool_speed;
  bounds.turning = fastest_turning;
  bounds.force = bounds.torque = 0.0;
  bool has_coupling = false;
  const auto couple = [&](const network::Kbb2Options& coupling) {
    bounds.force = std::max(bounds.force, coupling.force_limit);
    bounds.torque = std::max(bounds.torque, coupling.torque_limit);
    has_coupling = true;
  };
  for (const Module& module : setup.network.modules) {
    if (const auto* own = std::any_cast<network::Kbb2Options>(&module.options)) couple(*own);
    if (const auto* own = std::any_cast<network::TorqueArmOptions>(&module.options)) {
      bounds.hand_force = own->torque_limit;
      bounds.hand = own->hand;
    }
    if (const auto* own = std::any_cast<network::MultiplexOptions>(&module.options)) {
      bounds.motion_scale = own->velocity_scale;
      bounds.force_scale = own->force_scale;
    }
    if (const auto* own = std::any_cast<network::SixAxesOptions>(&module.options)) {
      bounds.hand_force = own->force_limit;
      bounds.hand_torque = own->torque_limit;
      bounds.motion_scale = bounds.force_scale = own->motion_scale;
      bounds.hand = own->hand;
    }
  }
  if (!has_coupling) couple({});
  return bounds;
}

network::Plan planned(const std::vector<Module>& modules, const ArmModel& arm) {
  network::Plan plan;
  for (const Module& module : modules) plan.add(module.name, module.make(arm), module.to);
  return plan;
}

void require_modules(const Scene& scene, const ArmSetup& setup) {
  if (!(scene.obstacles.empty() && scene.partners.empty()) &&
      !brings(setup, network::Walls::tool)) {
    throw SetupError("network: there are obstacles and no module 'obstacle' through which they act",
                     scene.file, setup.network.line);
  }
  const auto& links = setup.robot.links;
  if (links && !links->empty() && !feels_links(setup)) {
    throw SetupError(
        "robot: there are links to keep off the obstacles and no module 'arm_obstacle' in the "
        "network through which they feel them",
        scene.file, setup.network.line);
  }
}

}  // namespace

bool feels_links(const ArmSetup& setup) {
  return brings(setup, network::Walls::links);
}

network::Plan plan_network(const Scene& scene, const ArmSetup& setup, const ArmModel& arm) {
  require_modules(scene, setup);
  try {
    return planned(setup.network.modules, arm);
  } catch (const SetupError& error) {
    if (!error.file().empty()) throw;  // a value of the file that does not suit this arm
    throw located(scene, SetupError(std::string("network: ") + error.what()));
  }
}

network::Plan plan_network(std::string_view list, const ArmModel& arm) {
  const Value value = Value::document(list, "");
  return planned(detail::network_of(&value, ModuleKinds()).modules, arm);
}

network::Plan plan_half(const Scene& scene, const ArmSetup& setup, const ArmModel& arm,
                        const NetworkHalf& half) {
  require_modules(scene, setup);
  const auto& modules = setup.network.modules;
  const Module& line = line_of(scene, setup);
  const auto at = static_cast<std::size_t>(&line - modules.data());
  const auto& options = *std::any_cast<network::LineOptions>(&line.options);
  const std::vector<std::string> beyond = right_of(modules, at);
  const std::set<std::string> of_site =
      joined_to(modules, beyond.empty() ? line.name : beyond.front(), line.name);
  network::Plan plan;
  const auto add_end = [&](const network::To& to) {
    plan.add(line.name,
             network::RemoteLine(*half.link, {options.impedance, options.angular_impedance,
                                              bounds_of(scene, setup), half.is_station}),
             to);
  };
  if (!half.is_station) add_end(beyond);
  for (std::size_t i = 0; i < modules.size(); ++i) {
    if (i == at || of_site.contains(modules[i].name) == half.is_station) continue;
    const std::vector<std::string> right = right_of(modules, i);
    const bool crosses =
        of_site.contains(modules[i].name) && std::count(right.begin(), right.end(), line.name) != 0;
    if (crosses) {
      throw SetupError("network: the line '" + line.name +
                           "' does not divide it: there is another way from one side to the other; "
                           "allowed for two programs: none",
                       scene.file, line.line);
    }
    plan.add(modules[i].name, modules[i].make(arm), right);
  }
  if (half.is_station) add_end(std::vector<std::string>{});
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
  int line = what.starts_with("wall too stiff: ") ? line_of_named(scene.obstacles, what) : 0;
  for (std::size_t i = 0; i <= scene.partners.size() && line == 0; ++i) {
    if (what.starts_with("network: "))
      line = line_of_named(scene.arm_setup(i).network.modules, what);
  }
  return SetupError(what, scene.file, line);
}

}  // namespace repel::scene
