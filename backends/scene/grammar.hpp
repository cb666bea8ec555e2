// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Every map of a scene file: its keys, their types, units and ranges. A new key is entered here
/// and in the reader of its map.
#pragma once

#include "key.hpp"

namespace repel::scene::grammar {

[[nodiscard]] const Keys& scene();
[[nodiscard]] const Keys& partner();
[[nodiscard]] const Keys& robot();
[[nodiscard]] const Keys& frame();
[[nodiscard]] const Keys& payload();
[[nodiscard]] const Keys& admittance();
[[nodiscard]] const Keys& sensor_errors();
[[nodiscard]] const Keys& tool_part();
[[nodiscard]] const Keys& law();
[[nodiscard]] const Keys& obstacle();
[[nodiscard]] const Keys& loose();
[[nodiscard]] const Keys& spare();
[[nodiscard]] const Keys& hidden();
[[nodiscard]] const Keys& motion();
[[nodiscard]] const Keys& camera();        ///< of `camera`
[[nodiscard]] const Keys& named_camera();  ///< of an entry of `cameras`
[[nodiscard]] const Keys& camera_map();
[[nodiscard]] const Keys& budget();
[[nodiscard]] const Keys& phase();
[[nodiscard]] const Keys& second_hand();
[[nodiscard]] const Keys& fixture();
/// Of an entry of `network`: those of every module. @param kind a word after `module:` that is one
/// of the library
[[nodiscard]] const Keys& any_module();
[[nodiscard]] const Keys& module(std::string_view kind);
/// The words after `module:` of the library, in the order of scenes/README.md.
[[nodiscard]] const std::vector<std::string_view>& module_kinds();

}  // namespace repel::scene::grammar
