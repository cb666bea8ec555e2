// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads a scene file: robots with their tools, obstacles, operator scripts. scenes/README.md
/// describes the format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <repel/base/layout.hpp>
#include <repel/base/setup_error.hpp>
#include <repel/base/types.hpp>
#include <repel/cell/admittance.hpp>
#include <repel/cell/description.hpp>
#include <repel/force/law.hpp>
#include <repel/loop/reciprocating_motion.hpp>
#include <repel/network/operator.hpp>
#include <repel/reduction/shape.hpp>
#include <repel/scene/camera.hpp>
#include <repel/scene/change.hpp>
#include <repel/scene/module_kinds.hpp>
#include <repel/scene/network.hpp>
#include <repel/scene/shown.hpp>
#include <repel/schedule/coprocessor_options.hpp>
#include <repel/simulated/changed_arm.hpp>
#include <repel/simulated/sensed_arm.hpp>
#include <repel/world/arm.hpp>

namespace repel::scene {

/// Defined for the compiler flags of this library: a program with incompatible flags does not link.
void is_built_for(EigenAlignmentHere, VectorRegisterHere) noexcept;
/// Makes the program link `is_built_for`.
[[gnu::used, gnu::retain]] constexpr auto built_alike = &is_built_for;

/// One convex part P of the tool.
struct Part {
  std::string name;              ///< unique among the parts of the tool
  Shape shape;                   ///< in the frame P
  std::string kind;              ///< box, sphere, capsule, cylinder, cone, ellipsoid or hull
  Pose X_BP = Pose::Identity();  ///< [m] pose in the tool frame
  Shown shown{};                 ///< no force depends on it
};

/// One convex part P of the world.
struct Obstacle {
  std::string name;              ///< unique in the scene
  Shape shape;                   ///< in the frame P
  std::string kind;              ///< box, sphere, capsule, cylinder, cone, ellipsoid or hull
  Pose X_WP = Pose::Identity();  ///< [m] pose; initial pose if it moves
  ForceLaw law;                  ///< between it and every part of every arm
  std::optional<ReciprocatingMotion> motion;  ///< none: it is fixed
  Shown shown{};                              ///< no force depends on it
  int line = 0;                               ///< of the file
};

/// How a file describes a model.
enum class ModelFormat : std::uint8_t { urdf, sdf, mjcf };

/// A robot description M, or what an SDF or MJCF file has, of which every collision part is an
/// obstacle, with all joints at zero (MJCF: at their references).
struct StaticModel {
  std::string name;                        ///< its parts are called NAME/LINK/PART
  std::string file;                        ///< path
  ModelFormat format = ModelFormat::urdf;  ///< of the file
  std::vector<std::string> packages;       ///< folders where package:// leads
  bool covers = true;                      ///< meshes become the parts in the lists beside them
  Pose X_WM = Pose::Identity();  ///< [m] pose of its root link, or of its SDF or MJCF world
  ForceLaw law;                  ///< of every part
  Paint paint{};                 ///< of every part
};

/// One convex part P of the world that can come, be held by a tool, and go while the scene runs.
struct LoosePart {
  std::string name;                  ///< unique in the scene
  Shape shape = Shape::sphere(0.0);  ///< in the frame P
  std::string kind;                  ///< box, sphere, capsule, cylinder, cone, ellipsoid or hull
  Pose X_WP = Pose::Identity();      ///< [m] where it is at the start, and where it comes
  ForceLaw law;                      ///< between it and every part of every arm
  bool at_start = true;              ///< it is there at the start
  double mass = 0.0;                 ///< [kg]
  bool is_mass_known = true;         ///< to the controller, not only to the simulated arm
  Shown shown{};                     ///< no force depends on it
};

/// Parts reserved for what is not known before: boxes from the page of the live view.
struct SpareParts {
  int count = 0;      ///< parts to reserve
  double room = 0.3;  ///< [m] largest reach from their centres
  ForceLaw law;       ///< of every such part
};

/// One convex part P that cameras see and the world model does not know.
struct HiddenPart {
  std::string name;                           ///< unique in the scene
  Shape shape = Shape::sphere(0.0);           ///< in the frame P
  Pose X_WP = Pose::Identity();               ///< [m] where it starts
  std::optional<ReciprocatingMotion> motion;  ///< none: it is fixed
};

/// What happens to a part of `Scene::loose` when a phase of a script begins.
struct PartStep {
  /// What happens to the part.
  enum class What : std::uint8_t { spawn, grip, release, remove };

  What what = What::spawn;  ///< which of these
  std::size_t phase = 0;    ///< index in the script
  std::size_t part = 0;     ///< index in `Scene::loose`
  double over = 0.2;        ///< [s] see World::add, attach, release and remove
};

/// The word of a scene file for a step: `spawn`, `grip`, `release` or `remove`.
[[nodiscard]] std::string_view word_for(PartStep::What what) noexcept;

/// A joint that does not move.
struct JointHold {
  std::string joint;                     ///< its name in the robot file
  std::optional<double> position{};      ///< [rad] or [m]; none: left to the robot file
  JointType type = JointType::revolute;  ///< which of the two units the position has
};

/// The robot file, its placement and its initial position.
struct RobotChoice {
  std::string urdf;                    ///< path; in the scene file relative to that file
  bool is_mjcf = false;                ///< the file is MJCF, not URDF
  std::string tip_link;                ///< empty: the end of the longest chain; MJCF: or a site
  std::vector<JointHold> hold;         ///< joints to hold; those beside the chain are held anyway
  std::vector<std::string> packages;   ///< folders where package:// leads; paths as that of urdf
  bool covers = true;                  ///< meshes become the parts in the lists beside them
  std::vector<double> start;           ///< [rad] or [m] one for each moving joint, base outward
  std::vector<JointType> start_types;  ///< which of the two units the file gives
  int start_line = 0;                  ///< with the start in the file
  Pose X_WB = Pose::Identity();        ///< [m] pose of the base in the world
  Pose X_LT = Pose::Identity();        ///< [m] pose of the tool frame in the tip link
  /// Links of the URDF file to which the walls apply, if the network has the module arm_obstacle;
  /// without a list all moving links.
  std::optional<std::vector<std::string>> links;
  /// Law between parts of the arm that no joint connects; without it, no such pairs.
  std::optional<ForceLaw> self_law;
  std::string srdf;           ///< path of a file with the link pairs to omit; empty: none
  Payload payload;            ///< what the tool carries; mass 0: nothing
  bool payload_known = true;  ///< to the controller too, not only to the simulated arm
  int drive_delay = 0;        ///< [ticks] see TeleoperatorOptions::drive_delay
  /// Of an arm that takes positions or rates; none: it takes torques.
  std::optional<AdmittanceOptions> admittance;
  int admittance_line = 0;  ///< with the admittance in the file
  SensorErrors sensor;      ///< of the simulated force sensor
};

/// Limits on the work of the distance queries in one tick.
struct Budget {
  double wall_us = 0.0;         ///< [us] 0: no limit
  std::int64_t work_units = 0;  ///< support-map pairs; 0: no limit
  /// Of the coprocessor; 0: the work is done in the tick's own thread.
  int threads = 0;
  std::int64_t max_age = repel::Budget{}.max_age;  ///< [ticks] after which a result expires
};

/// An arm with its tool, its operator and the network between the two.
struct ArmSetup {
  RobotChoice robot;            ///< the arm
  std::vector<Part> tool;       ///< parts of its tool
  Network network;              ///< between operator and arm
  network::Script script;       ///< of its operator
  std::vector<PartStep> steps;  ///< in the order of the script
  /// By phase, then by camera in their order, the last ones left out or all: it is silent.
  std::vector<std::vector<bool>> blind;
};

/// A further arm in the cell. Its forces from obstacles follow the obstacles' laws.
struct OtherArm : ArmSetup {
  std::string name;  ///< unique in the scene
  ForceLaw law;      ///< between its parts and those of all arms before it
};

/// All that a scene file says.
struct Scene : ArmSetup {
  std::string name;                                ///< of the file, without folder and extension
  std::string file;                                ///< path of the file
  std::vector<Change> changes;                     ///< made to what the file says
  double rate_hz = 400.0;                          ///< [Hz] of the tick
  double tool_speed = 0.25;                        ///< [m/s] speed limit of a tool
  StartInside start_inside = StartInside::refuse;  ///< what if an arm starts in an obstacle
  Measure measure = QueryOptions{}.measure;        ///< of overlaps
  /// Of every shape, where the measure needs them: see CellDescription. The shapes read have one.
  int levels = ReductionOptions{}.levels;
  std::vector<Obstacle> obstacles;  ///< in the order of the file
  std::vector<StaticModel> models;  ///< further obstacles, for whoever can read robot descriptions
  std::vector<LoosePart> loose;     ///< parts that come and go
  SpareParts spare;                 ///< for what the page of the live view adds
  std::vector<CameraChoice> cameras;  ///< each with a name of its own
  std::vector<HiddenPart> hidden;     ///< for the cameras to see
  std::vector<OtherArm> partners;     ///< further arms
  bool apart = false;  ///< to be run as two programs, divided at the line of the network
  /// Paths of the files that the parts of meshes are from, those in URDF files excepted.
  std::vector<std::string> part_lists;
  Budget budget;  ///< of the distance queries
  /// What the threads of the coprocessor do.
  CoprocessorMode coprocessor = CoprocessorMode::together;

  /// The scene's own setup for 0, then those of the partners.
  [[nodiscard]] const ArmSetup& arm_setup(std::size_t i) const {
    return i == 0 ? static_cast<const ArmSetup&>(*this) : partners[i - 1];
  }
};

/// Reads the scene file at `path`.
/// @param kinds of module that the file can name
/// @param changes other values than those of the file
/// @throws SetupError naming file, line, value and what is allowed, for anything that does not
///   conform exactly to scenes/README.md
[[nodiscard]] Scene load(const std::string& path, const ModuleKinds& kinds = {},
                         std::vector<Change> changes = {});

/// The same for text; `file` is the name used in errors, and paths are relative to it.
[[nodiscard]] Scene parse(std::string_view yaml, const std::string& file,
                          const ModuleKinds& kinds = {}, std::vector<Change> changes = {});

/// A JSON Schema (draft 7) of scene files, from which editors complete keys and find mistakes. The
/// readers are stricter: they also see what two keys together must be. Of modules it has those of
/// the library.
[[nodiscard]] std::string schema();

}  // namespace repel::scene
