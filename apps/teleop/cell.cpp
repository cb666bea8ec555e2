#include "cell.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <repel/loop/gain_check.hpp>
#include <repel/robots/parts.hpp>

namespace repel::teleop {
namespace {

/// What the arm of the back end "ideal" is: joints that move their motors and weigh nothing.
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

Robot load_robot(const scene::RobotChoice& choice, bool with_gravity) {
  UrdfOptions options;
  options.tip = choice.tip_link;
  Robot robot = load_arm(choice.urdf, options);
  ArmModel& model = robot.arm;
  model.X_WB = choice.X_WB * model.X_WB;
  model.X_LT = model.X_LT * choice.X_LT;
  if (!with_gravity) make_ideal(model);
  return robot;
}

std::vector<double> checked_start(const std::string& file, const scene::RobotChoice& choice,
                                  const ArmModel& model) {
  const std::vector<double>& start = choice.start;
  if (start.size() != model.links.size()) {
    throw SetupError("robot start: " + std::to_string(start.size()) + " joints; allowed: " +
                         std::to_string(model.links.size()) + ", one for each moving joint",
                     file);
  }
  for (std::size_t i = 0; i < start.size(); ++i) {
    const ArmLink& link = model.links[i];
    if (choice.start_types[i] != link.type) {
      const bool turns = link.type == JointType::revolute;
      throw SetupError("robot start: " + std::string(turns ? "a length" : "an angle") + " for " +
                           link.joint_name + "; allowed: " + (turns ? "an angle" : "a length"),
                       file);
    }
    if (start[i] < link.lower || start[i] > link.upper) {
      throw SetupError("robot start: " + to_text(start[i], 6) + " for " + link.joint_name +
                           "; allowed: " + to_text(link.lower, 6) + " to " + to_text(link.upper, 6),
                       file);
    }
  }
  return start;
}

/// True when the station keeps the parts of this link of the file off the obstacles.
bool is_kept(const scene::Station& station, const RobotPart& part) {
  if (part.link < 0 || !scene::feels_links(station)) {
    return false;  // the base moves no more than they
  }
  const auto& chosen = station.robot.links;
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

Pose pose_of(const World& world, const Part& part) {
  return world.motion().bodies[static_cast<std::size_t>(part.body.index)].X_WB * part.X_BP;
}

/// [m] that parts which touch may overlap by rounding.
constexpr double touch = 1e-6;

/// How many joints stand between the bodies of two parts of one arm; the tool is on the last link.
int joints_between(const Manipulator& arm, const World& world, PartId a, PartId b) {
  const auto link_of = [&](PartId id) {
    for (const LinkBody& link : arm.links) {
      if (link.body == world.part(id).body) return link.link;
    }
    return static_cast<int>(arm.robot.arm.links.size()) - 1;
  };
  return std::abs(link_of(a) - link_of(b));
}

/// Keeps those parts of an arm apart that two joints or more stand between, unless the SRDF file
/// leaves them out.
void add_own_pairs(World& world, const scene::Scene& scene, const scene::RobotChoice& choice,
                   const Manipulator& arm) {
  if (!choice.self_law) return;
  std::vector<DisabledCollision> disabled;
  if (!choice.srdf.empty()) disabled = load_disabled_collisions(choice.srdf, arm.robot);
  const auto is_disabled = [&](std::size_t i, std::size_t k) {
    return std::any_of(disabled.begin(), disabled.end(), [&](const DisabledCollision& pair) {
      return (pair.first == arm.part_links[i] && pair.second == arm.part_links[k]) ||
             (pair.first == arm.part_links[k] && pair.second == arm.part_links[i]);
    });
  };
  for (std::size_t k = 0; k < arm.parts.size(); ++k) {
    for (std::size_t i = 0; i < k; ++i) {
      const PartId a = arm.parts[i];
      const PartId b = arm.parts[k];
      if (joints_between(arm, world, a, b) < 2 || is_disabled(i, k)) continue;
      const Part& first = world.part(a);
      const Part& second = world.part(b);
      if (separation(first.shape, pose_of(world, first), second.shape, pose_of(world, second))
              .lower <= 0.0) {
        throw SetupError("robot: '" + first.name + "' and '" + second.name +
                             "' meet where the arm starts; allowed: another start, or links that "
                             "the srdf file disables",
                         scene.file);
      }
      world.add_pair(a, b, *choice.self_law);
    }
  }
}

}  // namespace

Manipulator::Manipulator(const scene::Scene& scene, const scene::Station& station,
                         const std::string& prefix, bool with_gravity, World& world)
    : robot(load_robot(station.robot, with_gravity)),
      start(checked_start(scene.file, station.robot, robot.arm)),
      kinematics(robot.arm) {
  require_links(scene.file, station.robot, robot);
  kinematics.update(start);
  tool = world.add_body(prefix + "tool", kinematics.X_WT());
  for (const scene::Part& part : station.tool) {
    parts.push_back(world.add_part(tool, prefix + part.name, part.shape, part.X_BP));
    part_links.push_back(station.robot.tip_link.empty() ? robot.arm.links.back().name
                                                        : station.robot.tip_link);
  }
  for (int link = 0; link < kinematics.links(); ++link) {
    for (const RobotPart& part : robot.parts) {
      if (part.link != link || !is_kept(station, part)) continue;
      if (links.empty() || links.back().link != link) {
        const std::string& name = robot.arm.links[static_cast<std::size_t>(link)].name;
        links.push_back({world.add_body(prefix + name, kinematics.X_WL(link)), link});
      }
      parts.push_back(
          world.add_part(links.back().body, prefix + part.name, shape_of(part), part.X_LP));
      part_links.push_back(part.in_link);
    }
  }
}

double Manipulator::device_damping() {
  kinematics.update(start);
  Jacobian J(6, kinematics.links());
  kinematics.tool_jacobian(J);
  return repel::device_damping(robot.arm, J);
}

Cell::Cell(const scene::Scene& scene, bool with_gravity) {
  arms.emplace_back(scene, scene, "", with_gravity, world);
  for (const scene::Partner& partner : scene.partners) {
    arms.emplace_back(scene, partner, partner.name + "/", with_gravity, world);
  }
  for (const scene::Obstacle& obstacle : scene.obstacles) {
    BodyId body = World::fixed;
    Pose X_BP = obstacle.X_WP;
    if (obstacle.motion) {
      body = world.add_body(obstacle.name, obstacle.X_WP);
      X_BP = Pose::Identity();
      shuttles.push_back(
          {body, obstacle.X_WP, obstacle.motion->along_W, obstacle.motion->duration});
    }
    const PartId id = world.add_part(body, obstacle.name, obstacle.shape, X_BP);
    for (const Manipulator& each : arms) {
      for (const PartId part : each.parts) world.add_pair(part, id, obstacle.law);
    }
  }
  for (std::size_t second = 1; second < arms.size(); ++second) {
    for (const PartId b : arms[second].parts) {
      for (std::size_t first = 0; first < second; ++first) {
        for (const PartId a : arms[first].parts) {
          world.add_pair(a, b, scene.partners[second - 1].law);
        }
      }
    }
  }
  for (std::size_t i = 0; i < arms.size(); ++i) {
    add_own_pairs(world, scene, scene.station(i).robot, arms[i]);
  }
}

std::vector<std::string> Cell::overlaps() const {
  std::vector<std::string> sentences;
  for (const Pair& pair : world.pairs()) {
    if (pair.law.passable) continue;
    const Part& a = world.part(pair.a);
    const Part& b = world.part(pair.b);
    const Separation s =
        separation(a.shape, pose_of(world, a), b.shape, pose_of(world, b), {.ignore_beyond = 0.0});
    if (!(s.upper < -touch)) continue;
    sentences.push_back("'" + a.name + "' starts inside '" + b.name + "', " +
                        to_text(-1e3 * s.upper, 3) + " mm deep or more");
  }
  return sentences;
}

void Cell::require_clear_start(const scene::Scene& scene) const {
  if (scene.start_inside == scene::StartInside::push_out) return;
  constexpr std::size_t most_named = 5;
  const std::vector<std::string> found = overlaps();
  if (found.empty()) return;
  std::string sentence;
  for (std::size_t i = 0; i < std::min(found.size(), most_named); ++i) {
    sentence += (i == 0 ? "" : ", ") + found[i];
  }
  if (found.size() > most_named) {
    sentence += ", and " + std::to_string(found.size() - most_named) + " more";
  }
  throw SetupError(
      sentence + "; allowed: another 'start', or 'start_inside: push_out' in the scene",
      scene.file);
}

double Cell::device_damping() {
  double least = std::numeric_limits<double>::infinity();
  for (Manipulator& each : arms) least = std::min(least, each.device_damping());
  return least;
}

}  // namespace repel::teleop
