/// @file
/// The results as JSON and Markdown.
#pragma once

#include <string>
#include <vector>

#include "measurement.hpp"
#include "small.hpp"

namespace repel::scale {

/// A scene with everything that was measured on it.
struct Scenario {
  Setting setting;
  int tool_parts = 0;
  Speed speed;
  double near = 0.0;         ///< pairs within range, mean over the ticks that were checked
  double overlapping = 0.0;  ///< of these, in overlap
  double shape_bytes = 0.0;  ///< of all parts, which every way shares
  std::int64_t asked = 0;    ///< pairs the brute force has asked, of all ticks
  std::vector<Run> runs{};
};

/// One run as one object.
[[nodiscard]] std::string to_json(const Scenario& scenario, const Run& run);
[[nodiscard]] std::string to_json(const std::vector<Scenario>& scenarios,
                                  const std::vector<SmallRun>& small);
[[nodiscard]] std::string to_markdown(const std::vector<Scenario>& scenarios,
                                      const std::vector<SmallRun>& small);

}  // namespace repel::scale
