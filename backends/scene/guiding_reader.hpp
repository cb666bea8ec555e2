// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads what a phase of a script changes in the modules `guide` and `relief`.
#pragma once

#include <array>
#include <string_view>

#include <repel/network/operator.hpp>
#include <repel/scene/network.hpp>

#include "yaml.hpp"

namespace repel::scene::detail {

/// The keys of a phase.
inline constexpr std::array<std::string_view, 4> guiding_keys{"guides", "guide_strength",
                                                              "compliant", "compliant_frame"};

/// Reads these keys into a phase. @param network of the arm of the script
void read_guiding(const Map& phase, const Network& network, network::Phase& out);

}  // namespace repel::scene::detail
