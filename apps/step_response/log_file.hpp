// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Logs of positions: tables of text with a line of names.
#pragma once

#include <string>
#include <vector>

namespace repel {

/// Which columns of a log are meant. Those of joints are called by the prefix, `_` and a number, or
/// by the prefix alone where there is one joint.
struct LogColumns {
  std::string time = "time";            ///< [s]
  std::string commanded = "commanded";  ///< prefix
  std::string measured = "measured";    ///< prefix
};

/// Commanded and measured positions of one joint [rad] or [m].
struct JointLog {
  std::string name;  ///< the number in the names of its columns; empty for the only one
  std::vector<double> commanded, measured;
};

/// The positions of an arm, evenly in time.
struct PositionLog {
  double period = 0.0;  ///< [s]
  std::vector<JointLog> joints;
};

/// Reads a log. Columns are divided by commas, semicolons, tabs or blanks; others are ignored.
/// @param rate [Hz] of the lines; 0: by the column of times. The times must be even
/// @throws SetupError naming file and line for what is missing or is no number
[[nodiscard]] PositionLog read_position_log(const std::string& path, const LogColumns& columns,
                                            double rate);

}  // namespace repel
