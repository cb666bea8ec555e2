// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The results as JSON and Markdown.
#pragma once

#include <string>
#include <vector>

#include "measurement.hpp"
#include "small.hpp"

namespace repel::scale {

/// A scene with all measurements made on it.
struct Scenario {
  Setting setting;
  int tool_parts = 0;
  Speed speed;
  double near = 0.0;         ///< pairs within range, mean over the checked ticks
  double overlapping = 0.0;  ///< of these, overlapping
  double shape_bytes = 0.0;  ///< of all parts, shared by all methods
  std::int64_t asked = 0;    ///< pairs queried by the brute force, over all ticks
  std::vector<Run> runs{};
};

/// One run as a JSON object.
[[nodiscard]] std::string to_json(const Scenario& scenario, const Run& run);
[[nodiscard]] std::string to_json(const std::vector<Scenario>& scenarios,
                                  const std::vector<SmallRun>& small);
[[nodiscard]] std::string to_markdown(const std::vector<Scenario>& scenarios,
                                      const std::vector<SmallRun>& small);

}  // namespace repel::scale
