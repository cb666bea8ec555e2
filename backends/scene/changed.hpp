// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Puts other values into the tree of a scene file.
#pragma once

#include <memory>
#include <span>

#include <repel/scene/change.hpp>

#include "yaml_document.hpp"

namespace repel::scene {

/// The document with these values in place of its own, one after the other; aliases of what is
/// changed keep what they had. Time and memory are linear in the lengths of the paths and of the
/// lists and maps on them.
/// @throws SetupError for a path that leads nowhere, naming it and what is allowed
[[nodiscard]] std::shared_ptr<const Document> changed(std::shared_ptr<const Document> document,
                                                      std::span<const Change> changes);

}  // namespace repel::scene
