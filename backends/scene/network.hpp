/// @file
/// The `network` of a scene file.
#pragma once

#include <repel/scene/scene.hpp>

#include "yaml.hpp"

namespace repel::scene::detail {

/// The modules that `value` lists; those of the paper's Figure 9, with their defaults, when it is
/// null.
[[nodiscard]] Network network_of(const Value* value, const ModuleKinds& kinds);

}  // namespace repel::scene::detail
