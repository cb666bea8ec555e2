// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a command line says of a run: its options, for programs and for who has their words.
#pragma once

#include <string>
#include <vector>

#include <repel/runs/options/run_options.hpp>
#include <repel/scene/scene.hpp>

namespace CLI {
class App;
}

namespace repel::runs {

/// The options of a run that is chosen by words; what they leave open is the scene's.
struct RunChoice {
  RunOptions run;
  bool has_seconds = false;            ///< --seconds was given
  double rate_hz = 0.0;                ///< 0: the scene's own
  int threads = -1;                    ///< -1: the scene's own
  std::string coprocessor;             ///< empty: the scene's own
  std::vector<scene::Change> changes;  ///< of the scene
  std::vector<std::string> hands;      ///< files of hands, by arm
};

/// What is chosen for.
enum class Choosing {
  check,    ///< whether a scene is sound
  station,  ///< the operator's side of a run
  site,     ///< the robot's side
  run,      ///< a whole scene
};

/// Declares the options of a run in the groups Run, Arm and Walls; they write to the choice.
void describe(CLI::App& app, Choosing what, RunChoice& choice);

/// After the words are parsed.
/// @throws CLI::ValidationError if an option asks the back end for what it does not simulate
void require_able(const RunChoice& choice);

/// Reads the scene file at `path`, with the changes of the choice. @throws SetupError
[[nodiscard]] scene::Scene scene_of(const RunChoice& choice, const std::string& path);

/// What was chosen, and the scene's own for the rest.
[[nodiscard]] RunOptions options_of(const RunChoice& choice, const scene::Scene& scene);

/// What is chosen by `words`, which are those of `teleop run` in the groups Run, Arm and Walls.
/// @throws SetupError with the complaint of the program about them
[[nodiscard]] RunChoice choice_of(std::vector<std::string> words);

/// The names of these options, each with its dashes.
[[nodiscard]] std::vector<std::string> names_of_choice();

}  // namespace repel::runs
