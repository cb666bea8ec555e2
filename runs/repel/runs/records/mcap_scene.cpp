// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/records/mcap_scene.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <repel/base/setup_error.hpp>
#include <repel/reduction/shape_mesh.hpp>
#include <repel/runs/records/mcap_time.hpp>

namespace repel::runs::mcap {
namespace {

using Entry = nlohmann::json;

/// A JSON Schema of an object.
Entry object_of(const std::vector<std::pair<const char*, Entry>>& fields) {
  Entry properties = Entry::object();
  for (const auto& [name, schema] : fields) properties[name] = schema;
  return {{"type", "object"}, {"properties", std::move(properties)}};
}

/// A JSON Schema of an array.
Entry list_of(const Entry& items, const char* description) {
  return {{"type", "array"}, {"items", items}, {"description", description}};
}

struct Colour {
  double r = 0.0, g = 0.0, b = 0.0, a = 1.0;
};

// Those of the live view in daylight.
constexpr Colour tool_colour{0.29, 0.38, 0.47, 1.0};
constexpr Colour link_colour{0.76, 0.79, 0.82, 1.0};
constexpr Colour obstacle_colour{0.89, 0.85, 0.76, 1.0};
constexpr Colour passable_colour{0.5, 0.41, 0.76, 0.34};
constexpr Colour push_colour{0.85, 0.2, 0.15, 1.0};
constexpr Colour sum_colour{0.04, 0.38, 0.77, 1.0};

/// What is only drawn is rounded, which takes less room.
/// @param places decimal places of one: 1e6 for six
double rounded(double value, double places) {
  return std::round(value * places) / places;
}

Entry colour_json(const Colour& c) {
  return {{"r", c.r}, {"g", c.g}, {"b", c.b}, {"a", c.a}};
}

Entry xyz(const Vec3& p) {
  return {{"x", p.x()}, {"y", p.y()}, {"z", p.z()}};
}

Entry pose_json(const Vec3& p, const Eigen::Quaterniond& q) {
  return {{"position", xyz(p)},
          {"orientation", {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}}}};
}

/// An entity without any content. It stays until it is deleted.
Entry entity_json(const std::string& id, const std::string& frame, bool locked) {
  Entry entity{{"timestamp", time_json(0)}, {"frame_id", frame},      {"id", id},
               {"lifetime", time_json(0)},  {"frame_locked", locked}, {"metadata", Entry::array()}};
  for (const char* kind :
       {"arrows", "cubes", "spheres", "cylinders", "lines", "triangles", "texts", "models"}) {
    entity[kind] = Entry::array();
  }
  return entity;
}

void add_metadata(Entry& entity, const char* key, const std::string& value) {
  entity["metadata"].push_back({{"key", key}, {"value", value}});
}

/// An update that replaces everything of its topic: a viewer that jumps to a moment knows only the
/// last message before it.
Entry whole_update(std::uint64_t now_ns) {
  constexpr int all = 1;
  return {{"deletions", {{{"timestamp", time_json(now_ns)}, {"type", all}, {"id", ""}}}},
          {"entities", Entry::array()}};
}

const char* group_of(const Heading& heading, BodyId body) {
  for (const ArmHeading& arm : heading.arms) {
    if (arm.tool == body) return "tool";
    if (std::count(arm.links.begin(), arm.links.end(), body) > 0) return "link";
  }
  return "obstacle";
}

/// Whether everything that meets the part may enter it.
bool is_passable(const World& world, PartId part) {
  bool meets = false;
  for (const Pair& pair : world.pairs()) {
    if (pair.b != part) continue;
    if (!pair.law.passable) return false;
    meets = true;
  }
  return meets;
}

/// A colour with what the scene says of it.
Colour painted(Colour colour, const scene::Paint& paint) {
  if (paint.color) colour = {(*paint.color)[0], (*paint.color)[1], (*paint.color)[2], colour.a};
  if (paint.opacity) colour.a = *paint.opacity;
  return colour;
}

/// The coordinates to a micrometre, which is less than is seen.
Entry triangles_json(const Shape& shape, const Pose& X_BP, const Colour& colour) {
  const TriangleMesh mesh = mesh_of(shape);
  Entry points = Entry::array();
  Entry indices = Entry::array();
  for (const Vec3& p : mesh.vertices) {
    points.push_back(xyz({rounded(p.x(), 1e6), rounded(p.y(), 1e6), rounded(p.z(), 1e6)}));
  }
  for (const auto& triangle : mesh.triangles) {
    for (const int vertex : triangle) indices.push_back(vertex);
  }
  return {{"pose", pose_json(X_BP.translation(), Eigen::Quaterniond(X_BP.linear()))},
          {"points", std::move(points)},
          {"color", colour_json(colour)},
          {"colors", Entry::array()},
          {"indices", std::move(indices)}};
}

/// Red in contact, green at the end of the range of the law.
Colour distance_colour(double distance, double range) {
  const double share = range > 0.0 ? std::clamp(distance / range, 0.0, 1.0) : 1.0;
  return {rounded(std::min(1.0, 2.0 - 2.0 * share), 1e2), rounded(std::min(1.0, 2.0 * share), 1e2),
          0.1, 1.0};
}

/// @param shaft [m] its diameter
Entry arrow_json(const Vec3& at, const Vec3& direction, double length, double shaft,
                 const Colour& colour) {
  const double head = rounded(std::min(2.5 * shaft, 0.4 * length), 1e6);
  // From the x axis, by half the angle. Eigen's FromTwoVectors takes as long to compile as the
  // rest.
  const Vec3 unit = direction.normalized();
  Eigen::Quaterniond turned(1.0 + unit.x(), 0.0, -unit.z(), unit.y());
  if (turned.squaredNorm() < 1e-12) turned = Eigen::Quaterniond(0.0, 0.0, 0.0, 1.0);
  turned.normalize();
  for (double& each : turned.coeffs()) each = rounded(each, 1e6);
  return {{"pose", pose_json(at, turned)}, {"shaft_length", rounded(length - head, 1e6)},
          {"shaft_diameter", shaft},       {"head_length", head},
          {"head_diameter", 2.0 * shaft},  {"color", colour_json(colour)}};
}

Entry pair_json(const NearPair& near, const std::string& id, const std::string& frame, double range,
                const Entry& now) {
  const Separation& s = near.separation;
  Entry entity = entity_json(id, frame, false);
  entity["timestamp"] = now;
  add_metadata(entity, "distance_m", to_text(s.distance));
  add_metadata(entity, "force_n", to_text(near.force));
  constexpr int separate_segments = 2;
  entity["lines"].push_back({{"type", separate_segments},
                             {"pose", pose_json(Vec3::Zero(), Eigen::Quaterniond::Identity())},
                             {"thickness", 2.0},
                             {"scale_invariant", true},
                             {"points", {xyz(s.p_WA), xyz(s.p_WB)}},
                             {"color", colour_json(distance_colour(s.distance, range))},
                             {"colors", Entry::array()},
                             {"indices", Entry::array()}});
  if (near.force > 0.0) {
    entity["arrows"].push_back(
        arrow_json(s.p_WA, s.extraction_W, arrow_per_newton * near.force, 0.003, push_colour));
  }
  return entity;
}

}  // namespace

std::string scene_update_schema() {
  const Entry number{{"type", "number"}};
  const Entry integer{{"type", "integer"}};
  const Entry text{{"type", "string"}};
  const Entry yes_or_no{{"type", "boolean"}};
  const Entry time = object_of({{"sec", integer}, {"nsec", integer}});
  const Entry vector = object_of({{"x", number}, {"y", number}, {"z", number}});
  const Entry turn = object_of({{"x", number}, {"y", number}, {"z", number}, {"w", number}});
  const Entry pose = object_of({{"position", vector}, {"orientation", turn}});
  const Entry colour = object_of({{"r", number}, {"g", number}, {"b", number}, {"a", number}});
  const Entry nothing = list_of(object_of({}), "none");
  const Entry arrow = object_of({{"pose", pose},
                                 {"shaft_length", number},
                                 {"shaft_diameter", number},
                                 {"head_length", number},
                                 {"head_diameter", number},
                                 {"color", colour}});
  const Entry line = object_of({{"type", integer},
                                {"pose", pose},
                                {"thickness", number},
                                {"scale_invariant", yes_or_no},
                                {"points", list_of(vector, "witness points [m]")},
                                {"color", colour},
                                {"colors", list_of(colour, "none")},
                                {"indices", list_of(integer, "none")}});
  const Entry triangles = object_of({{"pose", pose},
                                     {"points", list_of(vector, "[m], to 1 um")},
                                     {"color", colour},
                                     {"colors", list_of(colour, "none")},
                                     {"indices", list_of(integer, "three for each triangle")}});
  const Entry pairs = object_of({{"key", text}, {"value", text}});
  const Entry entity =
      object_of({{"timestamp", time},
                 {"frame_id", text},
                 {"id", text},
                 {"lifetime", time},
                 {"frame_locked", yes_or_no},
                 {"metadata", list_of(pairs, "group, passable, distance_m [m], force_n [N]")},
                 {"arrows", list_of(arrow, "forces, 2 mm/N; sizes [m]")},
                 {"cubes", nothing},
                 {"spheres", nothing},
                 {"cylinders", nothing},
                 {"lines", list_of(line, "separations; thickness [pixels]")},
                 {"triangles", list_of(triangles, "surfaces")},
                 {"texts", nothing},
                 {"models", nothing}});
  const Entry deletion = object_of({{"timestamp", time}, {"type", integer}, {"id", text}});
  Entry schema = object_of({{"deletions", list_of(deletion, "of type 1: all of this channel")},
                            {"entities", list_of(entity, "what is to be drawn from now on")}});
  schema["title"] = "foxglove.SceneUpdate";
  return schema.dump();
}

std::vector<std::string> told_apart(const std::vector<std::string>& names) {
  std::set<std::string> taken(names.begin(), names.end());
  std::map<std::string, int> counts;
  std::vector<std::string> apart;
  for (const std::string& name : names) {
    int& count = ++counts[name];
    std::string own = name;
    // What a number makes may be the name of another.
    for (; count > 1 && taken.contains(own); ++count) own = name + " #" + std::to_string(count);
    if (count > 1) --count;
    taken.insert(own);
    apart.push_back(std::move(own));
  }
  return apart;
}

std::vector<std::string> frames_of(const Heading& heading) {
  std::vector<std::string> names = heading.bodies;
  names.insert(names.end(), heading.cameras.begin(), heading.cameras.end());
  return told_apart(names);
}

Bodies::Bodies(const World& world, const Heading& heading, const std::vector<scene::Shown>& shown) {
  const std::vector<std::string> frames = frames_of(heading);
  std::vector<std::string> names;
  for (const Part& part : world.parts()) names.push_back(part.name);
  const std::vector<std::string> ids = told_apart(names);
  for (std::size_t i = 0; i < world.parts().size(); ++i) {
    const Part& part = world.parts()[i];
    const auto body = static_cast<std::size_t>(part.body.index);
    const char* group = group_of(heading, part.body);
    const bool passable = is_passable(world, {static_cast<std::int32_t>(i)});
    Colour colour = group == std::string("tool") ? tool_colour : link_colour;
    if (group == std::string("obstacle")) colour = passable ? passable_colour : obstacle_colour;
    if (i < shown.size()) colour = painted(colour, shown[i].paint);
    Entry entity = entity_json(ids[i], frames[body], true);
    add_metadata(entity, "group", group);
    add_metadata(entity, "passable", passable ? "yes" : "no");
    entity["triangles"].push_back(triangles_json(part.shape, part.X_BP, colour));
    entities_.push_back({body, std::move(entity)});
  }
}

void Bodies::follow(const Snapshot& tick, const std::vector<NewShape>& reshaped) {
  for (const NewShape& each : reshaped) {
    waiting_.insert_or_assign(each.part.index, each.shape);
  }
  has_changed_ = has_changed_ || there_ != tick.is_there;
  there_ = tick.is_there;
  for (auto it = waiting_.begin(); it != waiting_.end();) {
    Entity& entity = entities_[static_cast<std::size_t>(it->first)];
    if (there_[entity.body] != 0) {
      ++it;
      continue;
    }
    Entry& drawn = entity.json["triangles"][0];
    Entry colour = std::move(drawn["color"]);
    drawn = triangles_json(it->second, Pose::Identity(), {});
    drawn["color"] = std::move(colour);
    it = waiting_.erase(it);
  }
}

std::optional<nlohmann::json> Bodies::update(const Snapshot& tick, std::uint64_t now_ns) {
  if (!std::exchange(has_changed_, false)) return std::nullopt;
  nlohmann::json update = whole_update(now_ns);
  for (Entity& entity : entities_) {
    if (tick.is_there[entity.body] == 0) continue;
    entity.json["timestamp"] = time_json(now_ns);
    update["entities"].push_back(entity.json);
  }
  return update;
}

Contacts::Contacts(const World& world, const Heading& heading)
    : world_(heading.bodies.front()), pairs_(told_apart(heading.pairs)) {
  const std::vector<std::string> frames = frames_of(heading);
  for (const ArmHeading& arm : heading.arms) {
    sums_.push_back("force on " + frames[static_cast<std::size_t>(arm.tool.index)]);
  }
  for (const Pair& pair : world.pairs()) ranges_.push_back(pair.law.range);
}

nlohmann::json Contacts::update(const Snapshot& tick, std::uint64_t now_ns) const {
  const Entry now = time_json(now_ns);
  nlohmann::json update = whole_update(now_ns);
  nlohmann::json& entities = update["entities"];
  for (const NearPair& near : tick.near()) {
    const auto i = static_cast<std::size_t>(near.pair.index);
    entities.push_back(pair_json(near, pairs_[i], world_, ranges_[i], now));
  }
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const Vec3& force = tick.arms[i].virtual_force.force;
    const double size = force.norm();
    if (!(size > 0.0) || !std::isfinite(size)) continue;
    Entry entity = entity_json(sums_[i], world_, false);
    entity["timestamp"] = now;
    add_metadata(entity, "force_n", to_text(size));
    entity["arrows"].push_back(
        arrow_json(tick.arms[i].p_WT, force / size, arrow_per_newton * size, 0.009, sum_colour));
    entities.push_back(std::move(entity));
  }
  return update;
}

}  // namespace repel::runs::mcap
