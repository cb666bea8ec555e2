// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/layout.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/reduction/separation.hpp>

namespace repel {

double leverage(const World& world, std::span<const ArmLayout> arms, PartId a, PartId b) {
  struct Side {
    const ArmLayout* arm = nullptr;  // none: an obstacle
    int part = 0;
  };
  const auto side_of = [&](PartId id) {
    for (const ArmLayout& arm : arms) {
      if (arm.parts.empty() || id.index < arm.parts.front().index) continue;
      if (id.index <= arm.parts.back().index) return Side{&arm, id.index - arm.parts[0].index};
    }
    return Side{};
  };
  const Side first = side_of(a);
  const Side second = side_of(b);
  if (first.arm != nullptr && first.arm == second.arm) {
    return first.arm->levers.between(first.part, second.part);
  }
  const auto over = [&](const Side& side, const Part& other) {
    if (side.arm == nullptr) return 1.0;
    const ArmLevers& levers = side.arm->levers;
    if (other.body != World::fixed) return levers.leverage(side.part);
    return levers.leverage(side.part, 0, levers.meeting(other.shape, other.X_BP));
  };
  return std::max(over(first, world.part(b)), over(second, world.part(a)));
}

}  // namespace repel

namespace repel::detail {

void add_pair(World& world, std::span<const ArmLayout> arms, PartId a, PartId b,
              const ForceLaw& law) {
  if (checked(law).given_at == GivenAt::part) {
    world.add_pair(a, b, law);
    return;
  }
  const double times = leverage(world, arms, a, b);
  const ForceLaw scaled = at_part(law, times);
  try {
    (void)checked(scaled);
  } catch (const SetupError& error) {
    throw SetupError("'" + world.part(a).name + "' and '" + world.part(b).name +
                     "': their law is given at the tool and acts " + to_text(times, 3) +
                     " times as strongly at the part: " + error.what() +
                     ", or a law given at the part");
  }
  world.add_pair(a, b, scaled);
}

std::string named(const ArmDescription& arm) {
  return arm.name.empty() ? "the arm" : "arm '" + arm.name + "'";
}

void require_start(const ArmModel& model, const std::vector<double>& start) {
  const std::size_t joints = model.links.size();
  if (start.size() != joints) {
    throw SetupError("robot start: " + std::to_string(start.size()) +
                     " joints; allowed: " + std::to_string(joints) + ", one for each moving joint");
  }
  for (std::size_t i = 0; i < joints; ++i) {
    const ArmLink& link = model.links[i];
    if (start[i] >= link.lower && start[i] <= link.upper) continue;
    const std::string unit = link.type == JointType::revolute ? " rad" : " m";
    std::string what = "robot start: " + to_text(start[i], 6);
    what += unit;
    what += " for " + link.joint_name + "; allowed: " + to_text(link.lower, 6) + " to ";
    what += to_text(link.upper, 6);
    throw SetupError(what + unit);
  }
}

void start(ArmDescription& arm) {
  const std::size_t joints = arm.model.links.size();
  const std::string most = std::to_string(network::most_joints);
  if (joints == 0) throw SetupError(named(arm) + ": it has no joint; allowed: 1 to " + most);
  if (joints > network::most_joints) {
    throw SetupError(named(arm) + ": it has " + std::to_string(joints) + " joints; allowed: 1 to " +
                     most);
  }
  if (arm.kinematics == nullptr) {
    throw SetupError(named(arm) + ": it has no kinematics; allowed: an ArmKinematics");
  }
  if (arm.start.empty()) arm.start.assign(joints, 0.0);
  require_start(arm.model, arm.start);
  arm.kinematics->update(arm.start);
}

Pose pose_of(const World& world, const Part& part) {
  return composed(world.motion().bodies[static_cast<std::size_t>(part.body.index)].X_WB, part.X_BP);
}

ArmLayout add_arm(World& world, const ArmDescription& arm) {
  const std::string prefix = arm.name.empty() ? "" : arm.name + "/";
  ArmLayout layout;
  layout.tool = world.add_body(prefix + "tool", arm.kinematics->X_WT());
  for (const ArmPart& part : arm.parts) {
    BodyId body = layout.tool;
    if (part.link != ArmPart::on_tool) {
      const int last = static_cast<int>(arm.model.links.size()) - 1;
      checked("link of part '" + part.name + "'", part.link, 0, last, "");
      const auto same = [&](const LinkBody& link) { return link.link == part.link; };
      auto at = std::find_if(layout.links.begin(), layout.links.end(), same);
      if (at == layout.links.end()) {
        const std::string& name = arm.model.links[static_cast<std::size_t>(part.link)].name;
        const Pose X_WL = arm.kinematics->X_WL(part.link);
        if (!is_finite(X_WL)) {
          throw SetupError("link '" + name +
                           "' has parts, but the kinematics give no pose of it (X_WL)");
        }
        layout.links.push_back({world.add_body(prefix + name, X_WL), part.link});
        at = std::prev(layout.links.end());
      }
      body = at->body;
    }
    layout.parts.push_back(world.add_part(body, prefix + part.name, part.shape, part.X_FP));
  }
  layout.levers = ArmLevers(arm);
  // What the tool holds may touch what the tool may touch.
  const int last = static_cast<int>(arm.model.links.size()) - 1;
  world.spare_held(layout.tool);
  for (const LinkBody& link : layout.links) {
    if (!arm.self_law || last - link.link < 2) world.spare_held(link.body);
  }
  return layout;
}

void add_own_pairs(World& world, const ArmDescription& arm, const ArmLayout& layout) {
  if (!arm.self_law) return;
  const int last = static_cast<int>(arm.model.links.size()) - 1;
  const auto link_of = [&](std::size_t part) {
    const int link = arm.parts[part].link;
    return link == ArmPart::on_tool ? last : link;
  };
  const auto may_touch = [&](std::size_t i, std::size_t k) {
    const int a = static_cast<int>(i);
    const int b = static_cast<int>(k);
    return std::any_of(arm.may_touch.begin(), arm.may_touch.end(), [&](const auto& pair) {
      return pair == std::pair(a, b) || pair == std::pair(b, a);
    });
  };
  for (std::size_t k = 0; k < layout.parts.size(); ++k) {
    for (std::size_t i = 0; i < k; ++i) {
      if (std::abs(link_of(i) - link_of(k)) < 2 || may_touch(i, k)) continue;
      const Part& a = world.part(layout.parts[i]);
      const Part& b = world.part(layout.parts[k]);
      if (separation(a.shape, pose_of(world, a), b.shape, pose_of(world, b)).lower <= 0.0) {
        throw SetupError("robot: '" + a.name + "' and '" + b.name +
                         "' meet where the arm starts; allowed: another start, or both in "
                         "may_touch, which of a scene is what its srdf file disables");
      }
      add_pair(world, {&layout, 1}, layout.parts[i], layout.parts[k], *arm.self_law);
    }
  }
}

std::optional<MovingBody> add_obstacle(World& world, const ObstacleDescription& obstacle,
                                       const std::vector<ArmLayout>& arms) {
  std::optional<MovingBody> moving;
  BodyId body = World::fixed;
  Pose X_BP = obstacle.X_WP;
  if (obstacle.motion) {
    checked("obstacle '" + obstacle.name + "': duration of its motion", obstacle.motion->duration,
            1e-3, 1e6, "s");
    body = world.add_body(obstacle.name, obstacle.X_WP);
    X_BP = Pose::Identity();
    moving = MovingBody{body, obstacle.X_WP, *obstacle.motion};
  }
  const PartId id = world.add_part(body, obstacle.name, obstacle.shape, X_BP);
  for (const ArmLayout& arm : arms) {
    for (const PartId part : arm.parts) add_pair(world, arms, part, id, obstacle.law);
  }
  return moving;
}

PartId add_loose(World& world, const CellDescription& cell, const LooseDescription& loose,
                 const std::vector<ArmLayout>& arms, std::span<const PartId> obstacles) {
  const double room = loose.room > 0.0 ? loose.room : std::max(loose.shape.reach(), 1e-6);
  const std::size_t before = world.loose().size();
  const PartId id = world.reserve(loose.name, loose.shape, room);
  world.weigh(id, loose.mass, loose.is_mass_known);
  for (const ArmLayout& arm : arms) {
    for (const PartId part : arm.parts) add_pair(world, arms, part, id, loose.law);
  }
  if (loose.can_be_held) {
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
      add_pair(world, arms, id, obstacles[i], cell.obstacles[i].law);
    }
  }
  for (std::size_t i = 0; i < before; ++i) {
    if (!loose.can_be_held && !cell.loose[i].can_be_held) continue;
    add_pair(world, arms, id, world.loose()[i].part, loose.law);
  }
  if (loose.at_start && !world.add(id, loose.X_WP, 0.0)) {
    throw SetupError(loose.name + ": its pose is not a rigid one");
  }
  if (loose.at_start) world.advance(1.0);
  return id;
}

std::vector<std::string> overlaps(const World& world) {
  constexpr double touch = 1e-6;  // [m] tolerance for parts that only touch, up to rounding
  std::vector<std::string> sentences;
  for (const Pair& pair : world.pairs()) {
    const PairId id{static_cast<std::int32_t>(&pair - world.pairs().data())};
    if (pair.law.passable || !acts(world, id, world.motion())) continue;
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

void require_clear_start(const std::vector<std::string>& overlaps) {
  if (overlaps.empty()) return;
  constexpr std::size_t most_named = 5;
  std::string sentence;
  for (std::size_t i = 0; i < std::min(overlaps.size(), most_named); ++i) {
    sentence += (i == 0 ? "" : ", ") + overlaps[i];
  }
  if (overlaps.size() > most_named) {
    sentence += ", and " + std::to_string(overlaps.size() - most_named) + " more";
  }
  throw SetupError(sentence + "; allowed: another 'start', or 'start_inside: push_out'");
}

}  // namespace repel::detail
