// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The colours of a scene file.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace repel::scene {

/// Those that have a name: the 17 of CSS 2.1.
[[nodiscard]] std::span<const std::string_view> color_names() noexcept;

/// The colour of a name, or of "#rrggbb": red, green, blue, sRGB, 0 to 1; none of another text.
[[nodiscard]] std::optional<std::array<double, 3>> color_of(std::string_view text) noexcept;

}  // namespace repel::scene
