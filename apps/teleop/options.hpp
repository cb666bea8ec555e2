// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The command line of teleop: its commands, and the options of each.
#pragma once

#include <string>
#include <vector>

#include <repel/host/command_line.hpp>
#include <repel/runs/options/session_options.hpp>
#include <repel/runs/setup/run_choice.hpp>

namespace repel::teleop {

enum class Command { run, replay, site, station, key, check, list };

/// What the command line says.
struct Arguments {
  Command command = Command::run;
  std::string scene = "anderson_4x8";  ///< file or name
  std::string recording;               ///< to replay; empty: none
  std::string key_file;                ///< to write a key to
  std::string programs;  ///< "two" or "one", to run the sides in; empty: as the scene says
  runs::RunChoice choice;
  runs::SessionOptions session;
  std::string report;  ///< file for the JSON report; empty: none
  std::string html;    ///< file for the page; empty: none
  bool is_quiet = false;
  bool schema = false;  ///< print it and stop
  bool faults = false;  ///< list them and not the scenes
};

/// Declares the commands and their options. They write to the arguments.
void describe(CLI::App& app, Arguments& arguments);

/// Puts `run` in front of a command line without a command. Replaces old spellings of options by
/// their present ones, and says so on stderr.
/// @throws CLI::ValidationError for a mistyped command, and for an old option that is a command now
void reword(const CLI::App& app, std::vector<std::string>& words);

}  // namespace repel::teleop
