// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a hand can switch in the network of an arm, in the messages to the page.
#pragma once

#include <cmath>

#include <nlohmann/json.hpp>

#include <repel/loop/record.hpp>
#include <repel/visual/arm_info.hpp>

#include "json_text.hpp"

namespace repel::visual {

/// Rounds to 1e-6 (micrometre, microradian): invisible digits would be half of the text.
inline double rounded(double value) {
  return std::round(1e6 * value) / 1e6;
}

[[nodiscard]] nlohmann::json to_json(const Pose& X);

/// Adds to an arm of `scene` what there is: `fixtures`, `compliant` and so on.
void add_inputs(const ArmInfo& arm, nlohmann::json& json);

/// Adds to an arm of `frame` how that is switched, and what its hands feel. Cost: a few hundred
/// nanoseconds, and as much for each fixture that is on.
void write_inputs(const ArmInfo& arm, const TickRecord& k, JsonText& out);

}  // namespace repel::visual
