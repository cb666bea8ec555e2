/// @file
/// How a scene is run.
#pragma once

#include <string>

namespace repel::teleop {

struct RunOptions {
  double seconds = 20.0;           ///< [s] of scene time
  double rate_hz = 400.0;          ///< [Hz]
  bool fast = false;               ///< not by the clock: as fast as it goes, bitwise repeatable
  std::string backend = "bullet";  ///< "bullet", "ode", "reference" or "ideal"
  int threads = 0;                 ///< of the coprocessor; 0: in the tick's own thread
  std::string budget;              ///< name of the budget; empty: the scene's own
  bool every_pair = false;         ///< ask also those that cannot be within range
  bool tool_alone = false;         ///< no link feels the obstacles, whatever the scene says
  bool contact = false;            ///< of "bullet" and "ode": arms cannot pass solid obstacles
  bool keep_records = false;       ///< for a report as a page
  std::string log;                 ///< file that gets every tick; empty: none
};

}  // namespace repel::teleop
