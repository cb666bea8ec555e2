// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a page is told of an arm.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <repel/network/elements/fixture.hpp>
#include <repel/network/modules/relief.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/arm_kinematics.hpp>
#include <repel/world/world.hpp>

namespace repel::visual {

/// One arm of a world, for display.
struct ArmInfo {
  std::string name;                       ///< empty if there is only one
  BodyId tool;                            ///< moves with its tool frame
  std::vector<BodyId> links;              ///< those with parts
  std::vector<std::string> joints;        ///< "revolute" or "prismatic", base outward
  std::vector<ArmLink> links_of_model{};  ///< names and limits of the joints; may be left out
  std::vector<std::string> modules;       ///< of its network, in the same order
  std::vector<std::string> phases;        ///< names of the phases of its script; none: it has none
  double max_speed = 0.25;                ///< [m/s] maximum command of its master
  double max_turn = 1.0;                  ///< [rad/s] likewise
  double max_lever_rate = 1.5;            ///< [rad/s] maximum commanded lever motion
  /// Places the links that VisualInfo::link names, if there are any. It belongs to one view and is
  /// moved in its thread: never that of a cell.
  std::shared_ptr<ArmKinematics> kinematics{};
  // What a hand can switch in its network.
  std::vector<network::FixtureOptions> fixtures;  ///< of GUIDE, in its order
  std::optional<network::ReliefOptions> relief;   ///< of RELIEF; none: it has no such module
  bool has_scale = false;          ///< a master that is felt: HandInput::scale applies
  bool has_handle = false;         ///< SIX AXES in the first hand
  bool has_second_handle = false;  ///< and in a second one
};

}  // namespace repel::visual
