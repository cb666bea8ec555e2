// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads the fixtures of a module `guide`, and the directions of a module `relief`.
#pragma once

#include <array>
#include <string_view>

#include <repel/network/modules/guide.hpp>

#include "yaml.hpp"

namespace repel::scene::detail {

/// The keys of a module `guide`.
[[nodiscard]] network::GuideOptions guide_of(const Map& map);

/// The directions listed, of x, y, z, rx, ry and rz.
[[nodiscard]] std::array<bool, 6> directions_of(const Value& list);

}  // namespace repel::scene::detail
