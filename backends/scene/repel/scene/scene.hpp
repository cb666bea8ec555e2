/// @file
/// Reads a scene file: the robot, its tool, the obstacles, the operator's script. The format stands
/// in scenes/README.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <repel/base/layout.hpp>
#include <repel/base/types.hpp>
#include <repel/force/law.hpp>
#include <repel/network/clean_stiffness.hpp>
#include <repel/network/operator.hpp>
#include <repel/network/plan.hpp>
#include <repel/reduction/shape.hpp>
#include <repel/scene/module_kinds.hpp>
#include <repel/schedule/pair_block.hpp>
#include <repel/world/arm.hpp>

namespace repel::scene {

/// Defined for the flags this part was built with: a program with others does not link.
void is_built_for(EigenAlignmentHere, VectorRegisterHere) noexcept;
[[gnu::used, gnu::retain]] constexpr auto built_alike = &is_built_for;

/// One convex part P of the tool.
struct Part {
  std::string name;
  Shape shape;
  std::string kind;              ///< box, sphere, capsule, cylinder or hull
  Pose X_BP = Pose::Identity();  ///< [m] in the tool frame
};

/// To and fro along a line, by itself.
struct ObstacleMotion {
  Vec3 along_W{0, 0, 0};  ///< [m] from where it stands to the far end
  double duration = 1.0;  ///< [s] there and back
};

/// One convex part P of the world.
struct Obstacle {
  std::string name;
  Shape shape;
  std::string kind;              ///< box, sphere, capsule, cylinder or hull
  Pose X_WP = Pose::Identity();  ///< [m] where it starts, if it moves
  ForceLaw law;
  std::optional<ObstacleMotion> motion;  ///< none: it stands
};

/// Which robot, where it stands and how it starts.
struct RobotChoice {
  std::string urdf;           ///< path; one that the scene file gives is relative to that file
  std::string tip_link;       ///< empty: the end of the chain
  std::vector<double> start;  ///< [rad] or [m] one for each moving joint, base outward
  std::vector<JointType> start_types;  ///< which of the two the file gives
  Pose X_WB = Pose::Identity();        ///< [m] base in the world
  Pose X_LT = Pose::Identity();        ///< [m] tool frame in the tip link
  /// Links of the URDF file that are kept off the obstacles, where the network has the module
  /// arm_obstacle; without a list all that move.
  std::optional<std::vector<std::string>> links;
  /// Between parts of the arm that no joint connects; without it they are not kept apart.
  std::optional<ForceLaw> self_law;
  std::string srdf;  ///< path of a file with the pairs of links to leave out; empty: none
};

/// What the distance queries of one tick may cost.
struct Budget {
  double wall_us = 0.0;         ///< [us] 0: no limit
  std::int64_t work_units = 0;  ///< support-map pairs; 0: no limit
  int threads = 0;              ///< of the coprocessor; 0: the tick's own thread does the work
  std::int64_t max_age = repel::Budget{}.max_age;  ///< [ticks] beyond it an answer expires
};

/// One entry of the network.
struct Module : ReadModule {
  std::string name;
  std::string kind;  ///< the word after `module:`
  network::To to;    ///< what it says; the next one when it says nothing
  int line = 0;      ///< of the file
};

struct Network {
  std::vector<Module> modules;                                ///< from the operator to the robot
  network::GainCheck gain_check = network::GainCheck::error;  ///< of the obstacle module
};

/// An arm with its tool, the operator who drives it and what stands between the two.
struct Station {
  RobotChoice robot;
  std::vector<Part> tool;
  Network network;
  network::Script script;
};

/// One more arm in the cell. It meets the obstacles by their own laws.
struct Partner : Station {
  std::string name;
  ForceLaw law;  ///< between its parts and those of every arm before it
};

/// What becomes of an arm that starts with a part of it inside an obstacle that is not passable.
enum class StartInside {
  refuse,    ///< it does not start
  push_out,  ///< it starts, and is pushed out slowly
};

struct Scene : Station {
  std::string name;
  std::string file;
  double rate_hz = 400.0;    ///< [Hz] of the tick
  double tool_speed = 0.25;  ///< [m/s] most of a tool
  StartInside start_inside = StartInside::refuse;
  std::vector<Obstacle> obstacles;
  std::vector<Partner> partners;
  Budget budget;

  /// Its own for 0, then those of the partners.
  [[nodiscard]] const Station& station(std::size_t i) const {
    return i == 0 ? static_cast<const Station&>(*this) : partners[i - 1];
  }
};

/// True when the network has the module through which the links of the arm feel the obstacles.
[[nodiscard]] bool feels_links(const Station& station);

/// Reads the scene file at `path`. Throws SetupError, naming file, line, value and what is allowed,
/// for anything that is not exactly as scenes/README.md states it.
/// @param kinds of module that the file can name
[[nodiscard]] Scene load(const std::string& path, const ModuleKinds& kinds = {});

/// The same for text; `file` is the name that errors give and that paths are relative to.
[[nodiscard]] Scene parse(std::string_view yaml, const std::string& file,
                          const ModuleKinds& kinds = {});

/// The network of a station of the scene for its arm, ready for a period of 1 / `rate_hz`.
/// @throws SetupError naming the file and the modules when it cannot be built
[[nodiscard]] network::Network build_network(const Scene& scene, const Station& station,
                                             const ArmModel& arm, double rate_hz);

}  // namespace repel::scene
