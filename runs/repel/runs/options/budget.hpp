// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The evaluation budgets of `--budget`, which replace the scene's own.
#pragma once

#include <cstdint>
#include <string>

#include <repel/scene/scene.hpp>

namespace repel::runs {

/// Support pairs per second of the preset "i860", the coprocessor of the paper: what 4 by 8 parts
/// at 400 Hz take if every pair is evaluated in every tick (docs/real_time.md).
inline constexpr double i860_units_per_second = 400.0 * 256.0;

/// Empty for a valid budget name, else its fault and the allowed names.
[[nodiscard]] std::string budget_complaint(const std::string& name);

/// The budget of that name: "i860", scaled to one tick at this rate; "none"; a number of support
/// pairs per tick; or "", the scene's own. All but the last disable the scene's wall-clock budget.
/// @param name must be valid, see budget_complaint
[[nodiscard]] scene::Budget budget_of(const scene::Scene& scene, const std::string& name,
                                      double rate_hz);

}  // namespace repel::runs
