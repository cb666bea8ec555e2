// SPDX-License-Identifier: BSD-3-Clause
#include "obstacle_reader.hpp"

#include <map>
#include <set>

#include "grammar.hpp"
#include "pose_reader.hpp"

namespace repel::scene::detail {
namespace {

/// Each has a pair with every other one.
constexpr std::size_t most_loose = 200;
/// Each may have as many parts and meshes as a robot.
constexpr std::size_t most_models = 64;
const std::map<std::string_view, ModelFormat> model_formats{
    {"urdf", ModelFormat::urdf}, {"sdf", ModelFormat::sdf}, {"mjcf", ModelFormat::mjcf}};

ForceLaw law_of(const Value& value) {
  const Map map(value, grammar::law());
  ForceLaw law;
  map.read("passable", law.passable);
  if (!law.passable) map.refuse({"depth", "plateau"});
  map.read("given_at", law.given_at);
  map.read("hold", law.hold);
  map.read("range", law.range);
  map.read("surface_force", law.surface_force);
  const Value* damping = map.find("damping");
  law.damping_may_rise = damping == nullptr || damping->text() == "auto";
  law.damping_is_meant = !law.damping_may_rise;
  if (law.damping_is_meant) law.damping = map.number("damping");
  map.read("ceiling", law.ceiling);
  map.read("depth", law.depth);
  map.read("tilt", law.tilt);
  map.read("plateau", law.plateau);
  return value.located([&] { return checked(law); });
}

std::optional<ReciprocatingMotion> motion_of(const Map& obstacle) {
  const Value* value = obstacle.find("motion");
  if (!value) return {};
  const Map map(*value, grammar::motion());
  return ReciprocatingMotion{map.vector("along"), map.number("duration")};
}

StaticModel model_of(const Map& map, ModelFormat format, const Laws& laws) {
  map.refuse({"motion", "size", "radius", "length", "points", "parts"});
  StaticModel model;
  model.name = map.at("name").text();
  model.format = format;
  if (format == ModelFormat::mjcf) map.refuse({"packages", "covers"});
  model.file = map.at("file").path();
  if (const Value* packages = map.find("packages")) model.packages = packages->folders();
  map.read("covers", model.covers);
  model.X_WM = pose_of(map);
  model.law = law_called(laws, map);
  model.paint = paint_of(map);
  return model;
}

}  // namespace

Laws laws_of(const Map& scene) {
  Laws laws{{"default", {.damping_may_rise = true}}};
  if (const Value* value = scene.find("laws")) {
    const Map map(*value);
    for (const auto& [name, law] : map.entries()) laws[name] = law_of(law);
  }
  return laws;
}

const ForceLaw& law_called(const Laws& laws, const Map& map, std::string_view key) {
  const Value* name = map.find(key);
  const auto found = laws.find(name ? name->text() : "default");
  if (found != laws.end()) return found->second;
  std::string defined;
  for (const auto& [known, law] : laws) {
    if (defined.size() > 500) {
      defined += ", and more";
      break;
    }
    defined += (defined.empty() ? "" : ", ") + known;
  }
  map.at(key).fail_with_value("a law under 'laws': " + defined);
}

std::vector<Obstacle> obstacles_of(const Value& value, const Laws& laws, const ShapeFile& shapes,
                                   std::vector<StaticModel>& models) {
  std::vector<Obstacle> obstacles;
  std::set<std::string> names;
  for (const Value& entry : value.list()) {
    const Map map(entry, grammar::obstacle());
    const std::string_view kind = map.find("shape") == nullptr ? "" : map.word("shape");
    if (const auto format = model_formats.find(kind); format != model_formats.end()) {
      if (models.size() == most_models) {
        entry.fail("more than " + std::to_string(most_models) +
                   " obstacles of shape urdf, sdf or mjcf");
      }
      models.push_back(model_of(map, format->second, laws));
      require_new(names, map);
      continue;
    }
    for (Part& part : parts_of(entry, map, shapes)) {
      obstacles.push_back({std::move(part.name), std::move(part.shape), std::move(part.kind),
                           part.X_BP, law_called(laws, map), motion_of(map), std::move(part.shown),
                           entry.line()});
    }
    require_new(names, map);
  }
  return obstacles;
}

std::vector<LoosePart> loose_of(const Map& scene, const Laws& laws, const ShapeFile& shapes) {
  std::vector<LoosePart> loose;
  const Value* value = scene.find("loose");
  if (!value) return loose;
  std::set<std::string> names;
  for (const Value& entry : value->list(most_loose)) {
    const Map map(entry, grammar::loose());
    std::vector<Part> parts = parts_of(entry, map, shapes);
    require_new(names, map);
    if (parts.size() > 1) {
      map.at("file").fail("a mesh of " + std::to_string(parts.size()) +
                          " convex parts; allowed: one of 1, for what can come and go");
    }
    LoosePart& part = loose.emplace_back();
    part.name = map.at("name").text();
    part.shape = std::move(parts.front().shape);
    part.kind = std::move(parts.front().kind);
    part.X_WP = parts.front().X_BP;
    part.shown = std::move(parts.front().shown);
    part.law = law_called(laws, map);
    map.read("at_start", part.at_start);
    map.read("mass", part.mass);
    map.read("known", part.is_mass_known);
  }
  return loose;
}

SpareParts spare_of(const Map& scene, const Laws& laws) {
  SpareParts spare;
  const Value* value = scene.find("spare");
  if (!value) return spare;
  const Map map(*value, grammar::spare());
  spare.count = static_cast<int>(map.integer("count"));
  map.read("room", spare.room);
  spare.law = law_called(laws, map);
  return spare;
}

std::vector<HiddenPart> hidden_of(const Map& scene, const ShapeFile& shapes, bool has_camera) {
  std::vector<HiddenPart> hidden;
  const Value* value = scene.find("hidden");
  if (!value) return hidden;
  if (!has_camera) {
    value->fail("'hidden' without 'camera'; allowed: a scene with a camera, which sees it");
  }
  std::set<std::string> names;
  for (const Value& entry : value->list()) {
    const Map map(entry, grammar::hidden());
    for (Part& part : parts_of(entry, map, shapes)) {
      hidden.push_back({std::move(part.name), std::move(part.shape), part.X_BP, motion_of(map)});
    }
    require_new(names, map);
  }
  return hidden;
}

}  // namespace repel::scene::detail
