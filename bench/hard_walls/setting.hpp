// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What is tried: a scene, its hands, and what holds its arms off the walls.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <repel/cell/description.hpp>
#include <repel/runs/setup/describe.hpp>
#include <repel/scene/scene.hpp>

namespace repel::hard_walls {

/// What holds an arm off.
enum class Way {
  springs,
  hard,
  velocity_damper,    ///< of the tool, by what the hand commands
  barrier_function,   ///< likewise
  stopping_distance,  ///< likewise
  damper_of_arm,      ///< of tool and links, by the torques
  barrier_of_arm      ///< likewise
};
/// Its name in the tables.
[[nodiscard]] const char* text_of(Way way);
/// It changes the torques of a cell with springs.
[[nodiscard]] inline bool is_of_arm(Way way) {
  return way == Way::damper_of_arm || way == Way::barrier_of_arm;
}

inline constexpr double stronger_than_the_arm = 1e4;  ///< [N]: nothing in its network gives way

/// What is tried.
struct Setting {
  std::string scene;     ///< its file name
  double rate = 400.0;   ///< [Hz]
  Way way = Way::hard;   ///< to hold the arms off
  double inertia = 1.0;  ///< of the simulated arm, as a multiple of its model's
  int delay = 0;         ///< [ticks] of its drive
  double wrist = 0.0;    ///< [kg m^2] of the last link, without friction; 0: as in the scene
  double hand = stronger_than_the_arm;  ///< [N]
  double hand_speed = 0.6;              ///< [m/s] along each axis
  double hand_until = 1e9;              ///< [s] after which it rests
  std::int64_t ticks = 0;               ///< to run
  std::uint64_t seed = 0;               ///< of the hands
  int libccd_every = 0;  ///< [ticks] between two looks of libccd at the overlaps; 0: none
  std::string kind{};    ///< of the walls
  std::vector<ObstacleDescription> obstacles{};  ///< in place of those of the scene; empty: these
};

/// The scene of that name.
[[nodiscard]] scene::Scene load(const std::string& name);
/// The cell of `scene`, with the hand and the walls of the setting.
[[nodiscard]] runs::DescribedScene described(const Setting& setting, const scene::Scene& scene);

}  // namespace repel::hard_walls
