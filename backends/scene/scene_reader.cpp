// SPDX-License-Identifier: BSD-3-Clause
#include <repel/scene/scene.hpp>

#include <algorithm>
#include <any>
#include <filesystem>
#include <set>

#include <repel/base/capacities.hpp>
#include <repel/common/text_file.hpp>
#include <repel/network/elements/line.hpp>

#include "camera_reader.hpp"
#include "grammar.hpp"
#include "network_reader.hpp"
#include "obstacle_reader.hpp"
#include "robot_reader.hpp"
#include "script_reader.hpp"
#include "shape_reader.hpp"
#include "yaml.hpp"

namespace repel::scene {
namespace {

/// Context shared by all arm setups of a file.
struct Shared {
  const detail::Laws& laws;
  const ModuleKinds& kinds;
  detail::ShapeFile shapes;
  const Scene& scene;  ///< with what can come and go, and cameras
};

void read_station(const Map& map, const Shared& shared, ArmSetup& setup) {
  setup.robot = detail::robot_of(map.at("robot"), shared.laws);
  setup.tool = detail::tool_of(map.at("tool"), shared.shapes);
  setup.network = detail::network_of(map.find("network"), shared.kinds);
  detail::read_script(map, shared.scene.loose, shared.scene.cameras, setup);
}

std::vector<OtherArm> partners_of(const Map& scene, const Shared& shared) {
  std::vector<OtherArm> partners;
  const Value* value = scene.find("partners");
  if (!value) return partners;
  std::set<std::string> names;
  for (const Value& entry : value->list(static_cast<std::size_t>(Capacities{}.bodies))) {
    const Map map(entry, grammar::partner());
    OtherArm& partner = partners.emplace_back();
    partner.name = map.at("name").text();
    require_new(names, map);
    partner.law = detail::law_called(shared.laws, map);
    read_station(map, shared, partner);
  }
  return partners;
}

void read_measure(const Map& map, Scene& scene) {
  if (map.find("measure") != nullptr) scene.measure = *measure_named(map.word("measure"));
  map.read("levels", scene.levels);
}

Budget budget_of(const Map& scene) {
  Budget budget;
  const Value* value = scene.find("budget");
  if (!value) return budget;
  const Map map(*value, grammar::budget());
  if (map.find("wall") != nullptr) budget.wall_us = 1e6 * map.number("wall");
  map.read("work", budget.work_units);
  map.read("threads", budget.threads);
  map.read("max_age", budget.max_age);
  return budget;
}

/// Whether the scene is to be run as two programs.
bool apart_of(const Value& value, const Scene& scene) {
  if (!value.boolean()) return false;
  const std::vector<Module>& modules = scene.network.modules;
  const bool has_line = std::any_of(modules.begin(), modules.end(), [](const Module& module) {
    return std::any_cast<network::LineOptions>(&module.options) != nullptr;
  });
  if (!has_line) value.fail("two programs need a module 'line' in the network, to part it there");
  if (!scene.partners.empty()) value.fail("'apart' beside 'partners'; allowed: one arm");
  return true;
}

Scene scene_of(const Value& document, const std::string& file, const ModuleKinds& kinds) {
  const Map map(document, grammar::scene());
  Scene scene;
  scene.file = file;
  scene.name = std::filesystem::path(file).stem().string();
  map.read("name", scene.name);
  map.read("tool_speed", scene.tool_speed);
  map.read("start_inside", scene.start_inside);
  map.read("rate", scene.rate_hz);
  read_measure(map, scene);
  const detail::Laws laws = detail::laws_of(map);
  std::size_t hull_points = 0;
  const detail::ShapeFile shapes{hull_points, scene.part_lists};
  scene.loose = detail::loose_of(map, laws, shapes);
  scene.spare = detail::spare_of(map, laws);
  scene.cameras = detail::cameras_of(map, laws);
  scene.hidden = detail::hidden_of(map, shapes, !scene.cameras.empty());
  if (!scene.cameras.empty() && scene.spare.count > 0) {
    map.at("spare").fail("'spare' beside a camera; allowed: one of the two");
  }
  const Shared shared{laws, kinds, shapes, scene};
  read_station(map, shared, scene);
  scene.obstacles = detail::obstacles_of(map.at("obstacles"), laws, shapes, scene.models);
  scene.partners = partners_of(map, shared);
  if (const Value* apart = map.find("apart")) scene.apart = apart_of(*apart, scene);
  scene.budget = budget_of(map);
  map.read("coprocessor", scene.coprocessor);
  if (map.find("coprocessor") != nullptr) {
    // Whoever names it wants it; how many threads it has may still be said.
    const bool has_threads =
        map.find("budget") != nullptr && Map(*map.find("budget")).find("threads");
    if (!has_threads) scene.budget.threads = 1;
  }
  return scene;
}

/// The error with the changes behind it: the line that it names is not as in the file.
SetupError with_changes(const SetupError& error, const std::vector<Change>& changes) {
  std::string what = error.what();
  if (!error.file().empty()) what.erase(0, what.find(": ", error.file().size()) + 2);
  what += " (with";
  for (const Change& change : changes) {
    what.append(&change == changes.data() ? " " : ", ").append(change.path).append(" set to '");
    what.append(change.value).append("'");
  }
  return SetupError(what + ")", error.file(), error.line());
}

}  // namespace

Scene parse(std::string_view yaml, const std::string& file, const ModuleKinds& kinds,
            std::vector<Change> changes) {
  try {
    Scene scene = scene_of(Value::document(yaml, file, changes), file, kinds);
    scene.changes = std::move(changes);
    return scene;
  } catch (const SetupError& error) {
    if (changes.empty()) throw;
    throw with_changes(error, changes);
  }
}

Scene load(const std::string& path, const ModuleKinds& kinds, std::vector<Change> changes) {
  return parse(text_of_file(path, "a scene file"), path, kinds, std::move(changes));
}

void is_built_for(EigenAlignmentHere /*alignment*/, VectorRegisterHere /*size*/) noexcept {}

}  // namespace repel::scene
