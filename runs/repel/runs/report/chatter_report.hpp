// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The chatter of an arm in the reports.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <repel/runs/report/results.hpp>

namespace repel::runs {

/// The chatter of one signal of an arm.
struct NamedChatter {
  std::string name;  ///< "walls, force", the name of a joint, "lever"
  const char* unit;  ///< "N" or "N m"
  Chatter chatter;
};

/// Walls, joints from the base outward, lever if there is one.
[[nodiscard]] std::vector<NamedChatter> chatter_list(const ArmResult& arm);

/// What the two numbers of a signal are, in one line.
[[nodiscard]] std::string about_chatter();

/// Prints the chatter of every arm, each signal in a line.
void print_chatter(const RunResult& result, std::FILE* out);

/// `above_hz`, `walls`, `joints` and `lever`, null without one. Units are in the names: `_n`,
/// `_nm`.
[[nodiscard]] nlohmann::ordered_json chatter_to_json(const ArmResult& arm);

}  // namespace repel::runs
