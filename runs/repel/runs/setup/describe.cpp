// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/setup/describe.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include <repel/base/setup_error.hpp>
#include <repel/cell/admittance.hpp>
#include <repel/cell/layout.hpp>
#include <repel/robots/mjcf.hpp>
#include <repel/robots/parts.hpp>
#include <repel/runs/setup/covers_beside.hpp>
#include <repel/runs/setup/seen_parts.hpp>
#include <repel/runs/setup/static_model.hpp>
#include <repel/scene/build_network.hpp>
#include <repel/simulated/changed_arm.hpp>
#include <repel/world/kinematics.hpp>

namespace repel::runs {
namespace {

/// Makes the model match the arm of the back end "ideal": joints with motor inertia, massless
/// links.
void make_ideal(ArmModel& model) {
  model.gravity_W.setZero();
  for (ArmLink& link : model.links) {
    link.mass = 0.0;
    link.I_C_L.setZero();
    link.rotor_inertia = std::max(0.1, link.rotor_inertia);
    link.viscous_friction = std::max(1.0, link.viscous_friction);
    link.coulomb_friction = 0.0;
  }
}

Robot read_robot(const scene::RobotChoice& choice, CoversBeside& covers) {
  std::vector<Hold> holds;
  for (const scene::JointHold& hold : choice.hold) {
    holds.push_back(hold.position ? Hold(hold.joint, *hold.position, hold.type) : Hold(hold.joint));
  }
  if (choice.is_mjcf) return load_mjcf_arm(choice.urdf, {choice.tip_link, std::move(holds)});
  UrdfOptions options;
  if (choice.covers) options.convex_parts = covers.reader();
  options.tip = choice.tip_link;
  options.package_paths = choice.packages;
  options.hold = std::move(holds);
  return load_arm(choice.urdf, options);
}

Robot load_robot(const scene::RobotChoice& choice, bool with_gravity, CoversBeside& covers) {
  Robot robot = read_robot(choice, covers);
  ArmModel& model = robot.arm;
  model.X_WB = choice.X_WB * model.X_WB;
  model.X_LT = model.X_LT * choice.X_LT;
  if (choice.payload_known) model = with_payload(std::move(model), choice.payload);
  if (!with_gravity) make_ideal(model);
  return robot;
}

/// @throws SetupError with its line for a start that the arm cannot have, and if the file gives an
///   angle for a prismatic joint, or a length for a revolute one
void require_start(const std::string& file, const scene::RobotChoice& choice,
                   const ArmModel& model) {
  for (std::size_t i = 0; i < std::min(choice.start.size(), model.links.size()); ++i) {
    const ArmLink& link = model.links[i];
    if (choice.start_types[i] == link.type) continue;
    const bool turns = link.type == JointType::revolute;
    throw SetupError("robot start: " + std::string(turns ? "a length" : "an angle") + " for " +
                         link.joint_name + "; allowed: " + (turns ? "an angle" : "a length"),
                     file, choice.start_line);
  }
  try {
    repel::detail::require_start(model, choice.start);
  } catch (const SetupError& error) {
    throw SetupError(error.what(), file, choice.start_line);
  }
}

/// Whether the walls apply to this part of a link, according to the setup.
bool is_kept(const scene::ArmSetup& setup, const RobotPart& part) {
  if (part.link < 0 || !scene::feels_links(setup)) {
    return false;  // the base is fixed, as the obstacles are
  }
  const auto& chosen = setup.robot.links;
  return !chosen || std::count(chosen->begin(), chosen->end(), part.in_link) != 0;
}

void require_links(const std::string& file, const scene::RobotChoice& choice, const Robot& robot) {
  for (const std::string& name : choice.links.value_or(std::vector<std::string>{})) {
    const bool known =
        std::any_of(robot.parts.begin(), robot.parts.end(),
                    [&](const RobotPart& part) { return part.in_link == name && part.link >= 0; });
    if (known) continue;
    throw SetupError("robot links: '" + name + "' is no moving link with parts of " + choice.urdf,
                     file);
  }
}

/// The pairs of parts that the SRDF file disables.
///
/// @param links name of the link in the URDF file, for each part
std::vector<std::pair<int, int>> disabled_pairs(const scene::RobotChoice& choice,
                                                const Robot& robot,
                                                const std::vector<std::string>& links) {
  std::vector<std::pair<int, int>> pairs;
  if (!choice.self_law || choice.srdf.empty()) return pairs;
  for (const DisabledCollision& disabled : load_disabled_collisions(choice.srdf, robot)) {
    for (std::size_t a = 0; a < links.size(); ++a) {
      for (std::size_t b = 0; b < links.size(); ++b) {
        if (disabled.first != links[a] || disabled.second != links[b]) continue;
        pairs.emplace_back(static_cast<int>(a), static_cast<int>(b));
      }
    }
  }
  return pairs;
}

/// @param shown to which that of each part is added, in the order of the parts
ArmDescription describe_arm(const scene::Scene& scene, const scene::ArmSetup& setup,
                            const Robot& robot, network::RemoteLink* remote,
                            const CoversBeside& covers, std::vector<scene::Shown>& shown) {
  ArmDescription arm;
  arm.model = robot.arm;
  arm.kinematics = std::make_unique<Kinematics>(robot.arm);
  arm.start = setup.robot.start;
  require_start(scene.file, setup.robot, robot.arm);
  require_links(scene.file, setup.robot, robot);
  std::vector<std::string> links;  // link name in the URDF file, for each part
  for (const scene::Part& part : setup.tool) {
    arm.parts.push_back({part.name, part.shape, part.X_BP});
    shown.push_back(part.shown);
    links.push_back(setup.robot.tip_link.empty() ? robot.arm.links.back().name
                                                 : setup.robot.tip_link);
  }
  for (int link = 0; link < static_cast<int>(robot.arm.links.size()); ++link) {
    for (const RobotPart& part : robot.parts) {
      if (part.link != link || !is_kept(setup, part)) continue;
      arm.parts.push_back({part.name, shape_of(part, {.levels = 1}), part.X_LP, link});
      shown.push_back({.gaps = covers.gaps_of(part)});
      links.push_back(part.in_link);
    }
  }
  arm.self_law = setup.robot.self_law;
  arm.may_touch = disabled_pairs(setup.robot, robot, links);
  arm.network = remote == nullptr ? scene::plan_network(scene, setup, robot.arm)
                                  : scene::plan_half(scene, setup, robot.arm, {false, remote});
  arm.options.tool_speed = scene.tool_speed;
  arm.options.has_brakes = true;
  arm.options.drive_delay = setup.robot.drive_delay;
  return arm;
}

}  // namespace

DescribedScene describe(const scene::Scene& scene, double rate_hz, bool with_gravity,
                        network::RemoteLink* remote) {
  DescribedScene described;
  CellDescription& cell = described.cell;
  cell.rate_hz = rate_hz;
  cell.gain_check = scene.network.gain_check;
  cell.start_inside = scene.start_inside;
  cell.measure = scene.measure;
  cell.levels = scene.levels;
  CoversBeside covers;
  for (std::size_t i = 0; i <= scene.partners.size(); ++i) {
    const scene::ArmSetup& setup = scene.arm_setup(i);
    described.robots.push_back(load_robot(setup.robot, with_gravity, covers));
    ArmDescription& arm = cell.arms.emplace_back(
        describe_arm(scene, setup, described.robots.back(), remote, covers, described.shown));
    if (setup.robot.admittance) {
      try {
        arm = admitted(std::move(arm), *setup.robot.admittance, 1.0 / rate_hz);
      } catch (const SetupError& error) {
        throw SetupError(error.what(), scene.file, setup.robot.admittance_line);
      }
    }
    if (i == 0) continue;
    arm.name = scene.partners[i - 1].name;
    arm.law = scene.partners[i - 1].law;
  }
  for (const scene::StaticModel& model : scene.models) {
    for (scene::Obstacle& obstacle : obstacles_of(model, covers)) {
      described.model_obstacles.push_back(std::move(obstacle));
    }
  }
  for (const auto* obstacles : {&scene.obstacles, &std::as_const(described.model_obstacles)}) {
    for (const scene::Obstacle& obstacle : *obstacles) {
      cell.obstacles.push_back(
          {obstacle.name, obstacle.shape, obstacle.X_WP, obstacle.law, obstacle.motion});
      described.shown.push_back(obstacle.shown);
    }
  }
  described.part_lists = covers.lists();
  for (const scene::LoosePart& part : scene.loose) {
    cell.loose.push_back({part.name, part.shape, part.X_WP, part.law, part.at_start, 0.0, part.mass,
                          part.is_mass_known});
    described.shown.push_back(part.shown);
  }
  for (int i = 1; i <= scene.spare.count; ++i) {
    const Shape nothing = Shape::sphere(0.01 * scene.spare.room, {.levels = 1});
    cell.loose.push_back({"spare_" + std::to_string(i), nothing, Pose::Identity(), scene.spare.law,
                          false, scene.spare.room});
  }
  for (const scene::CameraChoice& camera : scene.cameras) {
    const Shape nothing = Shape::box({5e-3, 5e-3, 5e-3}, {.levels = 1});  // few corners to send
    for (int i = 0; i < camera.parts; ++i) {
      cell.loose.push_back({.name = name_of_seen(camera),
                            .shape = nothing,
                            .law = camera.law,
                            .room = room_of_seen,
                            .can_be_held = false});
    }
    cell.limits.loose = std::max(cell.limits.loose, static_cast<int>(cell.loose.size()));
  }
  return described;
}

}  // namespace repel::runs
