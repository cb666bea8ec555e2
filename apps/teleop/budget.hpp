/// @file
/// What `--budget` asks for in place of the scene's own budget.
#pragma once

#include <cstdint>
#include <string>

#include <repel/scene/scene.hpp>

namespace repel::teleop {

/// Support pairs in one second of the preset "i860", the attached processor of the paper: what 4 by
/// 8 parts at 400 Hz take when every pair is asked in every tick (docs/real_time.md).
inline constexpr double i860_units_per_second = 400.0 * 256.0;

/// Empty for a name of a budget, else what is wrong with it and what is allowed.
[[nodiscard]] std::string budget_complaint(const std::string& name);

/// The budget of that name: "i860", scaled to one tick at this rate; "none"; support pairs per tick
/// in digits; or "", the scene's own. All but the last do without the scene's wall-clock budget.
/// @param name without a complaint
[[nodiscard]] scene::Budget budget_of(const scene::Scene& scene, const std::string& name,
                                      double rate_hz);

}  // namespace repel::teleop
