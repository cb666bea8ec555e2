// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How a scene is run.
#pragma once

#include <string>
#include <vector>

#include <repel/runs/faults/choice.hpp>
#include <repel/schedule/coprocessor_options.hpp>

namespace repel::runs {

struct RunOptions {
  double seconds = 20.0;   ///< [s] of scene time
  double rate_hz = 400.0;  ///< [Hz]
  bool fast = false;       ///< as fast as possible instead of in real time; bitwise repeatable
  std::string backend = "bullet";  ///< the name of one of `arm_backends`
  int threads = 0;                 ///< of the coprocessor; 0: in the tick's own thread
  CoprocessorMode coprocessor = CoprocessorMode::together;
  std::string budget;          ///< budget name; empty: the scene's own
  std::string measure;         ///< of overlaps; empty: the scene's own
  int levels = 0;              ///< of the reduction; 0: the scene's own
  bool every_pair = false;     ///< also evaluate pairs that cannot be within range
  bool tool_alone = false;     ///< apply the walls to tools only, whatever the scene says
  std::string hold;            ///< "hard" or "soft" for all walls; empty: as the scene says
  bool contact = false;        ///< with a physics engine: solid obstacles stop the arms physically
  double plant_inertia = 1.0;  ///< inertia of the simulated arms as a multiple of their models'
  bool prediction = true;      ///< see TeleoperatorOptions
  bool keep_records = false;   ///< for the HTML report
  bool lock_memory = true;     ///< all of the process, without which page faults are not counted
  std::vector<faults::Choice> faults{};  ///< between the first arm and the cell
  std::string log;                       ///< file to which every tick is written; empty: none
};

}  // namespace repel::runs
