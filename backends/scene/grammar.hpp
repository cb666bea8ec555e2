// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Every map of a scene file: its keys, their types, units and ranges. A new key is entered here
/// and in the reader of its map; one of a module in module_kinds.cpp alone.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "key.hpp"

namespace repel::scene {
class Map;
struct ReadModule;
}  // namespace repel::scene

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
/// Of an entry of `network`: those of every module.
[[nodiscard]] const Keys& any_module();

/// A kind of module of the library.
struct ModuleKind {
  std::string_view word;  ///< after `module:`
  Keys keys;              ///< of its entry of `network`
  std::function<ReadModule(const Map&)> read;
};
/// In the order of scenes/README.md; in module_kinds.cpp.
[[nodiscard]] const std::vector<ModuleKind>& module_kinds();

}  // namespace repel::scene::grammar
