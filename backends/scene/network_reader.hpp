// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads the `network` of a scene file.
#pragma once

#include <repel/scene/module_kinds.hpp>
#include <repel/scene/network.hpp>

#include "yaml.hpp"

namespace repel::scene::detail {

/// The modules listed in `value`; if null, those of the paper's Figure 9 with their defaults.
[[nodiscard]] Network network_of(const Value* value, const ModuleKinds& kinds);

}  // namespace repel::scene::detail
