// SPDX-License-Identifier: BSD-3-Clause
#include <repel/scene/scene.hpp>

#include <algorithm>
#include <any>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include <repel/base/capacities.hpp>
#include <repel/base/setup_error.hpp>
#include <repel/common/text_file.hpp>
#include <repel/network/elements/changing_scale.hpp>
#include <repel/network/elements/line.hpp>
#include <repel/reduction/shape.hpp>
#include <repel/scene/part_list.hpp>

#include "camera_reader.hpp"
#include "guiding_reader.hpp"
#include "network_reader.hpp"
#include "pose_reader.hpp"
#include "yaml.hpp"

namespace repel::scene {
namespace {

using detail::angles;
using detail::pose_of;
using detail::position;

constexpr Rule extent{unit::length, 0.0, Shape::largest};

constexpr std::array<std::string_view, 9> obstacle_shapes{
    "box", "sphere", "capsule", "cylinder", "cone", "hull", "mesh", "urdf", "sdf"};
constexpr std::size_t part_shapes = 7;  // so many of them are shapes of tools too

using Laws = std::map<std::string, ForceLaw>;

/// Each has a pair with every other one.
constexpr std::size_t most_loose = 200;
/// Each may have as many parts and meshes as a robot.
constexpr std::size_t most_models = 64;

/// Limits the total number of hull points in a scene, since each costs time in the reduction.
class HullPoints {
 public:
  /// @param where the error is, if there are too many
  void add(const Value& where, std::size_t points) {
    sum_ += points;
    if (sum_ <= input_limits.hull_points) return;
    where.fail("the hulls of the scene up to this one have " + std::to_string(sum_) +
               " points; allowed: up to " + std::to_string(input_limits.hull_points) + " in all");
  }

 private:
  std::size_t sum_ = 0;
};

Pose pose_at(const Map& parent, std::string_view key) {
  const Value* value = parent.find(key);
  if (!value) return Pose::Identity();
  const Map map(*value);
  map.allow({"position", "rpy"});
  return pose_of(map);
}

/// The size keys of a shape of this kind.
std::vector<std::string_view> size_keys(std::string_view kind) {
  if (kind == "box") return {"size"};
  if (kind == "sphere") return {"radius"};
  if (kind == "hull") return {"points"};
  if (kind == "mesh") return {"file", "parts"};
  return {"radius", "length"};
}

/// With as few levels as possible: whoever needs more reduces it again.
Shape shape_of(const Map& map, std::string_view kind, HullPoints& counted) {
  constexpr ReductionOptions coarse{.levels = 1};
  if (kind == "box") return Shape::box(0.5 * map.at("size").vector(extent), coarse);
  if (kind == "hull") {
    const Value& list = map.at("points");
    std::vector<Vec3> points;
    for (const Value& point : list.list(input_limits.values)) {
      points.push_back(point.vector(position));
    }
    // A single hull that is too large is refused by the shape itself.
    if (points.size() <= input_limits.entries) counted.add(list, points.size());
    return Shape::hull(points, coarse);
  }
  const double radius = map.at("radius").number(extent);
  if (kind == "sphere") return Shape::sphere(radius, coarse);
  const double half_length = 0.5 * map.at("length").number(extent);
  if (kind == "capsule") return Shape::capsule(radius, half_length, coarse);
  if (kind == "cone") return Shape::cone(radius, half_length, coarse);
  if (kind == "cylinder") return Shape::cylinder(radius, half_length, coarse);
  map.at("shape").fail_with_value("a shape that is made of sizes");
}

/// The path of an existing file, relative to the scene's `file`.
std::string path_of(const Value& value, const std::string& file) {
  const auto path = std::filesystem::path(file).parent_path() / value.text();
  std::error_code unused;
  if (!std::filesystem::is_regular_file(path, unused)) {
    value.fail_with_value("a file; there is none at " + path.lexically_normal().string());
  }
  return path.lexically_normal().string();
}

/// Context of the shapes of a file.
struct ShapeFile {
  const std::string& file;
  HullPoints& counted;
  std::vector<std::string>& part_lists;
};

/// part_list_of(), with the line of `mesh` for what is wrong of the list as a whole.
PartList checked_list(const Value& mesh, const std::string& mesh_path, const std::string& path) {
  try {
    return part_list_of(mesh_path, path);
  } catch (const SetupError& error) {
    if (error.line() > 0) throw;
    mesh.fail(error.what());
  }
}

/// The convex parts of a mesh, from the list that `parts` names or that lies beside the mesh.
std::vector<Part> parts_of_mesh(const Map& map, const ShapeFile& shapes) {
  const Value& mesh = map.at("file");
  const std::string mesh_path = path_of(mesh, shapes.file);
  const Value* const named = map.find("parts");
  const bool is_beside = named == nullptr || named->text() == "auto";
  const std::string path = is_beside ? part_list_beside(mesh_path) : path_of(*named, shapes.file);
  std::error_code unused;
  if (!std::filesystem::is_regular_file(path, unused)) {
    mesh.fail("the mesh '" + mesh_path + "' has no convex parts yet: there is no file '" + path +
              "'; to have it: cover '" + mesh_path + "'");
  }
  const PartList list = checked_list(mesh, mesh_path, path);
  shapes.part_lists.push_back(path);
  std::vector<Part> parts;
  for (const std::vector<Vec3>& points : list.parts) {
    shapes.counted.add(mesh, points.size());
    std::string name = map.at("name").text();
    name.append(1, '/').append(std::to_string(parts.size() + 1));
    try {
      parts.push_back({name, Shape::hull(points, {.levels = 1}), "hull", pose_of(map), {}});
    } catch (const SetupError& error) {
      std::string text = name;
      mesh.fail(text.append(" in '").append(path).append("': ").append(error.what()));
    }
  }
  parts.front().gaps = list.gaps;
  return parts;
}

/// Reads the keys common to tool parts and obstacles: one part, or those of a mesh.
/// @param keys further keys that are allowed
std::vector<Part> parts_of(const Value& value, const Map& map,
                           std::span<const std::string_view> keys, const ShapeFile& shapes) {
  std::vector<std::string_view> common{"name", "shape", "position", "rpy"};
  common.insert(common.end(), keys.begin(), keys.end());
  auto any = common;
  any.insert(any.end(), {"size", "radius", "length", "points", "file", "parts"});
  map.allow(any);
  const std::string name = map.at("name").text();
  const std::string kind = map.at("shape").word_of(std::span(obstacle_shapes).first<part_shapes>());
  const auto sizes = size_keys(kind);
  common.insert(common.end(), sizes.begin(), sizes.end());
  map.allow(common);
  if (kind == "mesh") return parts_of_mesh(map, shapes);
  try {
    return {{name, shape_of(map, kind, shapes.counted), kind, pose_of(map), {}}};
  } catch (const SetupError& error) {
    if (error.line() > 0) throw;
    value.fail(kind + " '" + name + "': " + error.what());
  }
}

/// @throws SetupError if `name` is already in use
void require_new(std::set<std::string>& names, const Map& map) {
  const Value& name = map.at("name");
  if (!names.insert(name.text()).second) name.fail_with_value("a name no other entry has");
}

std::vector<Part> tool_of(const Value& value, const ShapeFile& shapes) {
  std::vector<Part> parts;
  std::set<std::string> names;
  for (const Value& entry : value.list()) {
    const Map map(entry);
    for (Part& part : parts_of(entry, map, {}, shapes)) parts.push_back(std::move(part));
    require_new(names, map);
  }
  if (parts.empty()) value.fail("'tool' has no part; allowed: 1 or more");
  return parts;
}

ForceLaw law_of(const Value& value) {
  const Map map(value);
  map.allow({"range", "surface_force", "damping", "ceiling", "given_at", "tilt", "hold", "passable",
             "depth", "plateau"});
  ForceLaw law;
  if (const Value* passable = map.find("passable")) {
    law.passable = passable->word_of({"yes", "no"}) == "yes";
  }
  if (!law.passable) {
    map.allow(
        {"range", "surface_force", "damping", "ceiling", "given_at", "tilt", "hold", "passable"});
  }
  if (const Value* at = map.find("given_at")) {
    law.given_at = at->word_of({"part", "tool"}) == "tool" ? GivenAt::tool : GivenAt::part;
  }
  if (const Value* hold = map.find("hold")) {
    law.hold = hold->word_of({"hard", "soft"}) == "hard" ? HoldKind::hard : HoldKind::soft;
  }
  map.read("range", {unit::length, 1e-6, 1e3}, law.range);
  map.read("surface_force", {unit::force, 0.0, 1e6}, law.surface_force);
  const Value* damping = map.find("damping");
  law.damping_may_rise = damping == nullptr || damping->text() == "auto";
  law.damping_is_meant = !law.damping_may_rise;
  if (law.damping_is_meant) {
    law.damping = damping->number({.units = unit::damping, .high = 1e6, .may_be_auto = true});
  }
  map.read("ceiling", {unit::force, 0.0, 1e6}, law.ceiling);
  map.read("depth", {unit::length, 0.0, 1e6}, law.depth);
  map.read("tilt", {unit::angle, 0.0, ForceLaw::most_tilt}, law.tilt);
  map.read("plateau", {unit::none, 0.0, 1.0}, law.plateau);
  try {
    return checked(law);
  } catch (const SetupError& error) {
    value.fail(error.what());
  }
}

Laws laws_of(const Map& scene) {
  Laws laws{{"default", {.damping_may_rise = true}}};
  if (const Value* value = scene.find("laws")) {
    const Map map(*value);
    for (const auto& [name, law] : map.entries()) laws[name] = law_of(law);
  }
  return laws;
}

const ForceLaw& law_called(const Laws& laws, const Map& map, std::string_view key = "law") {
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
  name->fail_with_value("a law under 'laws': " + defined);
}

std::optional<ReciprocatingMotion> motion_of(const Map& obstacle) {
  const Value* value = obstacle.find("motion");
  if (!value) return {};
  const Map map(*value);
  map.allow({"along", "duration"});
  return ReciprocatingMotion{map.at("along").vector(position),
                             map.at("duration").number({unit::time, 1e-3, 86400.0})};
}

/// The path of an existing folder, relative to the scene's `file`.
std::string folder_of(const Value& value, const std::string& file) {
  const auto path = std::filesystem::path(file).parent_path() / value.text();
  std::error_code unused;
  if (!std::filesystem::is_directory(path, unused)) {
    value.fail_with_value("a folder; there is none at " + path.lexically_normal().string());
  }
  return path.lexically_normal().string();
}

std::vector<std::string> packages_of(const Value& value, const std::string& file) {
  std::vector<std::string> folders;
  if (!value.is_list()) return {folder_of(value, file)};
  for (const Value& entry : value.list()) folders.push_back(folder_of(entry, file));
  return folders;
}

/// Whether meshes are to become the parts in the lists beside them.
bool takes_covers(const Map& map) {
  const Value* covers = map.find("covers");
  return covers == nullptr || covers->word_of({"yes", "no"}) == "yes";
}

StaticModel model_of(const Map& map, const Laws& laws, const std::string& file) {
  map.allow({"name", "shape", "position", "rpy", "law", "file", "packages", "covers"});
  StaticModel model;
  model.name = map.at("name").text();
  model.is_sdf = map.at("shape").text() == "sdf";
  model.file = path_of(map.at("file"), file);
  if (const Value* packages = map.find("packages")) model.packages = packages_of(*packages, file);
  model.covers = takes_covers(map);
  model.X_WM = pose_of(map);
  model.law = law_called(laws, map);
  return model;
}

/// @param models to which those among the obstacles are added
std::vector<Obstacle> obstacles_of(const Value& value, const Laws& laws, const ShapeFile& shapes,
                                   std::vector<StaticModel>& models) {
  constexpr std::string_view keys[] = {"law", "motion"};
  std::vector<Obstacle> obstacles;
  std::set<std::string> names;
  for (const Value& entry : value.list()) {
    const Map map(entry);
    const Value* const shape = map.find("shape");
    const std::string kind = shape == nullptr ? "" : shape->word_of(obstacle_shapes);
    if (kind == "urdf" || kind == "sdf") {
      if (models.size() == most_models) {
        entry.fail("more than " + std::to_string(most_models) + " obstacles of shape urdf or sdf");
      }
      models.push_back(model_of(map, laws, shapes.file));
      require_new(names, map);
      continue;
    }
    for (Part& part : parts_of(entry, map, keys, shapes)) {
      obstacles.push_back({std::move(part.name), std::move(part.shape), std::move(part.kind),
                           part.X_BP, law_called(laws, map), motion_of(map), std::move(part.gaps)});
    }
    require_new(names, map);
  }
  return obstacles;
}

std::vector<LoosePart> loose_of(const Map& scene, const Laws& laws, const ShapeFile& shapes) {
  std::vector<LoosePart> loose;
  const Value* value = scene.find("loose");
  if (!value) return loose;
  constexpr std::string_view keys[] = {"law", "at_start", "mass", "known"};
  std::set<std::string> names;
  for (const Value& entry : value->list(most_loose)) {
    const Map map(entry);
    std::vector<Part> parts = parts_of(entry, map, keys, shapes);
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
    part.gaps = std::move(parts.front().gaps);
    part.law = law_called(laws, map);
    if (const Value* there = map.find("at_start")) {
      part.at_start = there->word_of({"yes", "no"}) == "yes";
    }
    map.read("mass", {unit::mass, 0.0, Payload::heaviest}, part.mass);
    if (const Value* known = map.find("known")) {
      part.is_mass_known = known->word_of({"yes", "no"}) == "yes";
    }
  }
  return loose;
}

SpareParts spare_of(const Map& scene, const Laws& laws) {
  SpareParts spare;
  const Value* value = scene.find("spare");
  if (!value) return spare;
  const Map map(*value);
  map.allow({"count", "room", "law"});
  spare.count = static_cast<int>(map.at("count").integer(0, 50));
  map.read("room", {unit::length, 1e-3, 100.0}, spare.room);
  spare.law = law_called(laws, map);
  return spare;
}

constexpr std::size_t most_cameras = 8;
constexpr int most_seen = 2000;  // parts that are reserved for what all cameras see

/// What is wrong with the images of a camera.
void read_faults(const Map& map, CameraChoice& camera) {
  map.read("noise", {unit::length, 0.0, 0.1}, camera.noise);
  map.read("lost", {unit::none, 0.0, 1.0}, camera.lost);
  if (const Value* seed = map.find("seed")) {
    camera.seed = static_cast<std::uint64_t>(seed->integer(0, 1'000'000'000));
  }
}

/// The rays through the corners of the image, with z = 1.
std::array<Vec3, 4> corner_rays(const CameraChoice& camera) {
  double left = -std::tan(0.5 * camera.view);
  double right = -left;
  double top = left * camera.height / camera.width;
  double bottom = -top;
  if (camera.recording) {
    const RecordingChoice& from = *camera.recording;
    left = (-0.5 - from.cx) / from.fx;
    right = (camera.width - 0.5 - from.cx) / from.fx;
    top = (-0.5 - from.cy) / from.fy;
    bottom = (camera.height - 0.5 - from.cy) / from.fy;
  }
  return {{{left, top, 1.0}, {right, top, 1.0}, {left, bottom, 1.0}, {right, bottom, 1.0}}};
}

/// The map of a camera, in which all that it can see has a place.
std::optional<MapChoice> map_of(const Map& of_camera, const CameraChoice& camera) {
  const Value* const value = of_camera.find("map");
  if (value == nullptr) return {};
  const Map map(*value);
  map.allow({"cube", "keeps"});
  MapChoice choice;
  map.read("cube", {unit::length, 0.005, 1.0}, choice.cube);
  map.read("keeps", {unit::time, 0.0, 1e6}, choice.keeps);
  choice.low = choice.high = camera.X_WC.translation();
  for (const Vec3& ray : corner_rays(camera)) {
    const Vec3 corner = camera.X_WC * (camera.farthest * ray);
    choice.low = choice.low.cwiseMin(corner);
    choice.high = choice.high.cwiseMax(corner);
  }
  constexpr double most = 16e6;
  const double cubes = ((choice.high - choice.low) / choice.cube).array().ceil().prod();
  if (!(cubes <= most)) {
    value->fail("a map of all that the camera can see has " + to_text(cubes, 3) +
                " cubes; allowed: up to " + to_text(most) + ", by larger ones, or less 'farthest'");
  }
  if (camera.is_unseen_solid) {
    of_camera.at("unseen").fail(
        "what is unseen is solid beside 'map'; allowed: 'free', since the arm is in it");
  }
  return choice;
}

/// Where a simulated camera is and what its images are like.
void read_simulated(const Map& map, CameraChoice& camera) {
  camera.X_WC = detail::pose_of_camera(map);
  if (const Value* width = map.find("width")) {
    camera.width = static_cast<int>(width->integer(16, 1920));
  }
  if (const Value* height = map.find("height")) {
    camera.height = static_cast<int>(height->integer(16, 1080));
  }
  map.read("view", {unit::angle, 0.1, 2.6}, camera.view);
  map.read("rate", {unit::frequency, 0.1, most_camera_rate_hz}, camera.rate_hz);
  read_faults(map, camera);
}

/// The same of recorded images. @param file of the scene
void read_recorded(const Map& map, const std::string& file, CameraChoice& camera) {
  const Value& value = map.at("recording");
  try {
    camera.recording = detail::recording_of(folder_of(value, file), camera);
  } catch (const SetupError& error) {
    if (!error.file().empty()) throw;
    value.fail(error.what());
  }
  if (const Value* repeats = map.find("repeat")) {
    camera.recording->repeats = repeats->word_of({"yes", "no"}) == "yes";
  }
}

/// @param more keys beside those of the camera itself @param file of the scene
CameraChoice camera_of(const Value& value, const Laws& laws, const std::string& file,
                       std::initializer_list<std::string_view> more) {
  const Map map(value);
  const bool is_recorded = map.find("recording") != nullptr;
  std::vector<std::string_view> keys{"nearest", "farthest",     "latency", "unseen", "margin",
                                     "parts",   "silent_after", "law",     "map"};
  keys.insert(keys.end(), more);
  // What a recording says of itself the scene does not say.
  keys.emplace_back("recording");
  if (is_recorded) {
    keys.emplace_back("repeat");
  } else {
    keys.insert(keys.end(), {"position", "look_at", "orientation", "width", "height", "view",
                             "rate", "noise", "lost", "seed"});
  }
  map.allow(keys);
  CameraChoice camera;
  if (is_recorded) {
    read_recorded(map, file, camera);
  } else {
    read_simulated(map, camera);
  }
  map.read("nearest", {unit::length, 1e-3, 100.0}, camera.nearest);
  map.read("farthest", {unit::length, camera.nearest, 1000.0}, camera.farthest);
  map.read("latency", {unit::time, 0.0, 10.0}, camera.latency);
  if (const Value* unseen = map.find("unseen")) {
    camera.is_unseen_solid = unseen->word_of({"free", "solid"}) == "solid";
  }
  map.read("margin", {unit::length, 0.0, 1.0}, camera.margin);
  if (const Value* parts = map.find("parts")) {
    camera.parts = static_cast<int>(parts->integer(80, most_seen));
  }
  map.read("silent_after", {unit::time, 1e-3, 1e3}, camera.silent_after);
  if (!(camera.silent_after > camera.latency + 1.0 / camera.rate_hz)) {
    value.fail(
        "the camera would be silent between two images; allowed: silent_after above "
        "latency and 1 / rate together");
  }
  camera.law = law_called(laws, map);
  camera.map = map_of(map, camera);
  return camera;
}

/// The one of `camera`, or those of `cameras`.
std::vector<CameraChoice> cameras_of(const Map& scene, const Laws& laws, const std::string& file) {
  std::vector<CameraChoice> cameras;
  const Value* const only = scene.find("camera");
  if (only != nullptr) cameras.push_back(camera_of(*only, laws, file, {}));
  const Value* const all = scene.find("cameras");
  if (all == nullptr) return cameras;
  if (only != nullptr) all->fail("'cameras' beside 'camera'; allowed: one of the two");
  std::set<std::string> names;
  int parts = 0;
  for (const Value& entry : all->list(most_cameras)) {
    CameraChoice& camera = cameras.emplace_back(camera_of(entry, laws, file, {"name"}));
    const Map map(entry);
    const Value& name = map.at("name");
    camera.name = name.text();
    // `blind` takes them for something else.
    if (camera.name == "yes" || camera.name == "no") name.fail_with_value("another name");
    require_new(names, map);
    parts += camera.parts;
  }
  if (parts > most_seen) {
    all->fail("the cameras reserve " + std::to_string(parts) + " parts; allowed: up to " +
              std::to_string(most_seen) + " together");
  }
  return cameras;
}

/// What only the cameras see.
std::vector<HiddenPart> hidden_of(const Map& scene, const ShapeFile& shapes, bool has_camera) {
  std::vector<HiddenPart> hidden;
  const Value* value = scene.find("hidden");
  if (!value) return hidden;
  if (!has_camera) {
    value->fail("'hidden' without 'camera'; allowed: a scene with a camera, which sees it");
  }
  constexpr std::string_view keys[] = {"motion"};
  std::set<std::string> names;
  for (const Value& entry : value->list()) {
    const Map map(entry);
    for (Part& part : parts_of(entry, map, keys, shapes)) {
      hidden.push_back({std::move(part.name), std::move(part.shape), part.X_BP, motion_of(map)});
    }
    require_new(names, map);
  }
  return hidden;
}

/// Angles, or a list of angles and, for prismatic joints, lengths.
void read_start(const Value& value, RobotChoice& robot) {
  robot.start_line = value.line();
  const auto add = [&](const Value& entry, const Rule& rule, JointType type) {
    for (const double q : entry.numbers(rule, 1, 64)) {
      robot.start.push_back(q);
      robot.start_types.push_back(type);
    }
  };
  if (!value.is_list()) return add(value, angles, JointType::revolute);
  for (const Value& entry : value.list()) {
    if (quantity(entry.text(), unit::length)) {
      add(entry, position, JointType::prismatic);
    } else {
      add(entry, angles, JointType::revolute);
    }
  }
}

void read_payload(const Value& value, RobotChoice& robot) {
  constexpr double furthest = Payload::furthest;
  const Map map(value);
  map.allow({"mass", "position", "known"});
  robot.payload.mass = map.at("mass").number({unit::mass, 0.0, Payload::heaviest});
  map.read("position", {unit::length, -furthest, furthest}, robot.payload.p_TC);
  if (const Value* known = map.find("known")) {
    robot.payload_known = known->word_of({"yes", "no"}) == "yes";
  }
}

void read_admittance(const Value& value, AdmittanceOptions& admittance) {
  const Map map(value);
  map.allow({"response", "scale", "rest_time"});
  map.read("response", {unit::time, 0.01, 1.0}, admittance.response);
  map.read("scale", {unit::share, 1e-3, 1e3}, admittance.scale);
  map.read("rest_time", {unit::time, 1e-3, 1e3}, admittance.rest_time);
}

void read_sensor_errors(const Value& value, SensorErrors& errors) {
  const Map map(value);
  map.allow({"force_noise", "torque_noise", "force_bias", "torque_bias", "seed"});
  map.read("force_noise", {unit::force, 0.0, 1e6}, errors.force_noise);
  map.read("torque_noise", {unit::torque, 0.0, 1e6}, errors.torque_noise);
  map.read("force_bias", {unit::force, -1e6, 1e6}, errors.bias.force);
  map.read("torque_bias", {unit::torque, -1e6, 1e6}, errors.bias.torque);
  if (const Value* seed = map.find("seed")) {
    errors.seed = static_cast<std::uint64_t>(seed->integer(0, 1'000'000'000));
  }
}

/// A list of joints, or a map from joints to angles and lengths.
std::vector<JointHold> holds_of(const Value& value) {
  std::vector<JointHold> holds;
  if (value.is_list()) {
    for (const Value& entry : value.list()) holds.push_back({entry.text()});
    return holds;
  }
  const Map map(value);
  for (const auto& [joint, at] : map.entries()) {
    if (quantity(at.text(), unit::length)) {
      holds.push_back({joint, at.number(position), JointType::prismatic});
    } else {
      holds.push_back({joint, at.number(angles), JointType::revolute});
    }
  }
  return holds;
}

RobotChoice robot_of(const Value& value, const Laws& laws, const std::string& file) {
  const Map map(value);
  map.allow({"urdf", "tip_link", "start", "base", "tool_frame", "links", "self_law", "srdf",
             "payload", "hold", "packages", "drive_delay", "covers", "admittance",
             "sensor_errors"});
  RobotChoice robot;
  robot.urdf = path_of(map.at("urdf"), file);
  if (const Value* srdf = map.find("srdf")) robot.srdf = path_of(*srdf, file);
  if (map.find("self_law")) robot.self_law = law_called(laws, map, "self_law");
  map.read("tip_link", robot.tip_link);
  if (const Value* hold = map.find("hold")) robot.hold = holds_of(*hold);
  if (const Value* packages = map.find("packages")) robot.packages = packages_of(*packages, file);
  robot.covers = takes_covers(map);
  read_start(map.at("start"), robot);
  robot.X_WB = pose_at(map, "base");
  robot.X_LT = pose_at(map, "tool_frame");
  if (const Value* payload = map.find("payload")) read_payload(*payload, robot);
  if (const Value* admittance = map.find("admittance")) {
    read_admittance(*admittance, robot.admittance.emplace());
  }
  if (const Value* delay = map.find("drive_delay")) {
    robot.drive_delay = static_cast<int>(delay->integer(0, 100));
  }
  if (const Value* errors = map.find("sensor_errors")) read_sensor_errors(*errors, robot.sensor);
  if (const Value* links = map.find("links")) {
    robot.links.emplace();
    for (const Value& link : links->list()) robot.links->push_back(link.text());
  }
  return robot;
}

Vec3 direction_of(const Value& value) {
  const Vec3 direction = value.vector({unit::none, -1e3, 1e3});
  if (direction.norm() < 1e-6) value.fail_with_value("a direction, longer than 1e-6");
  return direction.normalized();
}

constexpr std::array all_steps{PartStep::What::spawn, PartStep::What::grip, PartStep::What::release,
                               PartStep::What::remove};

/// Keys of a phase of any device.
std::vector<std::string_view> phase_keys(std::initializer_list<std::string_view> more) {
  std::vector<std::string_view> keys{"name", "device", "frame", "duration", "silent",
                                     "over", "blind",  "scale", "second"};
  for (const PartStep::What what : all_steps) keys.push_back(word_for(what));
  keys.insert(keys.end(), detail::guiding_keys.begin(), detail::guiding_keys.end());
  keys.insert(keys.end(), more);
  return keys;
}

constexpr Rule lever_rates{unit::angular_speed, -100.0, 100.0, true};

/// What a second hand does in a phase: with six axes, or with a lever.
void read_second(const Map& map, network::Phase& phase) {
  map.allow({"linear", "angular", "direction", "lever"});
  map.read("linear", {unit::speed, -10.0, 10.0, true}, phase.second.linear);
  map.read("angular", {unit::angular_speed, -100.0, 100.0, true}, phase.second.angular);
  if (map.find("direction") == nullptr && map.find("lever") == nullptr) return;
  phase.second_lever = {direction_of(map.at("direction")), map.at("lever").number(lever_rates)};
}

network::Phase phase_of(const Value& value) {
  const Map map(value);
  map.allow(phase_keys({"linear", "angular", "direction", "lever", "pitch", "axis"}));
  network::Phase phase;
  phase.name = map.at("name").text();
  phase.duration = map.at("duration").number({unit::time, 1e-3, 86400.0});
  if (const Value* frame = map.find("frame")) {
    const bool is_tool = frame->word_of({"world", "tool"}) == "tool";
    phase.frame = is_tool ? network::PhaseFrame::tool : network::PhaseFrame::world;
  }
  if (const Value* silent = map.find("silent")) {
    phase.silent = silent->word_of({"yes", "no"}) == "yes";
  }
  map.read("scale", {unit::share, network::ChangingScale::least, network::ChangingScale::most},
           phase.scale);
  if (const Value* second = map.find("second")) read_second(Map(*second), phase);
  const std::string device = map.at("device").word_of({"spaceball", "torque_arm", "six_axes"});
  if (device != "torque_arm") {
    if (device == "six_axes") phase.master = network::Master::six_axes;
    map.allow(phase_keys({"linear", "angular"}));
    map.read("linear", {unit::speed, -10.0, 10.0, true}, phase.rates.linear);
    map.read("angular", {unit::angular_speed, -100.0, 100.0, true}, phase.rates.angular);
  } else {
    map.allow(phase_keys({"direction", "lever", "pitch", "axis"}));
    phase.master = network::Master::torque_arm;
    phase.direction = direction_of(map.at("direction"));
    phase.lever_rate = map.at("lever").number(lever_rates);
    if (map.find("pitch") != nullptr || map.find("axis") != nullptr) {
      phase.screw.emplace();
      map.read("pitch", {unit::length_per_angle, -10.0, 10.0}, phase.screw->pitch);
      map.read("axis", {unit::length, -10.0, 10.0}, phase.screw->axis);
    }
  }
  return phase;
}

/// The place of a part in the list of those that can come and go.
std::size_t part_called(const Value& name, const std::vector<LoosePart>& loose) {
  const std::string wanted = name.text();
  const auto found = std::find_if(loose.begin(), loose.end(),
                                  [&](const LoosePart& part) { return part.name == wanted; });
  if (found == loose.end()) name.fail_with_value("the name of a part under 'loose'");
  return static_cast<std::size_t>(found - loose.begin());
}

/// What happens to parts at the beginning of a phase.
void read_steps(const Map& phase, std::size_t index, const std::vector<LoosePart>& loose,
                std::vector<PartStep>& steps) {
  double over = PartStep{}.over;
  phase.read("over", {unit::time, 0.0, 60.0}, over);
  for (const PartStep::What what : all_steps) {
    const Value* names = phase.find(word_for(what));
    if (!names) continue;
    const auto add = [&](const Value& name) {
      steps.push_back({what, index, part_called(name, loose), over});
    };
    if (!names->is_list()) {
      add(*names);
      continue;
    }
    for (const Value& name : names->list()) add(name);
  }
}

/// Which cameras are silent in a phase.
std::vector<bool> blind_in(const Map& phase, const std::vector<CameraChoice>& cameras) {
  std::vector<bool> blind;
  const Value* const value = phase.find("blind");
  if (value == nullptr) return blind;
  if (!value->is_list()) {
    const std::string word = value->text();
    if (word == "no") return blind;
    if (word == "yes") return std::vector<bool>(cameras.size(), true);
  }
  blind.resize(cameras.size());
  const auto add = [&](const Value& name) {
    const std::string wanted = name.text();
    const auto found = std::find_if(cameras.begin(), cameras.end(),
                                    [&](const CameraChoice& each) { return each.name == wanted; });
    if (found == cameras.end()) name.fail_with_value("yes, no, or the name of a camera");
    blind[static_cast<std::size_t>(found - cameras.begin())] = true;
  };
  if (!value->is_list()) add(*value);
  if (value->is_list()) {
    for (const Value& name : value->list()) add(name);
  }
  return blind;
}

void read_script(const Map& scene, const Scene& whole, ArmSetup& setup) {
  const Value* value = scene.find("script");
  if (!value) return;
  std::set<std::string> names;
  for (const Value& entry : value->list()) {
    const Map map(entry);
    read_steps(map, setup.script.size(), whole.loose, setup.steps);
    setup.blind.push_back(blind_in(map, whole.cameras));
    setup.script.push_back(phase_of(entry));
    detail::read_guiding(map, setup.network, setup.script.back());
    require_new(names, map);
  }
}

/// Context shared by all arm setups of a file.
struct Shared {
  const Laws& laws;
  const std::string& file;
  const ModuleKinds& kinds;
  ShapeFile shapes;
  const Scene& scene;  ///< with what can come and go, and cameras
};

void read_station(const Map& map, const Shared& shared, ArmSetup& setup) {
  setup.robot = robot_of(map.at("robot"), shared.laws, shared.file);
  setup.tool = tool_of(map.at("tool"), shared.shapes);
  setup.network = detail::network_of(map.find("network"), shared.kinds);
  read_script(map, shared.scene, setup);
}

std::vector<OtherArm> partners_of(const Map& scene, const Shared& shared) {
  std::vector<OtherArm> partners;
  const Value* value = scene.find("partners");
  if (!value) return partners;
  std::set<std::string> names;
  for (const Value& entry : value->list(static_cast<std::size_t>(Capacities{}.bodies))) {
    const Map map(entry);
    map.allow({"name", "law", "robot", "tool", "network", "script"});
    OtherArm& partner = partners.emplace_back();
    partner.name = map.at("name").text();
    require_new(names, map);
    partner.law = law_called(shared.laws, map);
    read_station(map, shared, partner);
  }
  return partners;
}

void read_measure(const Map& map, Scene& scene) {
  if (const Value* measure = map.find("measure")) {
    std::vector<std::string> names;
    names.reserve(std::size(all_measures));
    for (const Measure each : all_measures) names.emplace_back(to_text(each));
    const std::vector<std::string_view> words(names.begin(), names.end());
    scene.measure = *measure_named(measure->word_of(words));
  }
  if (const Value* levels = map.find("levels")) {
    scene.levels = static_cast<int>(levels->integer(1, ReductionOptions::most_levels));
  }
}

Budget budget_of(const Map& scene) {
  Budget budget;
  const Value* value = scene.find("budget");
  if (!value) return budget;
  const Map map(*value);
  map.allow({"wall", "work", "threads", "max_age"});
  if (const Value* wall = map.find("wall")) {
    budget.wall_us = 1e6 * wall->number({unit::time, 0.0, 1.0});
  }
  if (const Value* work = map.find("work")) budget.work_units = work->integer(0, 1'000'000'000);
  if (const Value* threads = map.find("threads")) {
    budget.threads = static_cast<int>(threads->integer(0, Capacities{}.threads));
  }
  if (const Value* age = map.find("max_age")) budget.max_age = age->integer(1, 1'000'000'000);
  return budget;
}

/// Whether the scene is to be run as two programs.
bool apart_of(const Value& value, const Scene& scene) {
  if (value.word_of({"yes", "no"}) == "no") return false;
  const std::vector<Module>& modules = scene.network.modules;
  const bool has_line = std::any_of(modules.begin(), modules.end(), [](const Module& module) {
    return std::any_cast<network::LineOptions>(&module.options) != nullptr;
  });
  if (!has_line) value.fail("two programs need a module 'line' in the network, to part it there");
  if (!scene.partners.empty()) value.fail("'apart' beside 'partners'; allowed: one arm");
  return true;
}

}  // namespace

std::string_view word_for(PartStep::What what) noexcept {
  switch (what) {
    case PartStep::What::spawn:
      return "spawn";
    case PartStep::What::grip:
      return "grip";
    case PartStep::What::release:
      return "release";
    case PartStep::What::remove:
      break;
  }
  return "remove";
}

Scene parse(std::string_view yaml, const std::string& file, const ModuleKinds& kinds) {
  const Value document = Value::document(yaml, file);
  const Map map(document);
  map.allow({"name",    "rate",     "robot",  "tool",        "laws",         "obstacles",
             "loose",   "spare",    "camera", "cameras",     "hidden",       "network",
             "script",  "partners", "budget", "coprocessor", "start_inside", "tool_speed",
             "measure", "levels",   "apart"});
  Scene scene;
  scene.file = file;
  scene.name = std::filesystem::path(file).stem().string();
  map.read("name", scene.name);
  map.read("tool_speed", {unit::speed, 1e-3, 10.0}, scene.tool_speed);
  if (const Value* inside = map.find("start_inside")) {
    const bool out = inside->word_of({"refuse", "push_out"}) == "push_out";
    scene.start_inside = out ? StartInside::push_out : StartInside::refuse;
  }
  map.read("rate", {unit::frequency, 1.0, 1e5}, scene.rate_hz);
  read_measure(map, scene);
  const Laws laws = laws_of(map);
  HullPoints counted;
  const ShapeFile shapes{file, counted, scene.part_lists};
  scene.loose = loose_of(map, laws, shapes);
  scene.spare = spare_of(map, laws);
  scene.cameras = cameras_of(map, laws, file);
  scene.hidden = hidden_of(map, shapes, !scene.cameras.empty());
  if (!scene.cameras.empty() && scene.spare.count > 0) {
    map.at("spare").fail("'spare' beside a camera; allowed: one of the two");
  }
  const Shared shared{laws, file, kinds, shapes, scene};
  read_station(map, shared, scene);
  scene.obstacles = obstacles_of(map.at("obstacles"), laws, shared.shapes, scene.models);
  scene.partners = partners_of(map, shared);
  if (const Value* apart = map.find("apart")) scene.apart = apart_of(*apart, scene);
  scene.budget = budget_of(map);
  if (const Value* mode = map.find("coprocessor")) {
    const auto& names = coprocessor_mode_names;
    const std::string word = mode->word_of({names.begin(), names.end()});
    scene.coprocessor = *coprocessor_mode_named(word);
    // Whoever names it wants it; how many threads it has may still be said.
    const bool has_threads =
        map.find("budget") != nullptr && Map(*map.find("budget")).find("threads");
    if (!has_threads) scene.budget.threads = 1;
  }
  return scene;
}

Scene load(const std::string& path, const ModuleKinds& kinds) {
  return parse(text_of_file(path, "a scene file"), path, kinds);
}

void is_built_for(EigenAlignmentHere /*alignment*/, VectorRegisterHere /*size*/) noexcept {}

}  // namespace repel::scene
