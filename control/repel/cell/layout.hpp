// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Adds arms and obstacles to a world, as bodies, parts and pairs.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <repel/cell/description.hpp>
#include <repel/cell/leverage.hpp>
#include <repel/loop/reciprocating_motion.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// The bodies and parts that represent an arm in a world.
struct ArmLayout {
  BodyId tool;                  ///< the body of the tool
  std::vector<LinkBody> links;  ///< only those that have parts
  std::vector<PartId> parts;    ///< in the order of the description, one after the other
  ArmLevers levers;             ///< of the tool and the parts of the links
};

/// The leverage of the tools of these arms over a pair of parts, 1 to `most_leverage`: how many
/// times a force at the tool the pair must exert to hold it. 1 where only tools and obstacles meet.
/// Of two arms the one with more leverage counts; of two parts of one arm the outer one, about the
/// joints between them. Not for the tick.
[[nodiscard]] double leverage(const World& world, std::span<const ArmLayout> arms, PartId a,
                              PartId b);

namespace detail {

/// Adds a pair with its law as it acts at the parts. @throws SetupError for a law out of range
void add_pair(World& world, std::span<const ArmLayout> arms, PartId a, PartId b,
              const ForceLaw& law);

/// The designation of an arm in messages.
[[nodiscard]] std::string named(const ArmDescription& arm);

/// @throws SetupError unless `start` has a position within the limits for each joint
void require_start(const ArmModel& model, const std::vector<double>& start);

/// Updates the kinematics of the arm to its start. @throws SetupError if the arm has no joints or
/// kinematics, or the start has a wrong number of joints or violates a joint limit
void start(ArmDescription& arm);

/// The world pose of a part [m].
[[nodiscard]] Pose pose_of(const World& world, const Part& part);

/// Adds the bodies and parts of an arm that is at its start. @throws SetupError for an unknown link
/// or a link without a pose
ArmLayout add_arm(World& world, const ArmDescription& arm);

/// Adds the self-collision pairs of an arm: its parts that are two or more joints apart, except
/// those in `may_touch`. @throws SetupError if two of them touch at the start
void add_own_pairs(World& world, const ArmDescription& arm, const ArmLayout& layout);

/// Adds an obstacle and its pairs with all arms. @return the moving body; none for a fixed obstacle
std::optional<MovingBody> add_obstacle(World& world, const ObstacleDescription& obstacle,
                                       const std::vector<ArmLayout>& arms);

/// Adds a part that can come and go, and its pairs: with all arms, and, for when it is held, with
/// the obstacles and the parts of this kind before it.
/// @param obstacles their parts, in the order of the cell's description
PartId add_loose(World& world, const CellDescription& cell, const LooseDescription& loose,
                 const std::vector<ArmLayout>& arms, std::span<const PartId> obstacles);

/// One message for each non-passable pair whose parts overlap by more than `touch` in the present
/// motion of the world.
[[nodiscard]] std::vector<std::string> overlaps(const World& world);

/// @throws SetupError listing the first five of these messages, if there are any
void require_clear_start(const std::vector<std::string>& overlaps);

}  // namespace detail

}  // namespace repel
