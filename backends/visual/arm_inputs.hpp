// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The switches of a hand in the network of an arm, in the messages to the page.
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

/// Adds the switches of an arm to `scene`: `fixtures`, `compliant` and so on.
void add_inputs(const ArmInfo& arm, nlohmann::json& json);

/// Adds the state of its switches and the forces on its hands to an arm of `frame`. Cost: a few
/// hundred nanoseconds, and as much for each active fixture.
void write_inputs(const ArmInfo& arm, const TickRecord& k, JsonText& out);

}  // namespace repel::visual
