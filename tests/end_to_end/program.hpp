// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Runs a program as a user would, and reads its output.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "folder.hpp"

namespace repel::test {

/// Exit status and output of a run.
struct Ending {
  int status = -1;  ///< exit status; 128 + signal if it was killed
  std::string out;
  std::string err;
  [[nodiscard]] bool says(const std::string& words) const {
    return out.find(words) != std::string::npos || err.find(words) != std::string::npos;
  }
};

inline std::ostream& operator<<(std::ostream& stream, const Ending& ending) {
  return stream << "exit status " << ending.status << '\n' << ending.out << ending.err;
}

/// `word`, quoted for the shell.
inline std::string quoted(const std::string& word) {
  return std::string(1, '\'').append(word).append(1, '\'');
}

/// Runs `program` with `arguments`, split by the shell.
inline Ending run_program(const std::string& program, const std::string& arguments) {
  const Folder folder;
  const std::string command = quoted(program) + " " + arguments + " >" + quoted(folder / "out") +
                              " 2>" + quoted(folder / "err") + " </dev/null";
  const int raw = std::system(command.c_str());
  const int status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
  return {status, text_of(folder / "out"), text_of(folder / "err")};
}

inline nlohmann::json report_of(const std::string& path) {
  return nlohmann::json::parse(text_of(path));
}

}  // namespace repel::test
