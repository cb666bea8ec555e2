// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Runs the program teleop as a user would, and reads its output.
#pragma once

#include <charconv>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "end_to_end/program.hpp"

namespace repel::test {

/// Runs teleop with `arguments`, split by the shell.
inline Ending teleop(const std::string& arguments) {
  return run_program(REPEL_TELEOP, arguments);
}

/// Runs shell commands in which $T is the program; its stdin is empty. `holds FILE BYTES` waits
/// until that file has so many, `says FILE WORDS` until it has these; both for a minute at most.
inline Ending shell(const std::string& line) {
  const Folder folder;
  const std::string script = folder.with("run.sh", "T=" + quoted(REPEL_TELEOP) + R"sh(
within_a_minute() { for i in {1..1200}; do "$@" && return; sleep 0.05; done; return 1; }
has() { [ "$(stat -c %s "$1" 2>/dev/null || echo 0)" -ge "$2" ]; }
holds() { within_a_minute has "$1" "$2"; }
says() { within_a_minute grep -qs "$2" "$1"; }
)sh" + line);
  return run_program("/bin/bash", quoted(script));
}

/// A CSV file by column.
using Columns = std::map<std::string, std::vector<double>>;

inline Columns columns_of(const std::string& path) {
  std::istringstream lines(text_of(path));
  std::string line;
  std::getline(lines, line);
  std::vector<std::string> names;
  std::istringstream header(line);
  for (std::string name; std::getline(header, name, ',');) names.push_back(name);
  Columns columns;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    for (const std::string& name : names) {
      std::string cell;
      std::getline(cells, cell, ',');
      double value = std::nan("");
      std::from_chars(cell.data(), cell.data() + cell.size(), value);
      columns[name].push_back(value);
    }
  }
  return columns;
}

/// The columns of all forces and torques of a log.
inline void expect_finite_forces(const Columns& log) {
  for (const char* column :
       {"virtual_fx_n", "virtual_fy_n", "virtual_fz_n", "virtual_tx_nm", "virtual_ty_nm",
        "virtual_tz_nm", "coupling_fx_n", "coupling_fy_n", "coupling_fz_n", "lever_torque_nm"}) {
    for (const double value : log.at(column)) ASSERT_TRUE(std::isfinite(value)) << column;
  }
}

/// The first lines of every scene written by a test: the robot of the repository. `links` are the
/// links on which the walls act, in scene syntax; by default only the tool.
inline std::string robot_text(const std::string& urdf = REPEL_SOURCE "/robots/puma560.urdf",
                              const std::string& links = "  links: []\n") {
  return "robot:\n  urdf: " + urdf +
         "\n  start: 0 45 -180 0 -45 0 deg\n  tool_frame: {position: 0 0 100 mm}\n" + links +
         "tool:\n"
         "  - {name: rod, shape: capsule, radius: 15 mm, length: 60 mm, position: 0 0 -30 mm}\n";
}

/// A table just below the tool, not stiffer than the arm can render at 400 Hz, and a script that
/// presses on it.
inline std::string table_text() {
  return "laws:\n  default: {range: 20 mm, surface_force: 40 N, damping: 1 N s/m}\n"
         "obstacles:\n"
         "  - {name: table, shape: box, size: 0.6 0.8 0.05 m, position: 0.6 -0.15 0.425 m}\n";
}

inline std::string push_text() {
  return "script:\n"
         "  - {name: push, device: spaceball, duration: 1 s, linear: 0 0 -100 mm/s}\n";
}

}  // namespace repel::test
