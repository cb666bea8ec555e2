// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The description a cell is built from: plain structs, no file format.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <repel/base/capacities.hpp>
#include <repel/base/types.hpp>
#include <repel/force/law.hpp>
#include <repel/loop/options.hpp>
#include <repel/loop/reciprocating_motion.hpp>
#include <repel/network/machinery/clean_stiffness.hpp>
#include <repel/network/plan.hpp>
#include <repel/reduction/convex_shape.hpp>
#include <repel/schedule/coprocessor_options.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/arm_kinematics.hpp>

namespace repel {

/// A convex part P of an arm.
struct ArmPart {
  static constexpr int on_tool = -1;  ///< `link` of a part that the tool has

  std::string name;              ///< in reports and messages
  Shape shape;                   ///< convex, in the frame P
  Pose X_FP = Pose::Identity();  ///< [m] in the tool frame, or in the frame of its link
  int link = on_tool;            ///< index in ArmModel::links
};

/// An arm, its parts repelled by obstacles, and the network between operator and joints.
struct ArmDescription {
  std::string name;  ///< prefix of the names of its bodies and parts: "left" gives "left/tool"
  ArmModel model;    ///< limits, efforts and friction of the joints; masses of the links
  std::unique_ptr<ArmKinematics> kinematics;  ///< of this arm alone; the cell uses it in its ticks
  std::vector<double> start;                  ///< [rad] or [m]; empty: all at zero
  std::vector<ArmPart> parts;                 ///< of tool and links
  std::optional<network::Plan> network;       ///< without one: `default_network`
  std::optional<ForceLaw> self_law;  ///< between own parts that are two or more joints apart
  std::vector<std::pair<int, int>> may_touch;  ///< indices of parts, excluded from `self_law`
  ForceLaw law;                 ///< between its parts and those of the arms before it in the list
  TeleoperatorOptions options;  ///< of fail-safe, stop, torques, readings and hard walls
  bool takes_motion = false;    ///< it takes rates or positions: set by `admitted`
  double response = 0.0;        ///< [s] the part of its delay that is no number of ticks: likewise
};

/// A convex part P of the environment.
struct ObstacleDescription {
  std::string name;                             ///< in reports and messages
  Shape shape;                                  ///< convex, in the frame P
  Pose X_WP = Pose::Identity();                 ///< [m]
  ForceLaw law{};                               ///< between it and every part of every arm
  std::optional<ReciprocatingMotion> motion{};  ///< without one it is fixed
};

/// A convex part P of the environment that can come and go, be moved and be held by a tool while
/// the cell runs (Cell::changes, docs/changing_cell.md).
struct LooseDescription {
  std::string name;              ///< in reports and messages, and to find it by
  Shape shape;                   ///< that it comes with, unless it gets another one
  Pose X_WP = Pose::Identity();  ///< [m] where it comes, unless it is said
  ForceLaw law{};                ///< between it and every part of every arm
  bool at_start = false;         ///< it is there from the start on
  double room = 0.0;             ///< [m] largest reach of its later shapes; 0: that of `shape`
  double mass = 0.0;             ///< [kg] at the origin of its shape: its weight on a tool
  bool is_mass_known = true;     ///< to the controller, not only to a simulated arm
  /// A tool can take it: it then keeps off obstacles and other such parts. Without, it has pairs
  /// with arms only, so hundreds of parts are affordable.
  bool can_be_held = true;
};

/// Handling of an arm starting with a part inside an impassable obstacle.
enum class StartInside {
  refuse,    ///< SetupError
  push_out,  ///< it starts, and is pushed out slowly
  allow,     ///< it starts, with the normal wall force
};

/// Arms, operators and obstacles in one world.
struct CellDescription {
  double rate_hz = 400.0;                                     ///< [Hz] of the tick, 1 to 1e5
  std::vector<ArmDescription> arms{};                         ///< at least one
  std::vector<ObstacleDescription> obstacles{};               ///< none: a free room
  std::vector<LooseDescription> loose{};                      ///< all absent unless `at_start`
  Capacities limits{};                                        ///< capacities of the world
  CoprocessorOptions coprocessor{};                           ///< its `period` is overwritten
  network::GainCheck gain_check = network::GainCheck::error;  ///< for walls that are too stiff
  StartInside start_inside = StartInside::refuse;             ///< for every arm
  /// How the depth of an overlap is measured: the deepest common point, Anderson's reduction or the
  /// penetration depth (docs/reduction.md, also for what each costs).
  Measure measure = QueryOptions{}.measure;
  /// Reduces every shape in so many steps, 1 to 64, if the measure needs levels at all; without a
  /// number the shapes stay as they were built. For a measure that needs none, build them with
  /// `{.levels = 1}`: each level takes memory and time at set-up, none in the tick.
  std::optional<int> levels{};
};

}  // namespace repel
