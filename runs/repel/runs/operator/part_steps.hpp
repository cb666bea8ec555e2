// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The steps of a scene's scripts in which parts come, are gripped, put down and go.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <repel/cell/cell.hpp>
#include <repel/scene/scene.hpp>

namespace repel::runs {

/// What has become of a step.
struct PartStepResult {
  std::size_t arm = 0;
  scene::PartStep step;
  bool was_made = false;  ///< its phase has begun, and the state of the part allowed it
  bool was_refused = false;
  double distance = std::numeric_limits<double>::infinity();  ///< [m] of a grip, from the tool
};

/// Makes the steps of each arm's script as its phases begin. Allocates only at construction.
class PartSteps {
 public:
  /// @param cell of the scene; it must outlive this object
  PartSteps(const scene::Scene& scene, Cell& cell);

  /// Between two ticks: makes the steps of the phases that the script of an arm has begun since the
  /// last call. None if it is over, or was broken off. A tool can grip only what is within the
  /// range of the part's law.
  void follow(std::size_t arm, std::int32_t phase) noexcept;

  [[nodiscard]] const std::vector<PartStepResult>& results() const noexcept { return steps_; }

 private:
  void make(PartStepResult& result) noexcept;
  /// [m] From the parts of the tool.
  [[nodiscard]] double distance_to_tool(std::size_t arm, PartId part) const noexcept;

  Cell& cell_;
  std::vector<PartStepResult> steps_;  ///< arm by arm, in the order of the script
  std::vector<std::int32_t> phases_;   ///< of each arm, at the last call
  std::vector<std::int32_t> lengths_;  ///< of their scripts
  std::vector<double> ranges_;         ///< [m] of the law of each part
};

}  // namespace repel::runs
